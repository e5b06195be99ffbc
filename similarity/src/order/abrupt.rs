//! The longest path: neighbours as unlike as can be. Searched as the shortest one of turned distances, by the methods for that.

use super::exact::{MAX_EXACT, best_path};
use super::items::Items;
use super::two_opt::from_the_lower_end;
use super::{local_search, nearest};

/// How many times the path is shaken, for each item.
const SHAKES_PER_ITEM: usize = 1;

pub(super) fn order(items: &Items) -> Vec<usize> {
    let (n, largest) = (items.len(), items.largest_gap());
    // Every path has as many steps: what one is short of the largest everywhere, it lacks in length.
    let cost = |a: usize, b: usize| largest - items.gap(a, b);
    if n <= MAX_EXACT {
        return best_path(n, &cost, items.ends);
    }
    let walk = nearest::walk(n, &cost, items.ends);
    let path = local_search::improve(walk, &cost, items.ends, SHAKES_PER_ITEM * n);
    from_the_lower_end(path, items)
}
