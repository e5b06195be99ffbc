//! The result of scoring one lifetime, and its JSON: field names and values of the reference's `NAME_metrics.json`.

use std::borrow::Cow;

use indexmap::IndexMap;
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::rounding::ten_decimals;
use super::{
    AsLogged, Direction, EvaluationCurve, ExpertFit, Headline, NullBand, PairValues, Reached, Reading, RegimeMetrics,
    Value, Values,
};
use crate::{DataRange, Definitions};

/// All results of scoring one lifetime. Serialises to the reference's `NAME_metrics.json`; regimes have a separate table, see
/// [`LifetimeMetrics::regime_tsv`].
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct LifetimeMetrics {
    /// The values of the whole lifetime, by name; at the top level of the JSON. The metrics determine their names: see
    /// [`Metric::headlines`](crate::Metric::headlines).
    #[serde(flatten)]
    pub lifetime: Values,
    /// Name of the log.
    pub run_id: String,
    /// As in `scenario_info.json`; empty if missing there.
    pub complexity: String,
    /// As in `scenario_info.json`; empty if missing there.
    pub difficulty: String,
    /// As in `scenario_info.json`; empty if missing there.
    pub scenario_type: String,
    /// The column that was scored.
    pub metrics_column: String,
    /// Smallest performance after preprocessing.
    pub min: f64,
    /// Largest performance after preprocessing.
    pub max: f64,
    /// Learning experiences (rows).
    pub num_lx: usize,
    /// Evaluation experiences (rows).
    pub num_ex: usize,
    /// Seconds between the first and the last time stamp.
    pub runtime: f64,
    /// Range per task that was scaled to 1..=101; `null` without normalisation.
    pub normalization_data_range: Option<IndexMap<String, DataRange>>,
    /// Means of the columns as logged, by column: the scored one first, then `reward` and `success` if the log has them. They
    /// are not scaled, so they can be compared between lifetimes.
    #[serde(default)]
    pub as_logged: IndexMap<String, AsLogged>,
    /// Notes on the values for readers; the JSON has this field only if there are any.
    #[serde(default)]
    pub notes: Vec<String>,
    /// The null band of each metric that can be tested by permuting evaluations, by name: the values to expect if the agent had
    /// never changed. Includes transfer contrasts even if only ratios were requested. Not in the JSON, which has only the
    /// reference's fields.
    #[serde(default, rename = "null")]
    pub null_bands: IndexMap<String, NullBand>,
    /// The values behind each null band: one for each of [`NULL_PERMUTATIONS`](crate::NULL_PERMUTATIONS) permutations, in an
    /// order that all lifetimes share, infinite if undefined. Not in the JSON; empty for a lifetime read from JSON.
    #[serde(skip)]
    pub null_draws: IndexMap<String, Vec<f64>>,
    /// The reading of each metric that has a neutral value, by name. Not in the JSON, which has only the reference's fields;
    /// [`LifetimeMetrics::whole`] writes them as rows of [`LifetimeMetrics::summary`].
    #[serde(default, deserialize_with = "readings_of_rows")]
    pub readings: IndexMap<String, Reading>,
    /// The transfer contrasts of each task, if only ratios were requested. Not in the JSON, which has only the reference's fields.
    #[serde(default)]
    pub contrasts: IndexMap<String, Values>,
    /// The evaluation results of each task, in the log's unit. Not in the JSON, which has only the reference's fields.
    #[serde(default)]
    pub reached: IndexMap<String, Reached>,
    /// Measures of each task's evaluation curve, regardless of boundaries between tasks. Not in the JSON, which has only the
    /// reference's fields.
    #[serde(default)]
    pub curves: IndexMap<String, EvaluationCurve>,
    /// Warnings about tasks that were never learned, and about experts that are not comparable. Not in the JSON, which has
    /// only the reference's fields.
    #[serde(default)]
    pub cautions: Vec<String>,
    /// The experts' training compared with the lifetime's, by task. Not in the JSON, which has only the reference's fields.
    #[serde(default, rename = "experts")]
    pub expert_fits: IndexMap<String, Vec<ExpertFit>>,
    /// The values of each task, by first learning block: headlines, then the lists behind them.
    pub task_metrics: IndexMap<String, Values>,
    /// The values of each regime, in order; not in the JSON.
    #[serde(skip)]
    pub regimes: Vec<RegimeMetrics>,
    /// The names of the values of a lifetime, in order. Not in the JSON: a lifetime read from JSON has those of the built-in
    /// metrics.
    #[serde(skip, default = "crate::score::built_in_headlines")]
    pub headlines: Vec<Headline>,
    /// The definitions it was scored with; in the JSON only if they are not the reference's.
    #[serde(default)]
    pub definitions: Definitions,
}

