//! [`bisimulation`]: the bisimulation metric between states of two large deterministic processes, computed only over pairs that
//! are reached together.

use std::collections::HashMap;

use super::certain_sums::CertainSums;
use super::process::{Mdp, no_such_state};
use crate::SimilarityError;

/// Maximum number of pairs that [`bisimulation`] visits; with 6 actions, they take about 3 GiB.
pub const MAX_PAIRS: usize = 1 << 24;

/// The distance between two states of two deterministic processes: the bounds are equal, except for rounding, if all reachable
/// pairs were visited.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bisimulation {
    /// Lower bound, in the unit of the rewards.
    pub lower: f64,
    /// Upper bound, in the unit of the rewards.
    pub upper: f64,
    /// Number of pairs of states visited.
    pub pairs: usize,
}

/// The bisimulation metric between a state of one deterministic decision process and a state of another with the same actions.
///
/// With one successor each, `d(s, t) = maxₐ (1 − c) |R(s, a) − R(t, a)| + c d(s', t')`, where action `a` leads from `s` to `s'`
/// and from `t` to `t'`: the Wasserstein-1 distance between two point masses is the distance between their points. So `d(s, t)`
/// depends only on the pairs that equal action sequences reach from `(s, t)`. In `0..=` the largest difference of rewards, in
/// the unit of the rewards: 0 between states from which every sequence of actions pays the same. Between worlds with the same
/// transitions, each state is paired with itself, so there are as many pairs as states.
///
/// `starts`: a state of the first and one of the second process. `discount`: `c`, 0 to 0.9999. `max_pairs`: how many
/// pairs to visit, 1 to [`MAX_PAIRS`]; nearest first. Pairs that are not visited count as 0 in the lower bound and as
/// the largest difference of two rewards in the upper: the gap is at most that difference times `cᵏ`, where `k` is the
/// number of steps for which all action sequences were followed.
///
/// Exact within rounding (some 1e-15 of the largest difference over `1 − c`): by policy iteration, for any discount. Memory
/// `O(pairs · actions)`, and as much time for each iteration.
///
/// Source: Ferns, Panangaden and Precup 2004, "Metrics for finite Markov decision processes"; for deterministic processes
/// Castro 2020, "Scalable methods for computing state similarity in deterministic Markov decision processes". Same numbers as
/// from `SciPy`'s linear programs, see `tests/oracle/mdp.json`.
///
/// # Errors
/// [`SimilarityError::SizesDiffer`] for different numbers of actions, [`SimilarityError::NoSuchState`] for an invalid start,
/// [`SimilarityError::TooMany`] above [`MAX_PAIRS`], [`SimilarityError::BadNumber`] for an invalid discount.
///
/// # Example
/// ```
/// use driftworld_similarity::{Mdp, bisimulation};
/// // A corridor of four cells in which the actions go left and right; the reward is at the right end, or nowhere.
/// let moves = vec![0, 1, 0, 2, 1, 3, 2, 3];
/// let goal = Mdp::new(4, 2, moves.clone(), vec![0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0])?;
/// let none = Mdp::new(4, 2, moves, vec![0.0; 8])?;
/// let found = bisimulation(&goal, &none, (0, 0), 0.9, 100)?;
/// // Two steps until the difference is reached, then it is paid for ever.
/// assert!((found.lower - 0.81).abs() < 1e-12);
/// assert_eq!(found.pairs, 4);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn bisimulation(
    a: &Mdp,
    b: &Mdp,
    starts: (usize, usize),
    discount: f64,
    max_pairs: usize,
) -> Result<Bisimulation, SimilarityError> {
    check(a, b, starts, discount, max_pairs)?;
    let reached = Reached::from(a, b, starts, 1.0 - discount, max_pairs.max(1));
    let sums = CertainSums {
        steps: a.actions(),
        next: &reached.next,
        costs: &reached.costs,
        discount,
    };
    // The starts are the first pair.
    let (values, error) = sums.solve();
    let lower = values[0];
    let upper = if reached.is_complete() {
        lower + error
    } else {
        let max_cost = (1.0 - discount) * largest_difference(a, b);
        let costs = reached.with_unvisited_cost(max_cost, a.actions());
        let (values, error) = CertainSums { costs: &costs, ..sums }.solve();
        values[0] + error
    };
    Ok(Bisimulation {
        lower: (lower - error).max(0.0),
        upper,
        pairs: reached.pairs,
    })
}

