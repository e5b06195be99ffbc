//! Recorded episodes by what they are named: a log with the number of an experience, or a file of recordings. What a recording holds is
//! `env`'s, where a log keeps it `curriculum`'s.

use std::path::{Path, PathBuf};

use driftworld_curriculum::{CurriculumError, RECORDINGS_FILE, list_recordings, read_recording, read_recording_file};
use driftworld_env::{Catalogue, EpisodeOrigin, Recording, Replay};
use driftworld_metrics::{BlockType, Log, read_log_with_texts};
use driftworld_text::ShownPath;

use crate::Failure;
use crate::contents::{Contents, OtherContents};

/// Where recorded episodes are.
pub struct RecordedEpisodes {
    path: PathBuf,
    /// Nothing for a file of recordings.
    log: Option<Log>,
    /// The episodes of a file, and the first damage in it.
    listed: (Vec<EpisodeOrigin>, Option<CurriculumError>),
}

/// What a log says of an episode.
#[derive(Clone, Debug, PartialEq)]
struct LoggedRow {
    worker: String,
    block: u64,
    block_type: BlockType,
    reward: Option<f64>,
    steps: Option<f64>,
}

impl RecordedEpisodes {
    /// The episodes of a log's folder, or of a file of recordings.
    ///
    /// # Errors
    /// If there is neither, or it cannot be read.
    pub fn open(path: &Path) -> Result<Self, Failure> {
        if path.is_dir() {
            if let Some(other) = OtherContents::check(path, Contents::of_folder(path), &[Contents::Log]) {
                return Err(other.into());
            }
            return Ok(Self {
                log: Some(read_log_with_texts(path)?),
                listed: (Vec::new(), None),
                path: path.to_owned(),
            });
        }
        Ok(Self {
            log: None,
            listed: list_recordings(path)?,
            path: path.to_owned(),
        })
    }

    /// The numbers of the episodes that there are rows of, or that are in the file, rising.
    pub fn numbers(&self) -> Vec<u64> {
        let mut numbers: Vec<u64> = match &self.log {
            Some(log) => log.rows.exp_nums().to_vec(),
            None => self.listed.0.iter().map(|origin| origin.experience).collect(),
        };
        numbers.sort_unstable();
        numbers.dedup();
        numbers
    }

    /// The recording of an episode; nothing where a log has its row and it was not recorded. Where several workers have an episode of
    /// this number, `worker` says whose.
    ///
    /// # Errors
    /// If there is no such episode, or its recording is damaged.
    pub fn recording(&self, number: u64, worker: Option<&str>) -> Result<Option<Recording>, Failure> {
        if self.log.is_none() {
            return match read_recording_file(&self.path, number)? {
                Some(recording) => Ok(Some(recording)),
                None => Err(self.missing(number)),
            };
        }
        let row = self.row(number, worker)?;
        Ok(read_recording(
            &self.path,
            &row.worker,
            (row.block, row.block_type),
            number,
        )?)
    }

    /// Runs an episode once more, and compares it with its recording and, where there is one, with its row in the log.
    ///
    /// # Errors
    /// That says what differs.
    pub fn check(&self, recording: &Recording, worker: Option<&str>, catalogue: &Catalogue) -> Result<(), Failure> {
        let mut replay = Replay::new(recording, catalogue);
        while replay.step()?.is_some() {}
        replay.check()?;
        self.check_row(recording, worker)
    }

    /// Compares a recording with its row in the log, where there is one that a run of ours wrote.
    ///
    /// # Errors
    /// That says what differs.
    pub fn check_row(&self, recording: &Recording, worker: Option<&str>) -> Result<(), Failure> {
        let Some(log) = &self.log else { return Ok(()) };
        // What others log under these names may be something else, such as a reward that was scaled.
        if !log.scenario_info.extra.contains_key("made_from") {
            return Ok(());
        }
        let number = recording.origin.experience;
        let row = self.row(number, worker)?;
        let differs = |what: &str, found: f64, expected: f64| {
            Err(Failure::input(format!(
                "{}: experience {number}, {what}: found {found} in its recording, expected {expected} as in its row: the log or the \
                 recording was changed",
                self.path.shown()
            )))
        };
        match (row.reward, row.steps) {
            (Some(logged), _) if logged.to_bits() != recording.reward.to_bits() => {
                differs("reward", recording.reward, logged)
            }
            (_, Some(logged)) if logged != recording.actions.len() as f64 => {
                differs("steps", recording.actions.len() as f64, logged)
            }
            _ => Ok(()),
        }
    }

    fn row(&self, number: u64, worker: Option<&str>) -> Result<LoggedRow, Failure> {
        let rows = self.log.iter().flat_map(|log| log.rows.iter());
        let mut found: Vec<LoggedRow> = rows
            .filter(|row| row.exp_num() == number && worker.is_none_or(|worker| row.worker_id() == worker))
            .map(|row| LoggedRow {
                worker: row.worker_id().to_owned(),
                block: row.block_num(),
                block_type: row.block_type(),
                reward: row.metric("reward"),
                steps: row.metric("episode_step_count"),
            })
            .collect();
        // Rows before the one that completes an episode.
        found.reverse();
        found.dedup_by(|a, b| a.worker == b.worker);
        match &found[..] {
            [row] => Ok(row.clone()),
            [] => Err(self.missing(number)),
            several => {
                let workers: Vec<&str> = several.iter().map(|row| row.worker.as_str()).collect();
                Err(Failure::input(format!(
                    "{}: found episodes {number} of {}, expected one; say whose with {}",
                    self.path.shown(),
                    workers.join(", "),
                    crate::argument("worker")
                )))
            }
        }
    }

    fn missing(&self, number: u64) -> Failure {
        if let Some(damage) = &self.listed.1 {
            return Failure::input(format!("episode {number} cannot be found: {damage}"));
        }
        let numbers = self.numbers();
        let there = match (numbers.first(), numbers.last()) {
            (Some(first), Some(last)) if first == last => format!("episode {first}"),
            (Some(first), Some(last)) => format!("one of episodes {first} to {last}"),
            _ => "an episode, and there is none".to_owned(),
        };
        Failure::input(format!(
            "{}: found no episode {number}, expected {there}",
            self.path.shown()
        ))
    }

    /// Why an episode of a log has no recording, and what to do.
    pub fn unrecorded(&self, number: u64) -> Failure {
        Failure::input(format!(
            "{}: found no recording of episode {number} (an {RECORDINGS_FILE} beside its rows), expected one; run with {}",
            self.path.shown(),
            crate::argument("record")
        ))
    }
}
