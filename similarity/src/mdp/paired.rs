//! [`paired_bisimulation`]: the bisimulation metric between states of two large deterministic processes, over those pairs only that
//! are reached together. The whole table is in `bisimulation.rs`.

use std::collections::HashMap;

use super::certain_sums::CertainSums;
use super::process::Mdp;
use super::{check_discount, check_equal};
use crate::SimilarityError;
use crate::shares::{shares, sum};

/// Most pairs that [`paired_bisimulation`] looks at: with 6 actions some 3 GiB.
pub const MAX_PAIRS: usize = 1 << 24;

/// How far pairs of states of two deterministic processes are apart: a lower and an upper bound, equal but for rounding where all
/// pairs that are reached were looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct PairedBisimulation {
    lower: Vec<f64>,
    upper: Vec<f64>,
    pairs: usize,
    complete: bool,
}

impl PairedBisimulation {
    /// For each start a number that the distance is not below, in the unit of the rewards.
    pub fn lower(&self) -> &[f64] {
        &self.lower
    }

    /// For each start a number that the distance is not above, in the unit of the rewards.
    pub fn upper(&self) -> &[f64] {
        &self.upper
    }

    /// How many pairs were looked at.
    pub fn pairs(&self) -> usize {
        self.pairs
    }

    /// Whether all pairs were looked at that the starts lead to.
    pub fn is_complete(&self) -> bool {
        self.complete
    }

    /// The weighted mean of the lower and of the upper bounds, in the unit of the rewards. `weights`: one for each start, at
    /// least 0, in any proportion: how likely an episode begins there.
    ///
    /// # Errors
    /// [`SimilarityError::Shape`], [`SimilarityError::BadMass`] and [`SimilarityError::BadNumber`] for weights that are none.
    pub fn means(&self, weights: &[f64]) -> Result<(f64, f64), SimilarityError> {
        let shares = shares("weights of starts", weights, self.lower.len())?;
        let mean = |bounds: &[f64]| sum(bounds.iter().zip(&shares).map(|(bound, share)| bound * share));
        Ok((mean(&self.lower), mean(&self.upper)))
    }
}

/// The bisimulation metric between pairs of states of two deterministic decision processes with the same actions.
///
/// With one successor each, `d(s, t) = maxₐ (1 − c) |R(s, a) − R(t, a)| + c d(s', t')` with `s'` and `t'` where action `a` leads from
/// both: the Wasserstein-1 distance of two certain successors is their distance. So `d(s, t)` hangs on those pairs only that
/// the same actions lead to from `(s, t)`, and this is [`bisimulation`](crate::bisimulation) itself, not a bound of it, in
/// the unit of the rewards. Between worlds that move alike the pairs are those of a state with itself, as many as states.
///
/// `starts`: pairs of a state of the first and one of the second process, each with its bounds in the result. `discount`: `c`, 0 to
/// 0.9999. `max_pairs`: how many pairs to look at, starts included, at most [`MAX_PAIRS`]; nearest first. Pairs that are not
/// looked at count as 0 in the lower bound and as the largest difference of two rewards in the upper: the gap is at most
/// that difference times `c` to the power of the steps that all were followed.
///
/// Exact within rounding (some 1e-15 of the largest difference over `1 − c`): by policy iteration, for any discount.
/// Memory `O(pairs · actions)`, and as much time for each round of it.
///
/// Source: as [`bisimulation`](crate::bisimulation); for deterministic processes also Castro 2020, "Scalable methods for
/// computing state similarity in deterministic Markov decision processes".
///
/// # Errors
/// [`SimilarityError::SizesDiffer`] for different numbers of actions, [`SimilarityError::NotDeterministic`],
/// [`SimilarityError::NoSuchState`] for a start that is none, [`SimilarityError::TooMany`] for more starts than `max_pairs`, or
/// that above [`MAX_PAIRS`], [`SimilarityError::BadNumber`] for a discount that is none.
///
/// # Example
/// ```
/// use driftworld_similarity::{Mdp, paired_bisimulation};
/// // A corridor of four cells, to be walked left or right; the reward is at the right end, or nowhere.
/// let moves = [0, 1, 0, 2, 1, 3, 2, 3];
/// let goal = Mdp::deterministic(4, 2, &moves, vec![0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0])?;
/// let none = Mdp::deterministic(4, 2, &moves, vec![0.0; 8])?;
/// let found = paired_bisimulation(&goal, &none, &[(0, 0)], 0.9, 100)?;
/// // Two steps until the difference is met, and then for ever.
/// assert!((found.lower()[0] - 0.81).abs() < 1e-12);
/// assert_eq!(found.pairs(), 4);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn paired_bisimulation(
    a: &Mdp,
    b: &Mdp,
    starts: &[(usize, usize)],
    discount: f64,
    max_pairs: usize,
) -> Result<PairedBisimulation, SimilarityError> {
    check_discount(discount)?;
    check(a, b, starts, max_pairs)?;
    let reached = Reached::from(a, b, starts, 1.0 - discount, max_pairs);
    let sums = CertainSums {
        steps: a.actions(),
        next: &reached.next,
        costs: &reached.costs,
        discount,
    };
    let (values, error) = sums.solve();
    let lower = reached.at_starts(&values);
    let upper = if reached.is_complete() {
        lower.iter().map(|value| value + error).collect()
    } else {
        let most = (1.0 - discount) * largest_difference(a, b);
        let costs = reached.with_beyond(most, a.actions());
        let (values, error) = CertainSums { costs: &costs, ..sums }.solve();
        reached.at_starts(&values).iter().map(|value| value + error).collect()
    };
    Ok(PairedBisimulation {
        lower: lower.iter().map(|value| (value - error).max(0.0)).collect(),
        upper,
        pairs: reached.pairs,
        complete: reached.is_complete(),
    })
}