fn check(
    a: &Mdp,
    b: &Mdp,
    (of_a, of_b): (usize, usize),
    discount: f64,
    max_pairs: usize,
) -> Result<(), SimilarityError> {
    if !(0.0..=0.9999).contains(&discount) {
        return Err(SimilarityError::BadNumber {
            of: "discount",
            found: discount,
            expected: "a number from 0 to 0.9999",
        });
    }
    if a.actions() != b.actions() {
        return Err(SimilarityError::SizesDiffer {
            of: "decision processes",
            what: "actions",
            a: a.actions(),
            b: b.actions(),
        });
    }
    for (found, states) in [(of_a, a.states()), (of_b, b.states())] {
        if found >= states {
            return Err(no_such_state(found, states));
        }
    }
    SimilarityError::check_count(max_pairs, MAX_PAIRS)
}

/// The largest difference between a reward of one process and a reward of the other.
fn largest_difference(a: &Mdp, b: &Mdp) -> f64 {
    let ((low_a, high_a), (low_b, high_b)) = (a.reward_range(), b.reward_range());
    (high_a - low_b).max(high_b - low_a).max(0.0)
}

/// The pairs reachable from the starts, nearest first, followed by one entry for all pairs that were not visited.
#[derive(Debug)]
struct Reached {
    pairs: usize,
    /// `(pairs + 1, actions)`: the pair that each action leads to.
    next: Vec<u32>,
    /// `(pairs + 1, actions)`: differences of rewards, times `1 − c`.
    costs: Vec<f64>,
}

impl Reached {
    fn from(a: &Mdp, b: &Mdp, (of_a, of_b): (usize, usize), reward_share: f64, max_pairs: usize) -> Self {
        const UNVISITED: u32 = u32::MAX;
        let start = (of_a as u32, of_b as u32);
        let mut indices: HashMap<(u32, u32), u32> = HashMap::from([(start, 0)]);
        let mut pairs = vec![start];
        let (mut next, mut costs) = (Vec::new(), Vec::new());
        let mut num_expanded = 0;
        while let Some(&(of_a, of_b)) = pairs.get(num_expanded) {
            let (of_a, of_b) = (of_a as usize, of_b as usize);
            for action in 0..a.actions() {
                let pair = (a.successor(of_a, action), b.successor(of_b, action));
                let index = match indices.get(&pair) {
                    Some(index) => *index,
                    None if pairs.len() == max_pairs => UNVISITED,
                    None => {
                        let index = pairs.len() as u32;
                        indices.insert(pair, index);
                        pairs.push(pair);
                        index
                    }
                };
                next.push(index);
                costs.push(reward_share * (a.reward(of_a, action) - b.reward(of_b, action)).abs());
            }
            num_expanded += 1;
        }
        let beyond = pairs.len() as u32;
        for index in next.iter_mut().filter(|index| **index == UNVISITED) {
            *index = beyond;
        }
        next.extend(std::iter::repeat_n(beyond, a.actions()));
        costs.extend(std::iter::repeat_n(0.0, a.actions()));
        Self {
            pairs: pairs.len(),
            next,
            costs,
        }
    }

    /// Whether every action stays within the visited pairs.
    fn is_complete(&self) -> bool {
        let steps = self.next.len() / (self.pairs + 1);
        !self.next[..self.pairs * steps].contains(&(self.pairs as u32))
    }

    /// The costs, with this cost for each step from the entry of the pairs that were not visited.
    fn with_unvisited_cost(&self, cost: f64, actions: usize) -> Vec<f64> {
        let mut costs = self.costs.clone();
        let last = costs.len() - actions;
        costs[last..].fill(cost);
        costs
    }
}

#[cfg(test)]
mod tests {
    use super::super::drawn::process;
    use super::*;
    use proptest::prelude::*;

    /// All distances by the definition, iterated until the remainder is below 1e-11: `(states of a, states of b)`.
    fn by_definition(a: &Mdp, b: &Mdp, discount: f64) -> Vec<f64> {
        let width = b.states();
        let mut d = vec![0.0; a.states() * width];
        for _ in 0..2000 {
            let step_distance = |pair: usize, action: usize| {
                let (s, t) = (pair / width, pair % width);
                let (next_s, next_t) = (a.successor(s, action) as usize, b.successor(t, action) as usize);
                let paid = (a.reward(s, action) - b.reward(t, action)).abs();
                (1.0 - discount) * paid + discount * d[next_s * width + next_t]
            };
            let largest = |pair: usize| {
                (0..a.actions())
                    .map(|action| step_distance(pair, action))
                    .fold(0.0, f64::max)
            };
            let next: Vec<f64> = (0..d.len()).map(largest).collect();
            let change = next.iter().zip(&d).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            d = next;
            if discount / (1.0 - discount) * change < 1e-11 {
                break;
            }
        }
        d
    }

