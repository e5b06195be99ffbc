//! Writes the log of a lifetime: starts a new one, or resumes one where it stopped.

use std::path::Path;
use std::str::FromStr;

use driftworld_env::{EndedBy, EpisodeOrigin, Recording};
use driftworld_metrics::{
    DEFAULT_WORKER, LogWriter, LoggerInfo, MetricsError, Record, Row, Rows, ScenarioInfo, ScenarioType, TaskParams,
    Timestamp, begun_log, read_log_with_texts,
};
use driftworld_spec::{ScenarioForm, Variant};
use driftworld_text::when;
use serde::Serialize;
use serde_json::{Map, Value, json};

use super::budget::Budget;
use super::columns::{self, COLUMNS, ENDED_BY, ENDING, block_type};
use super::episode::Experience;
use super::gap::{self, Gap, Gaps};
use super::plan::Plan;
use super::recordings::Recordings;
use super::summary::{Progress, Summary};
use crate::CurriculumError;

/// An open log, with a summary of its rows so far.
#[derive(Debug)]
pub struct Journal {
    writer: LogWriter,
    summary: Summary,
    /// The number of the next experience to log.
    next: u64,
    budget: Budget,
    /// `None` if distances are not measured.
    gaps: Option<Gaps>,
    /// The regime learned last, and the variant at the end of its drift if it drifts.
    learned: Option<(usize, Option<Variant>)>,
    /// Recordings next to the rows, if they are kept.
    recordings: Option<Recordings>,
}

/// A finished experience.
#[derive(Default)]
pub(crate) struct FinishedExperience {
    pub(crate) experience: Experience,
    /// Its interpolated variant, if the regime drifts.
    pub(crate) between: Option<Variant>,
    /// Its recording, if recordings are kept.
    pub(crate) recording: Option<Recording>,
}

impl Journal {
    /// Starts a log in a new or empty folder. `agent` is the agent's name in the log.
    ///
    /// # Errors
    /// [`CurriculumError::Log`].
    pub fn create(folder: &Path, plan: &Plan, agent: &str) -> Result<Self, CurriculumError> {
        let columns = LoggerInfo::new(COLUMNS)?;
        let writer = LogWriter::create(folder, &columns, &scenario_info(plan, agent))?;
        Ok(Self::new(writer))
    }

    /// Like [`Journal::create`], for a simulated agent with a temporary log: it is never synced to disk, and no distances are
    /// measured.
    ///
    /// # Errors
    /// Those of [`Journal::create`].
    pub(crate) fn simulated(folder: &Path, plan: &Plan) -> Result<Self, CurriculumError> {
        let columns = LoggerInfo::new(COLUMNS)?;
        let writer = LogWriter::create_unsynced(folder, &columns, &scenario_info(plan, "simulated"))?;
        let gaps = None;
        Ok(Self {
            gaps,
            ..Self::new(writer)
        })
    }

    /// Resumes a log that may have been interrupted at any moment: it continues with the first experience that is not
    /// completely in it. Starts a new log if there is none.
    ///
    /// # Errors
    /// [`CurriculumError::OtherRun`] if the log belongs to another scenario or agent, or its variants or worlds have changed
    /// since; [`CurriculumError::OtherRow`] if its rows do not match the plan; [`CurriculumError::Log`] if it cannot be read,
    /// or another run is writing it. The log is left unchanged in each case.
    pub fn resume(folder: &Path, plan: &Plan, agent: &str) -> Result<Self, CurriculumError> {
        let Some((columns, found)) = begun_log(folder)? else {
            return Self::create(folder, plan, agent);
        };
        let other = |place: &str, found: &Value, expected: &Value| CurriculumError::OtherRun {
            path: folder.to_owned(),
            place: place.to_owned(),
            found: shown(found),
            expected: shown(expected),
        };
        if columns.metrics_columns() != COLUMNS {
            return Err(other(
                "metrics_columns",
                &json!(columns.metrics_columns()),
                &json!(COLUMNS),
            ));
        }
        let expected = json!(scenario_info(plan, agent).extra);
        let found = Value::Object(found.extra);
        if let Some((place, found, expected)) = difference(&found, &expected, String::new()) {
            return Err(other(&place, found, expected));
        }
        let writer = LogWriter::resume(folder)?;
        let rows = match read_log_with_texts(folder) {
            Ok(log) => log.rows,
            Err(MetricsError::NoDataFiles(_)) => Rows::default(),
            Err(error) => return Err(error.into()),
        };
        let mut journal = Self::new(writer);
        for row in rows.iter() {
            let number = journal.next;
            let other_row = |found: String, expected: String| CurriculumError::OtherRow {
                path: folder.to_owned(),
                row: number,
                found,
                expected,
            };
            let steps = count_row(plan, &mut journal.summary, number, row)
                .map_err(|(found, expected)| other_row(found, expected))?;
            journal.advance(plan, number, steps);
        }
        if Recordings::exist(folder)? {
            journal.record();
        }
        Ok(journal)
    }

