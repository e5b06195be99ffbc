//! Orders by distance from the first item.

use super::items::{Items, ascending_ranks};

/// By increasing distance from the first item, which is the requested one, or by default the first by name. Time `O(n log n)`.
pub(super) fn order(items: &Items) -> Vec<usize> {
    let first = items.ends.first.unwrap_or(0);
    let distances: Vec<f64> = (0..items.len()).map(|item| items.gap(first, item)).collect();
    let mut ranks = ascending_ranks(&distances);
    // Other items may also be at distance 0.
    ranks.retain(|rank| *rank != first);
    ranks.insert(0, first);
    items.with_fixed_ends(ranks)
}