    #[test]
    fn invalid_arguments_are_refused() {
        let one = Mdp::new(1, 1, vec![0], vec![0.0]).unwrap();
        let two = Mdp::new(1, 2, vec![0; 2], vec![0.0; 2]).unwrap();
        let code = |b: &Mdp, starts, discount, max_pairs| {
            bisimulation(&one, b, starts, discount, max_pairs).unwrap_err().code()
        };
        assert_eq!(code(&two, (0, 0), 0.5, 9), "similarity/sizes-differ");
        assert_eq!(code(&one, (0, 1), 0.5, 9), "similarity/no-such-state");
        assert_eq!(code(&one, (0, 0), 0.5, usize::MAX), "similarity/too-many");
        assert_eq!(code(&one, (0, 0), 1.0, 9), "similarity/bad-number");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn result_matches_the_definition(a in process(6, 2), b in process(5, 2), discount in 0.0..0.9) {
            let expected = by_definition(&a, &b, discount);
            for (pair, expected) in expected.iter().enumerate() {
                let found = bisimulation(&a, &b, (pair / 5, pair % 5), discount, 1000).unwrap();
                prop_assert!((expected - found.lower).abs() < 1e-10 && (expected - found.upper).abs() < 1e-10);
                prop_assert!(found.pairs <= 30);
            }
        }

        #[test]
        fn bisimulation_is_a_pseudometric_that_scales(a in process(4, 2), b in process(4, 2), c in process(4, 2)) {
            let d = |a: &Mdp, b: &Mdp| bisimulation(a, b, (0, 0), 0.7, 100).unwrap().upper;
            prop_assert!(d(&a, &a) < 1e-12);
            prop_assert!((d(&a, &b) - d(&b, &a)).abs() < 1e-12);
            prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-12);
            let paying = |of: &Mdp, times: f64| {
                let rows = (0..4).flat_map(|s| (0..2).map(move |k| (s, k)));
                let rows = rows.map(|(s, k)| (of.successor(s, k), of.reward(s, k) * times + 3.0));
                let (to, rewards) = rows.unzip();
                Mdp::new(4, 2, to, rewards).unwrap()
            };
            prop_assert!((d(&paying(&a, 4.0), &paying(&b, 4.0)) - 4.0 * d(&a, &b)).abs() < 1e-10);
        }

        #[test]
        fn renaming_states_gives_distance_0(
            a in process(4, 2),
            b in process(3, 2),
            names in Just([0_usize, 1, 2, 3]).prop_shuffle(),
        ) {
            let mut old = [0; 4];
            names.iter().enumerate().for_each(|(state, name)| old[*name] = state);
            let rows = old.iter().flat_map(|s| [(*s, 0), (*s, 1)]);
            let rows = rows.map(|(s, k)| (names[a.successor(s, k) as usize] as u32, a.reward(s, k)));
            let (to, rewards) = rows.unzip();
            let renamed = Mdp::new(4, 2, to, rewards).unwrap();
            for (s, name) in names.into_iter().enumerate() {
                let d = |a: &Mdp, s: usize| bisimulation(a, &b, (s, 0), 0.7, 100).unwrap().upper;
                prop_assert!((d(&renamed, name) - d(&a, s)).abs() < 1e-12);
                prop_assert!(bisimulation(&a, &renamed, (s, name), 0.7, 100).unwrap().upper < 1e-12);
            }
        }

        #[test]
        fn optimal_values_differ_by_at_most_the_distance(a in process(3, 2), b in process(4, 2), discount in 0.0..0.8) {
            let values = |of: &Mdp| {
                let mut values = vec![0.0_f64; of.states()];
                for _ in 0..200 {
                    let earned =
                        |s: usize, k: usize| -> f64 { of.reward(s, k) + discount * values[of.successor(s, k) as usize] };
                    values = (0..of.states()).map(|s| earned(s, 0).max(earned(s, 1))).collect();
                }
                values
            };
            for (s, v) in values(&a).into_iter().enumerate() {
                for (t, w) in values(&b).into_iter().enumerate() {
                    let upper = bisimulation(&a, &b, (s, t), 0.8, 100).unwrap().upper;
                    prop_assert!(0.2 * (v - w).abs() <= upper + 1e-9);
                }
            }
        }

        #[test]
        fn bounds_hold_for_few_pairs_and_tighten_with_more(a in process(9, 2), b in process(9, 2)) {
            let expected = by_definition(&a, &b, 0.7)[0];
            let mut before = f64::INFINITY;
            for max_pairs in [1, 3, 9, 27, 81] {
                let found = bisimulation(&a, &b, (0, 0), 0.7, max_pairs).unwrap();
                prop_assert!(found.lower <= expected + 1e-10 && expected <= found.upper + 1e-10);
                prop_assert!(found.upper - found.lower <= before + 1e-10);
                prop_assert!(found.pairs <= max_pairs);
                before = found.upper - found.lower;
            }
            prop_assert!(before < 1e-10, "all 81 pairs are visited");
        }
    }
}
