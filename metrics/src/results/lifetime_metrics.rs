//! The result of scoring one lifetime, and its JSON: field names and values of the reference's `NAME_metrics.json`.
//!
//! Not here: how the values are computed, see the file of each metric in `score`.

use std::borrow::Cow;

use indexmap::IndexMap;
use serde::{Deserialize, Serialize, Serializer};

use super::rounding::ten_decimals;
use super::{
    AsLogged, Direction, EvaluationCurve, ExpertFit, Headline, NullBand, Reached, RegimeMetrics, Value, Values,
};
use crate::{DataRange, Definitions};

/// Everything that scoring one lifetime gives. Serialises to the reference's `NAME_metrics.json`; regimes have a
/// table of their own, see [`LifetimeMetrics::regime_tsv`].
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct LifetimeMetrics {
    /// The values of the whole lifetime, by name; they stand at the top level of the JSON. Which there are, the
    /// metrics say: see [`Metric::headlines`](crate::Metric::headlines).
    #[serde(flatten)]
    pub lifetime: Values,
    /// Name of the log.
    pub run_id: String,
    /// As in `scenario_info.json`; empty where it did not say.
    pub complexity: String,
    /// As in `scenario_info.json`; empty where it did not say.
    pub difficulty: String,
    /// As in `scenario_info.json`; empty where it did not say.
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
    /// Range per task that was scaled to 1..=101; `null` where nothing was normalised.
    pub normalization_data_range: Option<IndexMap<String, DataRange>>,
    /// Means of the columns as they were logged, by column: what was scored first, then `reward` and `success` where the log has them.
    /// Of these, lifetimes can be compared whatever each was scaled by.
    #[serde(default)]
    pub as_logged: IndexMap<String, AsLogged>,
    /// What a reader of the values must be told; in the JSON where there is anything.
    #[serde(default)]
    pub notes: Vec<String>,
    /// Of metrics that evaluations alone decide, where they would lie if the agent had never changed, by name; contrasts of
    /// transfer are there even where only ratios were asked for. Not in the JSON, which has the reference's fields.
    #[serde(default, rename = "null")]
    pub null_bands: IndexMap<String, NullBand>,
    /// What each null band was made of: a value of each of [`NULL_PERMUTATIONS`](crate::NULL_PERMUTATIONS) permutations,
    /// in an order that all lifetimes share, infinite where there was none. Not in the JSON; empty where a lifetime was
    /// read back.
    #[serde(skip)]
    pub null_draws: IndexMap<String, Vec<f64>>,
    /// What each task came to in evaluations, in the log's unit. Not in the JSON, which has the reference's fields.
    #[serde(default)]
    pub reached: IndexMap<String, Reached>,
    /// What the evaluation curve of each task says, without regard to borders between tasks. Not in the JSON, which has
    /// the reference's fields.
    #[serde(default)]
    pub curves: IndexMap<String, EvaluationCurve>,
    /// What a reader must be told of tasks that were never learned, and of experts that are not like for like. Not in
    /// the JSON, which has the reference's fields.
    #[serde(default)]
    pub cautions: Vec<String>,
    /// What experts learned from, beside the lifetime, by task. Not in the JSON, which has the reference's fields.
    #[serde(default, rename = "experts")]
    pub expert_fits: IndexMap<String, Vec<ExpertFit>>,
    /// The values of each task, by first learning block: headlines, then the lists behind them.
    pub task_metrics: IndexMap<String, Values>,
    /// The values of each regime, in order; not in the JSON.
    #[serde(skip)]
    pub regimes: Vec<RegimeMetrics>,
    /// The names of the values of a lifetime, in order; not in the JSON, and those of the built-in metrics where a
    /// lifetime was read back.
    #[serde(skip, default = "crate::score::built_in_headlines")]
    pub headlines: Vec<Headline>,
    /// The definitions it was scored by; in the JSON only where they are not the reference's.
    #[serde(default)]
    pub definitions: Definitions,
}

