//! Short paths of many items: nearest-neighbour walks improved by local search.

use super::exact::{MAX_EXACT, best_path};
use super::items::Items;
use super::{local_search, nearest};

/// Random perturbations (shakes) of the path, per item.
const SHAKES_PER_ITEM: usize = 8;

pub(super) fn order(items: &Items) -> Vec<usize> {
    search(items, &|a, b| items.gap(a, b), SHAKES_PER_ITEM)
}

/// The cheapest path: exact for few items, otherwise by local search with `shakes` shakes per item.
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
    starting_at_lower_end(path, items)
}

/// A path has the same length backwards: without fixed ends, it begins at the end whose name comes first.
pub(super) fn starting_at_lower_end(mut path: Vec<usize>, items: &Items) -> Vec<usize> {
    let free = items.ends.first.is_none() && items.ends.last.is_none();
    if free && path.first() > path.last() {
        path.reverse();
    }
    path
}