/// Extracts the readings from the rows of the JSON of [`LifetimeMetrics::whole`].
fn readings_of_rows<'de, D: Deserializer<'de>>(rows: D) -> Result<IndexMap<String, Reading>, D::Error> {
    #[derive(Deserialize)]
    struct Row {
        reading: Option<Reading>,
    }
    let rows = IndexMap::<String, Row>::deserialize(rows)?;
    let readings = rows.into_iter().filter_map(|(name, row)| Some((name, row.reading?)));
    Ok(readings.collect())
}

impl Serialize for LifetimeMetrics {
    /// QUIRK: the values of the lifetime have ten decimals, as in the reference's file. Those of tasks are not rounded, and
    /// under the published definitions no value is.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let rounded = |number: f64| match self.definitions {
            Definitions::Reference => ten_decimals(number),
            Definitions::Published => number,
        };
        // As in the reference, requested values that could not be computed are null.
        let requested = self.headlines.iter().map(|headline| (&*headline.name, None));
        let mut lifetime: IndexMap<&str, Option<Value>> = requested.collect();
        for (name, value) in self.lifetime.iter() {
            let value = match value {
                Value::Number(number) => Value::Number(rounded(*number)),
                other => other.clone(),
            };
            lifetime.insert(name, Some(value));
        }
        let mut document = serializer.serialize_map(None)?;
        for (name, value) in &lifetime {
            document.serialize_entry(name, value)?;
        }
        document.serialize_entry("run_id", &self.run_id)?;
        document.serialize_entry("complexity", &self.complexity)?;
        document.serialize_entry("difficulty", &self.difficulty)?;
        document.serialize_entry("scenario_type", &self.scenario_type)?;
        document.serialize_entry("metrics_column", &self.metrics_column)?;
        if !self.definitions.is_reference() {
            document.serialize_entry("definitions", &self.definitions)?;
        }
        document.serialize_entry("min", &rounded(self.min))?;
        document.serialize_entry("max", &rounded(self.max))?;
        document.serialize_entry("num_lx", &self.num_lx)?;
        document.serialize_entry("num_ex", &self.num_ex)?;
        document.serialize_entry("runtime", &rounded(self.runtime))?;
        document.serialize_entry("normalization_data_range", &self.normalization_data_range)?;
        if !self.as_logged.is_empty() {
            document.serialize_entry("as_logged", &self.as_logged)?;
        }
        if !self.notes.is_empty() {
            document.serialize_entry("notes", &self.notes)?;
        }
        document.serialize_entry("task_metrics", &self.task_metrics)?;
        document.end()
    }
}

impl LifetimeMetrics {
    /// Whether tasks were evaluated after learning but none improved: maintenance and transfer are then meaningless.
    pub fn nothing_was_learned(&self) -> bool {
        let gains: Vec<bool> = self.reached.values().filter_map(Reached::has_gained).collect();
        !gains.is_empty() && !gains.contains(&true)
    }
}

/// One row of the table of a lifetime.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SummaryRow {
    /// Name of the metric, as in the JSON.
    pub name: Cow<'static, str>,
    /// Its value; `None` if it was not requested or could not be computed.
    pub value: Option<f64>,
    /// One-line explanation.
    pub explanation: Cow<'static, str>,
    /// The good direction.
    pub good: Direction,
    /// Its null band: the values to expect if the agent had never changed; `None` for a metric that cannot be tested by
    /// permuting evaluations.
    pub null_band: Option<NullBand>,
    /// The reading of the value; `None` for a metric without a neutral value.
    pub reading: Option<Reading>,
    /// The reading in the metric's own words, as in every table.
    pub word: Option<&'static str>,
}

/// The value of a metric for a task, or for a pair of tasks: one of those behind the lifetime's value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part<'a> {
    /// The task; in a pair, the one that was learned.
    pub task: &'a str,
    /// In a pair, the task that was evaluated before and after.
    pub other: Option<&'a str>,
    /// The value; for a pair that occurs several times, the first.
    pub value: f64,
}

impl LifetimeMetrics {
    /// The lifetime's values as a table, one row for each headline of the metrics it was scored with, including those without a
    /// value. If transfer was requested only as a ratio, the contrasts come first: a mean of ratios is above 1 even if nothing
    /// is transferred.
    pub fn summary(&self) -> Vec<SummaryRow> {
        let row = |headline: Headline| {
            let value = self.number(&headline.name);
            let reading = self.readings.get(&*headline.name).copied();
            let reading = reading.filter(|_| value.is_some());
            SummaryRow {
                value,
                null_band: self.null_bands.get(&*headline.name).copied(),
                reading,
                word: reading.map(|reading| reading.word(&headline.name)),
                name: headline.name,
                explanation: headline.explanation,
                good: headline.good,
            }
        };
        self.shown_headlines().into_iter().map(row).collect()
    }

