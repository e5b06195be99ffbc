//! The least typical item first, the most typical last (Li and Hiratani 2025). Looks at no step.

use super::items::{Items, by_rising};

/// An item is as typical as it is similar to all: by falling mean distance, so that the medoid comes last. Time `O(n²)`.
///
/// Source: Li and Hiratani 2025, "Optimal task order for continual learning of multiple tasks", who find that the least
/// representative tasks belong first.
pub(super) fn order(items: &Items) -> Vec<usize> {
    let n = items.len();
    let typical: Vec<f64> = (0..n).map(|a| -(0..n).map(|b| items.gap(a, b)).sum::<f64>()).collect();
    items.with_ends_outside(by_rising(&typical))
}
