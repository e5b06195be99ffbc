//! The longest path: neighbours as unlike as can be. Searched as the shortest one of turned distances, by the methods for that.

use super::items::Items;
use super::two_opt::cheapest;

/// How many times the path is shaken, for each item.
const SHAKES_PER_ITEM: usize = 1;

pub(super) fn order(items: &Items) -> Vec<usize> {
    let largest = items.largest_gap();
    // Every path has as many steps: what one is short of the largest everywhere, it lacks in length.
    cheapest(items, &|a, b| largest - items.gap(a, b), SHAKES_PER_ITEM)
}