    fn new(writer: LogWriter) -> Self {
        Self {
            writer,
            summary: Summary::default(),
            next: 0,
            budget: Budget::default(),
            gaps: Some(Gaps::default()),
            learned: None,
            recordings: None,
        }
    }

    /// Starts recording: the actions of each experience are kept in a file next to the rows of its block, so that it can be
    /// replayed.
    ///
    /// A log started this way keeps recording when resumed.
    pub fn record(&mut self) {
        self.recordings = Some(Recordings::new(self.writer.dir()));
    }

    /// Whether experiences are recorded.
    pub fn records(&self) -> bool {
        self.recordings.is_some()
    }

    /// Logs that the next experience, `number`, is left out.
    pub(super) fn leave_out(
        &mut self,
        plan: &Plan,
        number: u64,
        reason: &str,
        now: Timestamp,
    ) -> Result<Progress, CurriculumError> {
        let planned = &plan.regimes[plan.regime_of(number)];
        let record = columns::skipped(planned, number, reason, now);
        let record = self.with_words(record, columns::SKIPPED, columns::SKIPPED);
        self.writer.write(&record)?;
        self.summary.leave_out(planned, number, reason);
        self.advance(plan, number, None);
        Ok(self.progress(plan, number, f64::NAN))
    }

    /// Adds how the experience ended and what ended it; a log started before these columns existed continues without them.
    fn with_words(&self, record: Record, ending: &str, ended_by: &str) -> Record {
        let words = [(ENDING, ending), (ENDED_BY, ended_by)];
        words.into_iter().fold(record, |record, (name, word)| {
            let has_it = |columns: &[String]| columns.iter().any(|column| column == name);
            if self.writer.columns().is_none_or(has_it) {
                record.with_text(name, word)
            } else {
                record
            }
        })
    }

    /// Moves past experience `number`; `steps` is `None` if it was left out.
    fn advance(&mut self, plan: &Plan, number: u64, steps: Option<u64>) {
        if let Some(steps) = steps {
            self.budget.count(plan, number, steps);
        }
        self.next = self.budget.next(plan, number + 1);
        self.summary.finished = self.next == plan.num_experiences();
    }

    /// The run's progress after experience `number`.
    fn progress(&self, plan: &Plan, number: u64, reward: f64) -> Progress {
        let planned = &plan.regimes[plan.regime_of(number)];
        Progress {
            done: self.next,
            total: plan.num_experiences(),
            block: planned.block,
            kind: planned.kind,
            variant: planned.id.clone(),
            reward,
        }
    }

    /// Logs the next experience, `number`.
    pub(crate) fn append(
        &mut self,
        plan: &Plan,
        number: u64,
        finished: FinishedExperience,
        now: Timestamp,
    ) -> Result<Progress, CurriculumError> {
        let planned = &plan.regimes[plan.regime_of(number)];
        let experience = &finished.experience;
        let gap = self.gap(plan, number, finished.between.as_ref());
        if let (Some(recordings), Some(recording)) = (&mut self.recordings, finished.recording) {
            // Written before the row, so that each row has its recording even if the run is stopped in between.
            let recording = Recording {
                origin: origin(plan, number)?,
                ..recording
            };
            let block = (planned.block as u64, block_type(planned.kind));
            recordings.append(DEFAULT_WORKER, block, &recording)?;
        }
        let record = columns::record(planned, number, experience, &gap, now);
        let ended_by = experience.ended_by.map_or(UNKNOWN, EndedBy::word);
        let record = self.with_words(record, experience.ending(), ended_by);
        self.writer.write(&record)?;
        let success = f64::from(u8::from(experience.success));
        let steps = u64::from(experience.steps);
        self.summary.count(planned, experience.reward, success, steps, ended_by);
        self.advance(plan, number, Some(steps));
        Ok(self.progress(plan, number, experience.reward))
    }

