//! Short paths of many items: the nearest walk made better step by step. The steps are in `local_search.rs`.

use super::items::Items;
use super::{local_search, nearest};

/// How many times the path is shaken, for each item.
const SHAKES_PER_ITEM: usize = 20;

pub(super) fn order(items: &Items) -> Vec<usize> {
    let cost = |a: usize, b: usize| items.gap(a, b);
    let walk = nearest::walk(items.len(), &cost, items.ends);
    let path = local_search::improve(walk, &cost, items.ends, SHAKES_PER_ITEM * items.len());
    from_the_lower_end(path, items)
}

/// A path is as long backwards: without fixed ends it begins with that of its ends whose name comes first.
pub(super) fn from_the_lower_end(mut path: Vec<usize>, items: &Items) -> Vec<usize> {
    let free = items.ends.first.is_none() && items.ends.last.is_none();
    if free && path.first() > path.last() {
        path.reverse();
    }
    path
}
