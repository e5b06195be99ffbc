//! One transfer for each pair of variants from many lifetimes. What is done with them is in the folder's `mod.rs`.

use std::collections::BTreeMap;

use driftworld_metrics::{LifetimeMetrics, PairValues, TransferMethod, Values};
use driftworld_similarity::PairValue;

use super::names::Names;

/// Whether the variant that gains or loses is still to be learned.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Direction {
    /// It is.
    Forward,
    /// It was learned before.
    Backward,
}

/// The mean over lifetimes of each pair's first transfer, and how many lifetimes had one, in the order of the matrix.
pub(super) fn pooled(
    lifetimes: &[LifetimeMetrics],
    names: &Names,
    direction: Direction,
    measure: TransferMethod,
) -> Vec<(PairValue, usize)> {
    let mut sums: BTreeMap<(usize, usize), (f64, usize)> = BTreeMap::new();
    for lifetime in lifetimes {
        for (trained, task) in &lifetime.task_metrics {
            let (Some(from), Some(values)) = (names.index(trained), values(task, direction, measure)) else {
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

fn values(task: &Values, direction: Direction, measure: TransferMethod) -> Option<&PairValues> {
    task.pairs(match (direction, measure) {
        (Direction::Forward, TransferMethod::Ratio) => "forward_transfer_ratio",
        (Direction::Forward, _) => "forward_transfer_contrast",
        (Direction::Backward, TransferMethod::Ratio) => "backward_transfer_ratio",
        (Direction::Backward, _) => "backward_transfer_contrast",
    })
}
