//! Searches for paths whose largest step is small.

use super::items::Items;
use super::local_search;
use super::two_opt::starting_at_lower_end;

/// Shakes per item in each round of the search.
const SHAKES_PER_ITEM: usize = 2;
/// Minimum number of shakes: a short path has few possible swaps, and they are tried at random.
const MIN_SHAKES: usize = 200;
/// Number of bounds tried.
const ROUNDS: usize = 12;

/// Searches for a path with a small largest step, starting from a short path; each round halves the interval in which the
/// smallest largest step can lie.
pub(super) fn search(short: &[usize], items: &Items) -> Vec<usize> {
    let mut best = short.to_vec();
    let mut reached = largest_step(&best, items);
    // Every path has a step at least as large as the largest in the minimum spanning tree.
    let mut impossible = largest_branch(items);
    let largest = items.largest_gap();
    let shakes = MIN_SHAKES.max(SHAKES_PER_ITEM * items.len());
    for _ in 0..ROUNDS {
        if reached <= impossible * (1.0 + 1e-12) {
            break;
        }
        let bound = f64::midpoint(impossible, reached);
        // A step beyond the bound costs more than it could ever save, and its cost grows with its length.
        let cost = |a: usize, b: usize| {
            let gap = items.gap(a, b);
            if gap <= bound {
                gap
            } else {
                gap + 4.0 * largest + 10.0 * (gap - bound)
            }
        };
        let path = local_search::improve(best.clone(), &cost, items.ends, shakes);
        let found = largest_step(&path, items);
        if found <= bound {
            (best, reached) = (path, found);
        } else {
            // Not proof that there is no such path, but the search finds none.
            impossible = bound;
            if found < reached {
                (best, reached) = (path, found);
            }
        }
    }
    starting_at_lower_end(best, items)
}

/// The largest distance in the minimum spanning tree, by Prim's algorithm; 0 for a single item.
fn largest_branch(items: &Items) -> f64 {
    let mut reach: Vec<f64> = (0..items.len()).map(|item| items.gap(0, item)).collect();
    let mut left: Vec<usize> = (1..items.len()).collect();
    let mut largest = 0.0_f64;
    while let Some(best) = (0..left.len()).min_by(|a, b| reach[left[*a]].total_cmp(&reach[left[*b]])) {
        let here = left.remove(best);
        largest = largest.max(reach[here]);
        for item in &left {
            reach[*item] = reach[*item].min(items.gap(here, *item));
        }
    }
    largest
}

pub(super) fn largest_step(path: &[usize], items: &Items) -> f64 {
    path.windows(2)
        .map(|pair| items.gap(pair[0], pair[1]))
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::super::exact::best_path;
    use super::super::two_opt;
    use super::*;
    use crate::OrderOptions;
    use crate::{DistanceMatrix, SimilarityError};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn search_is_close_to_the_exact_answer(
            points in prop::collection::vec(prop::array::uniform2(0.0..10.0_f64), 8..12),
        ) {
            let labels = (0..points.len()).map(|k| format!("{k:02}")).collect();
            let gap = |a: usize, b: usize| libm::hypot(points[a][0] - points[b][0], points[a][1] - points[b][1]);
            let matrix = DistanceMatrix::measure(labels, |a, b| Ok::<_, SimilarityError>(gap(a, b))).unwrap();
            let items = Items::new(&matrix, &OrderOptions::default()).unwrap();
            let mut bounds: Vec<f64> = matrix.values().iter().copied().collect();
            bounds.sort_by(f64::total_cmp);
            // The smallest bound that some path respects.
            let keeps = |bound: &f64| {
                let cost = |a: usize, b: usize| f64::from(items.gap(a, b) > *bound);
                let path = best_path(points.len(), &cost, items.ends);
                largest_step(&path, &items) <= *bound
            };
            let least = bounds[bounds.partition_point(|bound| !keeps(bound))];
            let found = largest_step(&search(&two_opt::order(&items), &items), &items);
            prop_assert!(found >= least - 1e-9 && found <= 1.25 * least + 1e-9, "{} for {}", found, least);
        }
    }
}
