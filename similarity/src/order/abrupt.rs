//! The longest path: neighbours are as different as possible. Found as the shortest path of reversed distances.

use super::items::Items;
use super::two_opt::cheapest;

/// Random perturbations (shakes) of the path, per item.
const SHAKES_PER_ITEM: usize = 1;

pub(super) fn order(items: &Items) -> Vec<usize> {
    let largest = items.largest_gap();
    // All paths have the same number of steps, so minimising the distance to the largest gap maximises the length.
    cheapest(items, &|a, b| largest - items.gap(a, b), SHAKES_PER_ITEM)
}
