//! Paths of small steps: the shortest, and among equally short ones the one whose largest step is smallest.

use super::exact::{MAX_EXACT, best_path};
use super::items::Items;
use super::small_steps::{self, largest_step};
use super::two_opt;

/// Lengths that differ by at most this share are equal.
const EQUAL: f64 = 1e-9;

/// Exact for few items. For more, the two-opt path, unless the search for small largest steps finds a path that is no
/// longer and has a smaller largest step.
pub(super) fn order(items: &Items) -> Vec<usize> {
    if items.len() > MAX_EXACT {
        let short = two_opt::order(items);
        let even = small_steps::search(&short, items);
        let is_as_short = length(&even, items) <= length(&short, items) * (1.0 + EQUAL);
        let is_better = is_as_short && largest_step(&even, items) < largest_step(&short, items);
        return if is_better { even } else { short };
    }
    // More than the length of any path, and finite: even if every path needs such a step, the fixed ends are respected.
    let penalty = 2.0 * items.len() as f64 * items.largest_gap();
    let within = |bound: f64| {
        let cost = |a: usize, b: usize| {
            let gap = items.gap(a, b);
            if gap <= bound { gap } else { gap + penalty }
        };
        best_path(items.len(), &cost, items.ends)
    };
    let mut best = within(f64::INFINITY);
    let longest = length(&best, items) * (1.0 + EQUAL);
    // Binary search over all gaps for the smallest bound that still allows a shortest path.
    let mut bounds: Vec<f64> = items.matrix.values().iter().copied().collect();
    bounds.retain(|gap| *gap < largest_step(&best, items));
    bounds.sort_by(f64::total_cmp);
    bounds.dedup();
    let (mut low, mut high) = (0, bounds.len());
    while low < high {
        let middle = usize::midpoint(low, high);
        let path = within(bounds[middle]);
        if length(&path, items) <= longest && largest_step(&path, items) <= bounds[middle] {
            (best, high) = (path, middle);
        } else {
            low = middle + 1;
        }
    }
    best
}

fn length(path: &[usize], items: &Items) -> f64 {
    path.windows(2).map(|pair| items.gap(pair[0], pair[1])).sum()
}

#[cfg(test)]
mod tests {
    use crate::{DistanceMatrix, Method, OrderOptions, SimilarityError, order};

    #[test]
    fn tie_of_shortest_paths_goes_to_the_smaller_largest_step() {
        // From a: a-b-c-d is 1 + 1 + 4, a-c-b-d is 2 + 1 + 3, and no path is shorter.
        let gap = |a: usize, b: usize| {
            let gaps = [[0, 1, 2, 9], [1, 0, 1, 3], [2, 1, 0, 4], [9, 3, 4, 0]];
            Ok::<_, SimilarityError>(f64::from(gaps[a][b]))
        };
        let matrix = DistanceMatrix::measure(["a", "b", "c", "d"].map(str::to_owned).to_vec(), gap).unwrap();
        let found = |method| order(&matrix, method, &OrderOptions::default().with_first(0)).unwrap();
        assert_eq!(
            (found(Method::Exact).length, found(Method::Exact).largest_step()),
            (6.0, 4.0)
        );
        assert_eq!(
            (found(Method::Gradual).length, found(Method::Gradual).largest_step()),
            (6.0, 3.0)
        );
    }

    #[test]
    fn outward_sorts_by_distance_from_the_first() {
        let at = [0.0_f64, -2.0, 1.0, 3.0];
        let names = ["a", "b", "c", "d"].map(str::to_owned).to_vec();
        let matrix = DistanceMatrix::measure(names, |a, b| Ok::<_, SimilarityError>((at[a] - at[b]).abs())).unwrap();
        let found = |first| order(&matrix, Method::Outward, &OrderOptions::default().with_first(first)).unwrap();
        assert_eq!(found(0).indices, [0, 2, 1, 3]);
        assert_eq!(found(3).indices, [3, 2, 0, 1]);
    }
}