    /// The gap between an experience's variant and the one learned last before its regime began.
    fn gap(&mut self, plan: &Plan, number: u64, between: Option<&Variant>) -> Gap {
        let planned = &plan.regimes[plan.regime_of(number)];
        let (Some(index), Some(gaps)) = (planned.learned, &mut self.gaps) else {
            return gap::UNKNOWN;
        };
        let learned = &plan.regimes[index];
        if self.learned.as_ref().is_none_or(|(known, _)| *known != index) {
            self.learned = Some((index, learned.last_variant()));
        }
        let end = self.learned.as_ref().and_then(|(_, end)| end.as_ref());
        let before = learned.subject(learned.number(u64::from(learned.count) - 1), end);
        let here = planned.subject(number, between);
        gaps.between((&before.0, before.1), (&here.0, here.1))
    }

    /// The results of the lifetime so far.
    pub fn summary(&self) -> &Summary {
        &self.summary
    }

    /// Number of experiences of the plan that are done: those in the log, and those skipped because a budget was spent.
    pub fn num_experiences(&self) -> u64 {
        self.next
    }

    /// Removes the last block from the log: a block that must not count leaves no rows, and a resumed log runs it again. The
    /// journal must not be used afterwards.
    ///
    /// # Errors
    /// [`CurriculumError::Log`].
    pub fn withdraw_block(&mut self) -> Result<(), CurriculumError> {
        self.recordings = None;
        Ok(self.writer.withdraw_block()?)
    }

    /// Ends the log and syncs it to disk.
    ///
    /// # Errors
    /// [`CurriculumError::Log`].
    pub fn finish(self) -> Result<(), CurriculumError> {
        let synced = self.recordings.map_or(Ok(()), |mut recordings| recordings.sync());
        self.writer.finish()?;
        synced
    }
}

/// The origin of an experience's episode.
fn origin(plan: &Plan, number: u64) -> Result<EpisodeOrigin, CurriculumError> {
    let spec = plan.experience_spec(number)?;
    let (task, variant) = spec.variant.split_once('#').unwrap_or((spec.variant, ""));
    Ok(EpisodeOrigin {
        experience: number,
        block: Some(spec.block as u64),
        task: Some(task.to_owned()),
        variant: Some(variant.to_owned()),
        seed: spec.seed,
        index: spec.index,
    })
}

/// Logged when it is unknown what ended an experience.
const UNKNOWN: &str = "unknown";

/// Counts a row of an earlier run if it is the one that the plan expects, and returns its steps, or `None` if it was left out.
/// Otherwise returns what was found and what was expected.
fn count_row(plan: &Plan, summary: &mut Summary, number: u64, row: Row<'_>) -> Result<Option<u64>, (String, String)> {
    if number >= plan.num_experiences() {
        return Err((
            "one more row".to_owned(),
            format!("{} experiences", plan.num_experiences()),
        ));
    }
    let planned = &plan.regimes[plan.regime_of(number)];
    let value = |name: &str| row.metric(name).unwrap_or(f64::NAN);
    let reason = row.task_params().get(columns::SKIPPED).and_then(Value::as_str);
    let params = reason.map_or_else(|| planned.params(), |reason| columns::skipped_params(planned, reason));
    let describe = |block: u64, experience: u64, kind, name: &str, params: &TaskParams, [index, progress]: [f64; 2]| {
        let params = Value::Object(Map::clone(params));
        let drift = when(progress != 0.0, || format!(", progress {progress}"));
        format!("experience {experience} in block {block}-{kind}, {name} {params}, world {index}{drift}")
    };
    let expected = describe(
        planned.block as u64,
        number,
        block_type(planned.kind),
        &planned.log_name,
        &params,
        [planned.world_index(number), planned.progress(number)],
    );
    let found = describe(
        row.block_num(),
        row.exp_num(),
        row.block_type(),
        row.task_name(),
        row.task_params(),
        [value("world_index"), value("progress")],
    );
    if found != expected {
        return Err((found, expected));
    }
    if let Some(reason) = reason {
        summary.leave_out(planned, number, reason);
        return Ok(None);
    }
    let steps = value("episode_step_count") as u64;
    let ended_by = row.text(ENDED_BY).unwrap_or(UNKNOWN);
    summary.count(planned, value("reward"), value("success"), steps, ended_by);
    Ok(Some(steps))
}

/// A lifetime's metadata for the log: the scenario, the agent, and fingerprints of its variants and worlds.
pub(super) fn scenario_info(plan: &Plan, agent: &str) -> ScenarioInfo {
    let mut extra = Map::new();
    extra.insert("agent".to_owned(), json!(agent));
    extra.insert("scenario".to_owned(), json!(plan.scenario));
    extra.insert("made_from".to_owned(), json!(plan.fingerprints));
    if !plan.notes.is_empty() {
        extra.insert("notes".to_owned(), json!(plan.notes));
    }
    let form = match plan.scenario.form {
        Some(ScenarioForm::Expert) => ScenarioType::Ste,
        form => logged(form).unwrap_or(ScenarioType::Custom),
    };
    ScenarioInfo {
        complexity: logged(plan.scenario.complexity),
        difficulty: logged(plan.scenario.difficulty),
        scenario_type: Some(form),
        extra,
    }
}

