//! From the values of the tasks to the one value of the lifetime.
//!
//! Not here: averages over several lifetimes.

use indexmap::IndexMap;

use super::transfer::{Pairs, Transfers};
use crate::AggregationMethod;
use crate::report::{LifetimeScores, TaskMetrics};
use crate::statistics::{mean, median};

/// Mean or median over tasks, missing values skipped.
///
/// QUIRK: of a pair of tasks only the first transfer counts, however often the pair met.
pub(super) fn over_tasks(
    tasks: &IndexMap<String, TaskMetrics>,
    transfers: &Transfers,
    method: AggregationMethod,
) -> LifetimeScores {
    let aggregate = |values: Vec<f64>| match method {
        AggregationMethod::Mean => mean(&values),
        AggregationMethod::Median => median(values),
    };
    let over = |value: fn(&TaskMetrics) -> Option<f64>| aggregate(tasks.values().filter_map(value).collect());
    let of_pairs = |pairs: &Option<Pairs>| pairs.as_ref().and_then(|pairs| aggregate(pairs.first_values()));
    LifetimeScores {
        perf_recovery: over(|task| task.perf_recovery),
        avg_train_perf: over(|task| task.avg_train_perf),
        avg_eval_perf: over(|task| task.avg_eval_perf),
        perf_maintenance_mrlep: over(|task| task.perf_maintenance_mrlep),
        perf_maintenance_mrtlp: over(|task| task.perf_maintenance_mrtlp),
        forward_transfer_ratio: of_pairs(&transfers.forward_ratio),
        backward_transfer_ratio: of_pairs(&transfers.backward_ratio),
        forward_transfer_contrast: of_pairs(&transfers.forward_contrast),
        backward_transfer_contrast: of_pairs(&transfers.backward_contrast),
        ste_rel_perf: over(|task| task.ste_rel_perf),
        sample_efficiency: over(|task| task.sample_efficiency),
    }
}
