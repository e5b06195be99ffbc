//! Pools the transfer of each pair of variants over many lifetimes.

use std::collections::BTreeMap;

use driftworld_metrics::{LifetimeMetrics, TransferMethod};
use driftworld_similarity::PairValue;

use super::names::Names;

/// The mean over lifetimes of each pair's first transfer, and the number of lifetimes that had one, in the order of the matrix.
/// `direction` is `forward` if the evaluated variant had not been learned yet, else `backward`.
pub(super) fn pool(
    lifetimes: &[LifetimeMetrics],
    names: &Names,
    direction: &str,
    measure: TransferMethod,
) -> Vec<(PairValue, usize)> {
    let measure = match measure {
        TransferMethod::Ratio => "ratio",
        TransferMethod::Contrast | TransferMethod::Both => "contrast",
    };
    let metric = format!("{direction}_transfer_{measure}");
    let mut sums: BTreeMap<(usize, usize), (f64, usize)> = BTreeMap::new();
    for lifetime in lifetimes {
        for (trained, task) in &lifetime.task_metrics {
            let (Some(from), Some(values)) = (names.index(trained), task.pairs(&metric)) else {
                continue;
            };
            for (other, values) in values {
                if let (Some(to), Some(first)) = (names.index(other), values.first()) {
                    let (sum, count) = sums.entry((from, to)).or_default();
                    *sum += first;
                    *count += 1;
                }
            }
        }
    }
    let mean = |((from, to), (sum, count)): ((usize, usize), (f64, usize))| {
        let value = sum / count as f64;
        (PairValue { from, to, value }, count)
    };
    sums.into_iter().map(mean).collect()
}
