//! The result of scoring one lifetime, and its JSON: field names and values of the reference's `NAME_metrics.json`.
//!
//! Not here: the values per task, see `task_metrics`.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use super::rounding::{ten_decimals, ten_decimals_if_any};
use super::{RegimeMetrics, TaskMetrics};
use crate::DataRange;

/// One value per metric for a whole lifetime. `None`, and absent in JSON, where a value was not asked for or could
/// not be computed; never NaN. JSON has ten decimals.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct LifetimeScores {
    /// Minus the trend of recovery times, in experiences per learning regime; higher is better.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "ten_decimals_if_any")]
    pub perf_recovery: Option<f64>,
    /// Mean performance while learning, in normalised units (1..=101); higher is better.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "ten_decimals_if_any")]
    pub avg_train_perf: Option<f64>,
    /// Mean performance in evaluations, in normalised units; higher is better.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "ten_decimals_if_any")]
    pub avg_eval_perf: Option<f64>,
    /// Change since the evaluation right after learning, in normalised units; below 0 is forgetting.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "ten_decimals_if_any")]
    pub perf_maintenance_mrlep: Option<f64>,
    /// Change since the end of learning, in normalised units; below 0 is forgetting.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "ten_decimals_if_any")]
    pub perf_maintenance_mrtlp: Option<f64>,
    /// After over before, for tasks not yet learnt; above 1 helps.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "ten_decimals_if_any")]
    pub forward_transfer_ratio: Option<f64>,
    /// After over before, for tasks learnt earlier; above 1 helps.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "ten_decimals_if_any")]
    pub backward_transfer_ratio: Option<f64>,
    /// Difference over sum, −1..=1 for performances above 0, for tasks not yet learnt; above 0 helps.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "ten_decimals_if_any")]
    pub forward_transfer_contrast: Option<f64>,
    /// Difference over sum, −1..=1 for performances above 0, for tasks learnt earlier; above 0 helps.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "ten_decimals_if_any")]
    pub backward_transfer_contrast: Option<f64>,
    /// Performance gathered while learning over a single-task expert's; above 1 is better than the expert.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "ten_decimals_if_any")]
    pub ste_rel_perf: Option<f64>,
    /// How good and how fast against a single-task expert; above 1 is better than the expert.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "ten_decimals_if_any")]
    pub sample_efficiency: Option<f64>,
}

/// Everything that scoring one lifetime gives. Serialises to the reference's `NAME_metrics.json`; regimes have a
/// table of their own, see [`LifetimeMetrics::regime_tsv`].
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LifetimeMetrics {
    /// The values of the whole lifetime; their fields stand at the top level of the JSON.
    #[serde(flatten)]
    pub lifetime: LifetimeScores,
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
    #[serde(serialize_with = "ten_decimals")]
    pub min: f64,
    /// Largest performance after preprocessing.
    #[serde(serialize_with = "ten_decimals")]
    pub max: f64,
    /// Learning experiences (rows).
    pub num_lx: usize,
    /// Evaluation experiences (rows).
    pub num_ex: usize,
    /// Seconds between the first and the last time stamp.
    #[serde(serialize_with = "ten_decimals")]
    pub runtime: f64,
    /// Range per task that was scaled to 1..=101; `null` where nothing was normalised.
    pub normalization_data_range: Option<IndexMap<String, DataRange>>,
    /// The values of each task, by first learning block.
    pub task_metrics: IndexMap<String, TaskMetrics>,
    /// The values of each regime, in order; not in the JSON.
    #[serde(skip)]
    pub regimes: Vec<RegimeMetrics>,
}
