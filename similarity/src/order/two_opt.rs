//! Short paths of many items: the nearest walk made better step by step. The steps are in `local_search.rs`.

use super::exact::{MAX_EXACT, best_path};
use super::items::Items;
use super::{local_search, nearest};

/// How many times the path is shaken, for each item.
const SHAKES_PER_ITEM: usize = 8;

pub(super) fn order(items: &Items) -> Vec<usize> {
    search(items, &|a, b| items.gap(a, b), SHAKES_PER_ITEM)
}

/// The cheapest path: exact for few items, beyond the cheapest that a search finds, shaken so many times for each item.
pub(super) fn cheapest(items: &Items, cost: &(impl Fn(usize, usize) -> f64 + Sync), shakes: usize) -> Vec<usize> {
    if items.len() <= MAX_EXACT {
        best_path(items.len(), cost, items.ends)
    } else {
        search(items, cost, shakes)
    }
}

fn search(items: &Items, cost: &(impl Fn(usize, usize) -> f64 + Sync), shakes: usize) -> Vec<usize> {
    let walk = nearest::walk(items.len(), cost, items.ends);
    let path = local_search::improve(walk, cost, items.ends, shakes * items.len());
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
