//! The values of one task and the lists behind them.
//!
//! Not here: how they are computed, see the file of each metric in `score`.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// Values from one trained task to each other task, in order of the later evaluation.
pub type PairValues = IndexMap<String, Vec<f64>>;

/// Values of one task. `None`, and absent in JSON, where a value was not asked for or could not be computed; never
/// NaN. Nothing here is rounded.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(default)]
pub struct TaskMetrics {
    /// Minus the Theil–Sen slope of `recovery_times`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub perf_recovery: Option<f64>,
    /// Mean of `avg_train_perf_vals`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub avg_train_perf: Option<f64>,
    /// Mean of `avg_eval_perf_vals`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub avg_eval_perf: Option<f64>,
    /// Mean over `maintenance_val_mrlep`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub perf_maintenance_mrlep: Option<f64>,
    /// Mean over `maintenance_val_mrtlp`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub perf_maintenance_mrtlp: Option<f64>,
    /// Ratios from this task, when learnt, to others not yet learnt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub forward_transfer_ratio: Option<PairValues>,
    /// Ratios from this task, when learnt, to others learnt before.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub backward_transfer_ratio: Option<PairValues>,
    /// Contrasts from this task, when learnt, to others not yet learnt.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub forward_transfer_contrast: Option<PairValues>,
    /// Contrasts from this task, when learnt, to others learnt before.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub backward_transfer_contrast: Option<PairValues>,
    /// Mean of `ste_rel_perf_vals`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ste_rel_perf: Option<f64>,
    /// Mean of `sample_efficiency_vals`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sample_efficiency: Option<f64>,
    /// Experiences until the task was as good as before, from its second wake learning regime on.
    pub recovery_times: Vec<f64>,
    /// Mean performance of each learning regime.
    pub avg_train_perf_vals: Vec<f64>,
    /// Mean performance of each evaluation regime.
    pub avg_eval_perf_vals: Vec<f64>,
    /// Differences to the most recent reference evaluation, in runs of consecutive regimes of the task.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub maintenance_val_mrlep: Option<Vec<Vec<f64>>>,
    /// Differences to the end of the most recent learning, in runs of consecutive regimes of the task.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub maintenance_val_mrtlp: Option<Vec<Vec<f64>>>,
    /// Performance gathered over the expert's, per run of the expert.
    pub ste_rel_perf_vals: Vec<f64>,
    /// Saturation of each run of the expert.
    pub ste_saturation_vals: Vec<f64>,
    /// Experiences of each run of the expert to its saturation.
    pub ste_exp_to_sat_vals: Vec<usize>,
    /// The task's saturation over the expert's.
    pub se_saturation_vals: Vec<f64>,
    /// The expert's experiences to saturation over the task's.
    pub se_exp_to_sat_vals: Vec<f64>,
    /// Product of the two.
    pub sample_efficiency_vals: Vec<f64>,
    /// Saturation over all of the task's wake learning.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub se_task_saturation: Option<f64>,
    /// Experiences to it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub se_task_exp_to_sat: Option<f64>,
    /// Smallest performance after preprocessing.
    pub min: f64,
    /// Largest performance after preprocessing.
    pub max: f64,
    /// Learning experiences (rows).
    pub num_lx: usize,
    /// Evaluation experiences (rows).
    pub num_ex: usize,
}