fn check(a: &Mdp, b: &Mdp, starts: &[(usize, usize)], max_pairs: usize) -> Result<(), SimilarityError> {
    check_equal("actions", a.actions(), b.actions())?;
    for (side, process) in [("first", a), ("second", b)] {
        if let Some((state, action)) = process.first_uncertain() {
            return Err(SimilarityError::NotDeterministic {
                side,
                state,
                action,
                found: process.row(state, action).len(),
            });
        }
    }
    for &(of_a, of_b) in starts {
        for (side, found, states) in [("first", of_a, a.states()), ("second", of_b, b.states())] {
            if found >= states {
                return Err(SimilarityError::NoSuchState {
                    side,
                    found,
                    most: states - 1,
                });
            }
        }
    }
    for (found, limit) in [(max_pairs, MAX_PAIRS), (starts.len(), max_pairs)] {
        if found > limit {
            return Err(SimilarityError::TooMany { found, limit });
        }
    }
    Ok(())
}

/// No reward of one process differs from one of the other by more.
fn largest_difference(a: &Mdp, b: &Mdp) -> f64 {
    let ((low_a, high_a), (low_b, high_b)) = (a.reward_range(), b.reward_range());
    (high_a - low_b).max(high_b - low_a).max(0.0)
}

/// The pairs that starts lead to, nearest first, and behind them one place for all that were not looked at.
#[derive(Debug)]
struct Reached {
    /// The place of each start among the pairs.
    starts: Vec<usize>,
    pairs: usize,
    /// `(pairs + 1, actions)`: where each action leads both.
    next: Vec<u32>,
    /// `(pairs + 1, actions)`: how much what it pays differs, times the share of the present.
    costs: Vec<f64>,
}

impl Reached {
    fn from(a: &Mdp, b: &Mdp, starts: &[(usize, usize)], present: f64, max_pairs: usize) -> Self {
        const BEYOND: u32 = u32::MAX;
        let mut places: HashMap<(u32, u32), u32> = HashMap::new();
        let mut pairs: Vec<(u32, u32)> = Vec::new();
        let mut place_of = |pair: (u32, u32), pairs: &mut Vec<(u32, u32)>| {
            if let Some(&place) = places.get(&pair) {
                return place;
            }
            if pairs.len() == max_pairs {
                return BEYOND;
            }
            let place = pairs.len() as u32;
            places.insert(pair, place);
            pairs.push(pair);
            place
        };
        let starts = starts
            .iter()
            .map(|&(of_a, of_b)| place_of((of_a as u32, of_b as u32), &mut pairs) as usize);
        let starts = starts.collect();
        let (mut next, mut costs) = (Vec::new(), Vec::new());
        let mut looked_at = 0;
        while let Some(&(of_a, of_b)) = pairs.get(looked_at) {
            for action in 0..a.actions() {
                let (from, to) = (a.row(of_a as usize, action), b.row(of_b as usize, action));
                next.push(place_of((from.only(), to.only()), &mut pairs));
                let paid = a.reward(of_a as usize, action) - b.reward(of_b as usize, action);
                costs.push(present * paid.abs());
            }
            looked_at += 1;
        }
        let beyond = pairs.len() as u32;
        for place in next.iter_mut().filter(|place| **place == BEYOND) {
            *place = beyond;
        }
        next.extend(std::iter::repeat_n(beyond, a.actions()));
        costs.extend(std::iter::repeat_n(0.0, a.actions()));
        Self {
            starts,
            pairs: pairs.len(),
            next,
            costs,
        }
    }

    /// Whether no action leads beyond the pairs.
    fn is_complete(&self) -> bool {
        let steps = self.next.len() / (self.pairs + 1);
        !self.next[..self.pairs * steps].contains(&(self.pairs as u32))
    }

    fn at_starts(&self, values: &[f64]) -> Vec<f64> {
        self.starts.iter().map(|start| values[*start]).collect()
    }