/// What stands in the JSON, in order.
#[derive(Serialize)]
struct Document<'a> {
    #[serde(flatten)]
    lifetime: IndexMap<&'a str, Option<Value>>,
    run_id: &'a str,
    complexity: &'a str,
    difficulty: &'a str,
    scenario_type: &'a str,
    metrics_column: &'a str,
    #[serde(skip_serializing_if = "Definitions::is_reference")]
    definitions: Definitions,
    min: f64,
    max: f64,
    num_lx: usize,
    num_ex: usize,
    runtime: f64,
    normalization_data_range: Option<&'a IndexMap<String, DataRange>>,
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    as_logged: &'a IndexMap<String, AsLogged>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    notes: &'a [String],
    task_metrics: &'a IndexMap<String, Values>,
}

impl Serialize for LifetimeMetrics {
    /// QUIRK: the values of the lifetime have ten decimals, as in the reference's file; those of tasks, and all under
    /// the published definitions, are not rounded.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let rounded = |number: f64| match self.definitions {
            Definitions::Reference => ten_decimals(number),
            Definitions::Published => number,
        };
        // As in the reference, what was asked for and could not be computed is null.
        let asked = self.headlines.iter().map(|headline| (&*headline.name, None));
        let mut lifetime: IndexMap<&str, Option<Value>> = asked.collect();
        for (name, value) in self.lifetime.iter() {
            let value = match value {
                Value::Number(number) => Value::Number(rounded(*number)),
                other => other.clone(),
            };
            lifetime.insert(name, Some(value));
        }
        let document = Document {
            lifetime,
            run_id: &self.run_id,
            complexity: &self.complexity,
            difficulty: &self.difficulty,
            scenario_type: &self.scenario_type,
            metrics_column: &self.metrics_column,
            definitions: self.definitions,
            min: rounded(self.min),
            max: rounded(self.max),
            num_lx: self.num_lx,
            num_ex: self.num_ex,
            runtime: rounded(self.runtime),
            normalization_data_range: self.normalization_data_range.as_ref(),
            as_logged: &self.as_logged,
            notes: &self.notes,
            task_metrics: &self.task_metrics,
        };
        document.serialize(serializer)
    }
}

/// One line of the table of a lifetime.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SummaryRow {
    /// Name of the metric, as in the JSON.
    pub name: Cow<'static, str>,
    /// Its value; `None` where it was not asked for or could not be computed.
    pub value: Option<f64>,
    /// What it says, in one line.
    pub explanation: Cow<'static, str>,
    /// Which way is good.
    pub good: Direction,
    /// Where the value would lie if the agent had never changed; `None` for a metric that learning decides, too.
    pub null_band: Option<NullBand>,
}

impl LifetimeMetrics {
    /// The lifetime's values as a table, one row for each headline of the metrics it was scored with, also those
    /// without a value. Where transfer was asked for as a ratio only, the contrasts come first: a mean of ratios is above 1 even
    /// if nothing is transferred.
    pub fn summary(&self) -> Vec<SummaryRow> {
        let row = |headline: &Headline| {
            let null_band = self.null_bands.get(&*headline.name).copied();
            let value = self.lifetime.number(&headline.name);
            SummaryRow {
                name: headline.name.clone(),
                value: value.or_else(|| null_band.map(|band| band.value)),
                explanation: headline.explanation.clone(),
                good: headline.good,
                null_band,
            }
        };
        let is_there = |name: &str| self.headlines.iter().any(|headline| headline.name == name);
        let has_band = |name: &str| self.null_bands.contains_key(name);
        let mut contrasts: Vec<Headline> = crate::score::built_in_headlines();
        contrasts.retain(|headline| has_band(&headline.name) && !is_there(&headline.name));
        let mut rows = Vec::new();
        for headline in &self.headlines {
            if headline.name.ends_with("_transfer_ratio") {
                rows.extend(contrasts.drain(..).map(|contrast| row(&contrast)));
            }
            rows.push(row(headline));
        }
        rows
    }
}