/// Converts an enum value of a scenario to the log's enum: both serialise to l2logger's words.
fn logged<T: FromStr>(word: Option<impl Serialize>) -> Option<T> {
    json!(word?).as_str()?.parse().ok()
}

/// The first difference between two JSON values: its path, and both values there.
fn difference<'a>(found: &'a Value, expected: &'a Value, place: String) -> Option<(String, &'a Value, &'a Value)> {
    const NOTHING: &Value = &Value::Null;
    match (found, expected) {
        (Value::Object(a), Value::Object(b)) => {
            let mut keys: Vec<&String> = b.keys().chain(a.keys().filter(|key| !b.contains_key(*key))).collect();
            // Names first: a different scenario name explains more than a different count.
            keys.sort_by_key(|key| *key != "name");
            keys.into_iter().find_map(|key| {
                let of = |map: &'a Map<String, Value>| map.get(key).unwrap_or(NOTHING);
                difference(of(a), of(b), format!("{place}/{key}"))
            })
        }
        (Value::Array(a), Value::Array(b)) => (0..a.len().max(b.len())).find_map(|index| {
            let of = |list: &'a Vec<Value>| list.get(index).unwrap_or(NOTHING);
            difference(of(a), of(b), format!("{place}/{index}"))
        }),
        _ if found == expected => None,
        _ => Some((place, found, expected)),
    }
}

/// A value, shortened for a message.
fn shown(value: &Value) -> String {
    match value {
        Value::Null => "nothing".to_owned(),
        other => driftworld_text::shortened(&other.to_string(), 120),
    }
}

#[cfg(test)]
mod tests {
    use driftworld_metrics::{Complexity, Difficulty};
    use driftworld_spec::{ScenarioComplexity, ScenarioDifficulty};

    use super::*;

    #[test]
    fn scenario_words_convert_to_log_words() {
        use ScenarioComplexity::{High, Intermediate, Low};
        use ScenarioDifficulty::{Easy, Hard, Medium};
        use ScenarioForm::{Alternating, Condensed, Custom, Dispersed, Permuted};
        let forms = [Condensed, Dispersed, Permuted, Alternating, Custom].map(|form| logged(Some(form)));
        let types = [
            ScenarioType::Condensed,
            ScenarioType::Dispersed,
            ScenarioType::Permuted,
            ScenarioType::Alternating,
            ScenarioType::Custom,
        ];
        assert_eq!(forms, types.map(Some));
        let complexities = [Low, Intermediate, High].map(|word| logged(Some(word)));
        let expected = [Complexity::Low, Complexity::Intermediate, Complexity::High];
        assert_eq!(complexities, expected.map(Some));
        let difficulties = [Easy, Medium, Hard].map(|word| logged(Some(word)));
        let expected = [Difficulty::Easy, Difficulty::Medium, Difficulty::Hard];
        assert_eq!(difficulties, expected.map(Some));
        assert_eq!(logged::<Difficulty>(None::<ScenarioDifficulty>), None);
        assert_eq!(logged::<ScenarioType>(Some(ScenarioForm::Joint)), None);
    }

    #[test]
    fn first_difference_is_given_with_its_path() {
        let check = |a: Value, b: Value, expected: Option<(&str, &str, &str)>| {
            let found = difference(&a, &b, String::new());
            let found = found.map(|(place, a, b)| (place, shown(a), shown(b)));
            let expected = expected.map(|(place, a, b)| (place.to_owned(), a.to_owned(), b.to_owned()));
            assert_eq!(found, expected);
        };
        check(json!({ "a": [1, 2.5] }), json!({ "a": [1, 2.5] }), None);
        check(json!({ "a": [1, 2] }), json!({ "a": [1, 3] }), Some(("/a/1", "2", "3")));
        check(
            json!({ "a": [1] }),
            json!({ "a": [1, 3] }),
            Some(("/a/1", "nothing", "3")),
        );
        check(json!({ "b": 1 }), json!({}), Some(("/b", "1", "nothing")));
        let (old, new) = (json!({ "count": 1, "name": "x" }), json!({ "count": 2, "name": "y" }));
        check(old, new, Some(("/name", "\"x\"", "\"y\"")));
    }
}