    /// The costs, where each step beyond the pairs has this one.
    fn with_beyond(&self, cost: f64, actions: usize) -> Vec<f64> {
        let mut costs = self.costs.clone();
        let last = costs.len() - actions;
        costs[last..].fill(cost);
        costs
    }
}

#[cfg(test)]
mod tests {
    use super::super::drawn::certain;
    use super::*;
    use crate::bisimulation;
    use proptest::prelude::*;

    fn every(a: &Mdp, b: &Mdp) -> Vec<(usize, usize)> {
        (0..a.states())
            .flat_map(|s| (0..b.states()).map(move |t| (s, t)))
            .collect()
    }

    #[test]
    fn what_cannot_be_followed_is_refused() {
        let one = Mdp::deterministic(1, 1, &[0], vec![0.0]).unwrap();
        let two = Mdp::deterministic(1, 2, &[0; 2], vec![0.0; 2]).unwrap();
        let unsure = [vec![(0, 0.5), (1, 0.5)], vec![(1, 1.0)]];
        let unsure = Mdp::new(2, 1, &unsure, vec![0.0; 2]).unwrap();
        let code = |b: &Mdp, starts: &[(usize, usize)], most| {
            paired_bisimulation(&one, b, starts, 0.5, most).unwrap_err().code()
        };
        assert_eq!(code(&two, &[(0, 0)], 9), "similarity/sizes-differ");
        assert_eq!(code(&unsure, &[(0, 0)], 9), "similarity/not-deterministic");
        assert_eq!(code(&one, &[(0, 1)], 9), "similarity/no-such-state");
        assert_eq!(code(&one, &[(0, 0), (0, 0)], 1), "similarity/too-many");
        assert_eq!(code(&one, &[(0, 0)], usize::MAX), "similarity/too-many");
        let error = paired_bisimulation(&one, &one, &[], 1.0, 9).unwrap_err();
        assert_eq!(error.code(), "similarity/bad-number");
    }

    #[test]
    fn no_starts_have_no_distances() {
        let one = Mdp::deterministic(1, 1, &[0], vec![0.0]).unwrap();
        let found = paired_bisimulation(&one, &one, &[], 0.5, 9).unwrap();
        assert_eq!((found.pairs(), found.lower().len(), found.is_complete()), (0, 0, true));
    }

    proptest! {
        #[test]
        fn it_is_the_bisimulation_metric(a in certain(6, 2), b in certain(5, 2), discount in 0.0..0.9) {
            let full = bisimulation(&a, &b, discount, 1e-11).unwrap();
            let found = paired_bisimulation(&a, &b, &every(&a, &b), discount, 1000).unwrap();
            prop_assert!(found.is_complete());
            for (expected, (lower, upper)) in full.values().iter().zip(found.lower().iter().zip(found.upper())) {
                prop_assert!((expected - lower).abs() < 1e-10 && (expected - upper).abs() < 1e-10);
            }
        }

        #[test]
        fn from_one_pair_it_is_what_it_is_among_all(a in certain(6, 3), b in certain(6, 3), s in 0_usize..6, t in 0_usize..6) {
            let full = bisimulation(&a, &b, 0.7, 1e-11).unwrap();
            let found = paired_bisimulation(&a, &b, &[(s, t)], 0.7, 1000).unwrap();
            prop_assert!((full.between(s, t) - found.lower()[0]).abs() < 1e-10);
            prop_assert!(found.pairs() <= 36);
        }

        #[test]
        fn few_pairs_bound_it_and_more_bound_it_closer(a in certain(9, 2), b in certain(9, 2)) {
            let full = bisimulation(&a, &b, 0.7, 1e-11).unwrap();
            let mut before = f64::INFINITY;
            for most in [1, 3, 9, 27, 81] {
                let found = paired_bisimulation(&a, &b, &[(0, 0)], 0.7, most).unwrap();
                let (lower, upper) = (found.lower()[0], found.upper()[0]);
                prop_assert!(lower <= full.between(0, 0) + 1e-10 && full.between(0, 0) <= upper + 1e-10);
                prop_assert!(upper - lower <= before + 1e-10);
                prop_assert!(found.pairs() <= most);
                before = upper - lower;
            }
            prop_assert!(before < 1e-10, "81 pairs are all that there are");
        }

        #[test]
        fn means_lie_between_their_bounds(a in certain(4, 2), b in certain(4, 2)) {
            let found = paired_bisimulation(&a, &b, &[(0, 0), (1, 1)], 0.7, 100).unwrap();
            let (lower, upper) = found.means(&[3.0, 1.0]).unwrap();
            let expected = (3.0 * found.lower()[0] + found.lower()[1]) / 4.0;
            prop_assert!((lower - expected).abs() < 1e-14 && lower <= upper);
        }
    }
}
