//! The cheapest path through few items, by dynamic programming over sets (Held and Karp 1962). The caller passes in the costs of
//! steps.

use super::items::{Ends, Items};
use crate::SimilarityError;

/// Maximum number of items for an exact search, which takes 4 MB and some milliseconds; one more item doubles both.
pub const MAX_EXACT: usize = 15;

pub(super) fn order(items: &Items) -> Result<Vec<usize>, SimilarityError> {
    if items.len() > MAX_EXACT {
        return Err(SimilarityError::TooManyForMethod {
            method: "exact",
            found: items.len(),
            limit: MAX_EXACT,
        });
    }
    Ok(best_path(items.len(), &|a, b| items.gap(a, b), items.ends))
}

/// The path with the minimum total cost; ties (within rounding) go to the lowest numbers first. Steps of infinite cost are
/// taken only if every path has one. Time `O(2ⁿ n²)`, memory `2ⁿ n` numbers; `n` is at most [`MAX_EXACT`].
pub(super) fn best_path(n: usize, cost: &impl Fn(usize, usize) -> f64, ends: Ends) -> Vec<usize> {
    debug_assert!(n <= MAX_EXACT, "larger sets are refused earlier");
    let costs: Vec<f64> = (0..n * n).map(|k| cost(k / n, k % n)).collect();
    let rest = remaining_costs(n, &costs, ends.last);
    let largest = costs
        .iter()
        .filter(|cost| cost.is_finite())
        .fold(0.0_f64, |a, b| a.max(b.abs()));
    let slack = 1e-12 * largest * n as f64;
    // Rounding must not decide between equal paths: of all values within rounding, the lowest number is taken.
    let lowest = |values: &[(usize, f64)]| {
        let least = values.iter().map(|(_, value)| *value).fold(f64::INFINITY, f64::min);
        values
            .iter()
            .find(|(_, value)| *value <= least + slack)
            .map(|(item, _)| *item)
    };
    let full = (1_usize << n) - 1;
    let starts: Vec<(usize, f64)> = (0..n)
        .filter(|item| ends.first.is_none_or(|first| first == *item))
        .map(|item| (item, rest[full * n + item]))
        .collect();
    let mut path: Vec<usize> = lowest(&starts).into_iter().collect();
    let mut set = full;
    while path.len() < n {
        let here = path[path.len() - 1];
        set &= !(1 << here);
        let choices: Vec<(usize, f64)> = (0..n)
            .filter(|item| set >> item & 1 == 1)
            .map(|item| (item, costs[here * n + item] + rest[set * n + item]))
            .collect();
        path.push(lowest(&choices).expect("an item remains"));
    }
    path
}

/// For each set and each item of it: the minimum total cost of a path that begins there, visits the set, and ends at the fixed
/// last item, if any.
fn remaining_costs(n: usize, costs: &[f64], last: Option<usize>) -> Vec<f64> {
    let mut rest = vec![f64::INFINITY; (1 << n) * n];
    for end in (0..n).filter(|end| last.is_none_or(|last| last == *end)) {
        rest[(1 << end) * n + end] = 0.0;
    }
    for set in 1_usize..1 << n {
        if set.is_power_of_two() {
            continue;
        }
        for start in (0..n).filter(|start| set >> start & 1 == 1) {
            let others = set & !(1 << start);
            let mut least = f64::INFINITY;
            for next in (0..n).filter(|next| others >> next & 1 == 1) {
                least = least.min(costs[start * n + next] + rest[others * n + next]);
            }
            rest[set * n + start] = least;
        }
    }
    rest
}
