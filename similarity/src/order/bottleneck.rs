//! Paths whose largest step is as small as can be. Paths of least length are in `exact.rs` and `two_opt.rs`.

use super::exact::{MAX_EXACT, Total, best_path};
use super::items::Items;
use super::two_opt::{self, from_the_lower_end};
use super::{local_search, tree};

/// How many times the path is shaken in each round of the search, for each item.
const SHAKES_PER_ITEM: usize = 2;
/// How many times it is shaken at least: a short path has few ways to change places, and each is tried by draw.
const LEAST_SHAKES: usize = 200;
/// How many bounds are tried.
const ROUNDS: usize = 12;

/// Exact for few items; beyond, a search that halves the span in which the smallest largest step can lie.
pub(super) fn order(items: &Items) -> Vec<usize> {
    if items.len() <= MAX_EXACT {
        return exact(items);
    }
    from_the_lower_end(search(items), items)
}

fn exact(items: &Items) -> Vec<usize> {
    let n = items.len();
    let even = best_path(n, &|a, b| items.gap(a, b), items.ends, Total::Largest);
    let bound = largest_step(&even, items) * (1.0 + 1e-12);
    // Of all paths that keep to the smallest largest step, the shortest.
    let cost = |a: usize, b: usize| {
        let gap = items.gap(a, b);
        if gap <= bound { gap } else { f64::INFINITY }
    };
    best_path(n, &cost, items.ends, Total::Sum)
}

fn search(items: &Items) -> Vec<usize> {
    let mut best = two_opt::order(items);
    let mut reached = largest_step(&best, items);
    // Whatever connects all items has a step as large as the largest in their minimum spanning tree.
    let mut impossible = tree::largest_branch(items);
    let largest = items.largest_gap();
    let shakes = LEAST_SHAKES.max(SHAKES_PER_ITEM * items.len());
    for _ in 0..ROUNDS {
        if reached <= impossible * (1.0 + 1e-12) {
            break;
        }
        let bound = f64::midpoint(impossible, reached);
        // Any step beyond the bound costs more than all that it could save, and the more the farther it goes.
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
            // Not proof that there is none: but none that this search finds.
            impossible = bound;
            if found < reached {
                (best, reached) = (path, found);
            }
        }
    }
    best
}

fn largest_step(path: &[usize], items: &Items) -> f64 {
    path.windows(2)
        .map(|pair| items.gap(pair[0], pair[1]))
        .fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::OrderOptions;
    use crate::{DistanceMatrix, SimilarityError};
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn the_search_for_many_comes_near_the_exact_answer(
            points in prop::collection::vec(prop::array::uniform2(0.0..10.0_f64), 8..12),
        ) {
            let labels = (0..points.len()).map(|k| format!("{k:02}")).collect();
            let gap = |a: usize, b: usize| libm::hypot(points[a][0] - points[b][0], points[a][1] - points[b][1]);
            let matrix = DistanceMatrix::measure(labels, |a, b| Ok::<_, SimilarityError>(gap(a, b))).unwrap();
            let items = Items::new(&matrix, &OrderOptions::default()).unwrap();
            let (least, found) = (largest_step(&exact(&items), &items), largest_step(&search(&items), &items));
            prop_assert!(found >= least - 1e-9 && found <= 1.25 * least + 1e-9, "{} for {}", found, least);
        }
    }
}
