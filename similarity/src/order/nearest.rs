//! The nearest-neighbour walk: always the nearest remaining item. Greedy; no local improvement.

use rayon::prelude::*;

use super::items::{Ends, Items};

/// Maximum number of items to try as the start of a walk.
const MAX_STARTS: usize = 256;

pub(super) fn order(items: &Items) -> Vec<usize> {
    walk(items.len(), &|a, b| items.gap(a, b), items.ends)
}

/// The cheapest of the walks from the fixed first item, or from each of the first 256 items. Time `O(starts · n²)`.
pub(super) fn walk(n: usize, cost: &(impl Fn(usize, usize) -> f64 + Sync), ends: Ends) -> Vec<usize> {
    let starts: Vec<usize> = match ends.first {
        Some(first) => vec![first],
        None => (0..n)
            .filter(|item| Some(*item) != ends.last)
            .take(MAX_STARTS)
            .collect(),
    };
    let walks: Vec<(f64, Vec<usize>)> = starts
        .into_par_iter()
        .map(|start| walk_from(n, cost, start, ends.last))
        .collect();
    walks
        .into_iter()
        .reduce(|best, next| if next.0 < best.0 { next } else { best })
        .map(|(_, path)| path)
        .unwrap_or_default()
}

fn walk_from(n: usize, cost: &impl Fn(usize, usize) -> f64, start: usize, last: Option<usize>) -> (f64, Vec<usize>) {
    let mut left: Vec<usize> = (0..n).filter(|item| *item != start && Some(*item) != last).collect();
    let (mut path, mut total, mut here) = (vec![start], 0.0, start);
    while !left.is_empty() {
        let mut best = (0, f64::INFINITY);
        for (index, item) in left.iter().enumerate() {
            let found = cost(here, *item);
            if found < best.1 {
                best = (index, found);
            }
        }
        here = left.remove(best.0);
        total += best.1;
        path.push(here);
    }
    if let Some(last) = last {
        total += cost(here, last);
        path.push(last);
    }
    (total, path)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_remaining_item_is_next_and_fixed_last_comes_last() {
        let at = [0.0_f64, 1.0, 2.5, 10.0];
        let cost = |a: usize, b: usize| (at[a] - at[b]).abs();
        let ends = |first, last| Ends { first, last };
        assert_eq!(walk(4, &cost, ends(Some(2), None)), [2, 1, 0, 3]);
        assert_eq!(walk(4, &cost, ends(Some(2), Some(1))), [2, 0, 3, 1]);
        assert_eq!(walk(4, &cost, ends(None, Some(0))), [3, 2, 1, 0]);
        assert_eq!(walk(4, &cost, ends(None, None)), [0, 1, 2, 3]);
        assert_eq!(walk(1, &cost, ends(Some(0), None)), [0]);
    }
}
