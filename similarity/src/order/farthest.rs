//! Farthest-first traversal: each next item is the farthest from all items so far.

use super::items::Items;

/// Farthest-first traversal (Gonzalez 1985): starts at an end of the largest distance, unless the first item is fixed. Time
/// `O(n²)`.
pub(super) fn order(items: &Items) -> Vec<usize> {
    let n = items.len();
    let last = items.ends.last;
    let start = items.ends.first.unwrap_or_else(|| outermost(items));
    // Distance to the nearest item so far.
    let mut reach: Vec<f64> = (0..n).map(|item| items.gap(start, item)).collect();
    let mut left: Vec<usize> = (0..n).filter(|item| *item != start && Some(*item) != last).collect();
    let mut path = vec![start];
    while !left.is_empty() {
        let mut best = 0;
        for index in 1..left.len() {
            if reach[left[index]] > reach[left[best]] {
                best = index;
            }
        }
        let here = left.remove(best);
        for item in &left {
            reach[*item] = reach[*item].min(items.gap(here, *item));
        }
        path.push(here);
    }
    path.extend(last.filter(|last| *last != start));
    path
}

/// The first item, other than the fixed last, that has the largest distance to any other.
fn outermost(items: &Items) -> usize {
    let farthest = |a: usize| (0..items.len()).map(|b| items.gap(a, b)).fold(0.0, f64::max);
    let mut best = None;
    for item in (0..items.len()).filter(|item| Some(*item) != items.ends.last) {
        let found = farthest(item);
        if best.is_none_or(|(_, most)| found > most) {
            best = Some((item, found));
        }
    }
    best.map_or(0, |(item, _)| item)
}