    /// The lifetime's value of a metric, or of a transfer contrast that was not requested.
    pub(super) fn number(&self, name: &str) -> Option<f64> {
        let requested = self.lifetime.number(name);
        requested.or_else(|| Some(self.null_bands.get(name)?.value))
    }

    /// The values of tasks, or of pairs of tasks, behind the lifetime's value of a metric, or of a transfer contrast that was
    /// not requested.
    pub fn parts(&self, name: &str) -> Vec<Part<'_>> {
        parts(&self.task_metrics, &self.contrasts, name)
    }

    /// The values of a metric from a learned task to every other, in order of the later evaluation; also those of a transfer
    /// contrast that was not requested.
    pub fn pairs(&self, task: &str, name: &str) -> Option<&PairValues> {
        pairs(&self.task_metrics, &self.contrasts, task, name)
    }

    /// The headlines, including those that are shown although not requested.
    pub(super) fn shown_headlines(&self) -> Vec<Headline> {
        let is_shown = |name: &str| self.headlines.iter().any(|headline| headline.name == name);
        let has_band = |name: &str| self.null_bands.contains_key(name);
        let mut contrasts: Vec<Headline> = crate::score::built_in_headlines();
        contrasts.retain(|headline| has_band(&headline.name) && !is_shown(&headline.name));
        let mut rows = Vec::new();
        for headline in &self.headlines {
            if headline.name.ends_with("_transfer_ratio") {
                rows.append(&mut contrasts);
            }
            rows.push(headline.clone());
        }
        rows
    }
}

fn pairs<'a>(
    tasks: &'a IndexMap<String, Values>,
    contrasts: &'a IndexMap<String, Values>,
    task: &str,
    name: &str,
) -> Option<&'a PairValues> {
    let of = |values: &'a IndexMap<String, Values>| values.get(task)?.pairs(name);
    of(tasks).or_else(|| of(contrasts))
}

/// Like [`LifetimeMetrics::parts`], from the values of tasks and the contrasts that were not requested.
pub(crate) fn parts<'a>(
    tasks: &'a IndexMap<String, Values>,
    contrasts: &'a IndexMap<String, Values>,
    name: &str,
) -> Vec<Part<'a>> {
    let mut found = Vec::new();
    for (task, values) in tasks {
        if let Some(value) = values.number(name) {
            let other = None;
            found.push(Part { task, other, value });
        }
        for (other, values) in pairs(tasks, contrasts, task, name).into_iter().flatten() {
            if let Some(value) = values.first().copied() {
                let other = Some(other.as_str());
                found.push(Part { task, other, value });
            }
        }
    }
    found
}

/// A lifetime as JSON: the fields of [`LifetimeMetrics`], then `readings`, the row of the lifetime's table for each metric that
/// has a value; `null`, the null bands; `contrasts`, the transfer contrasts between tasks if only ratios were requested;
/// `reached`, the evaluation results of each task; `curves`, the measures of each evaluation curve; `cautions`, if
/// there are any; and `experts`, which compares the experts' training with the lifetime's, if there are experts.
#[derive(Debug, Clone, Serialize)]
pub struct WholeLifetime<'a> {
    #[serde(flatten)]
    metrics: &'a LifetimeMetrics,
    readings: IndexMap<String, SummaryRow>,
    null: &'a IndexMap<String, NullBand>,
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    contrasts: &'a IndexMap<String, Values>,
    reached: &'a IndexMap<String, Reached>,
    curves: &'a IndexMap<String, EvaluationCurve>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    cautions: &'a [String],
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    experts: &'a IndexMap<String, Vec<ExpertFit>>,
}

impl LifetimeMetrics {
    /// Serialises this lifetime with its readings and null bands, the tasks' evaluation results and their curves, which the
    /// saved file leaves out.
    pub fn whole(&self) -> WholeLifetime<'_> {
        WholeLifetime {
            metrics: self,
            readings: (self.summary().into_iter())
                .filter(|row| row.value.is_some())
                .map(|row| (row.name.to_string(), row))
                .collect(),
            null: &self.null_bands,
            contrasts: &self.contrasts,
            reached: &self.reached,
            curves: &self.curves,
            cautions: &self.cautions,
            experts: &self.expert_fits,
        }
    }
}
