//! [`Epic`]: the distance of two tables of rewards that shaping, shifting and scaling leave alone. Rewards that are only sampled
//! are compared in `samples.rs`.

use super::pearson_distance::{Direction, largest};
use super::table::RewardTable;
use crate::SimilarityError;
use crate::shares::{equal_shares, shares, sum};

/// How far off a shaped reward may be, as a multiple of 2⁻⁵² of the largest reward: half for the rewards themselves, some 2 for each
/// of three means, half the size of every partial sum; doubled.
pub(super) const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// The equivalent-policy invariant comparison of rewards (EPIC): how far apart two rewards are in what they ask for, under any dynamics.
///
/// Both rewards are brought into a canonical shape, `C(s, a, s') = R(s, a, s') + E[γ R(s', A, S') − R(s, A, S') − γ R(S, A, S')]`
/// with `S`, `S'` and `A` drawn alike for all; then [`pearson_distance`](crate::pearson_distance) is taken over the
/// transitions of a coverage. 0 to 1; a pseudometric: 0 between rewards that differ by potential shaping (of the same
/// discount), by a factor above 0 and by a shift, and 1 between a reward and its reverse.
///
/// A reward that is the same for all transitions, but for shaping, asks for nothing. It is 0 from its like and ½ from any
/// other. The reference divides 0 by 0 there; its direct distance, scaled likewise, gives ½ as well.
///
/// Within some 1e-14 times (largest reward / standard deviation of the canonical one). What rounding alone can make is
/// given as exactly 0: up to 32 · 2⁻⁵² times that ratio, both rewards' added up; for rewards of an ordinary kind 1e-13 or
/// less. A real difference smaller than that is taken for none.
///
/// Source: Gleave, Dennis, Legg, Russell and Leike 2021, "Quantifying differences in reward functions"; the same numbers as
/// its tabular code (`evaluating_rewards/distances/tabular.py`), see `tests/oracle/reward.json`.
///
/// # Example
/// ```
/// use driftworld_similarity::{Epic, RewardTable};
/// let goal = RewardTable::from_fn(3, 1, |_, _, next| f64::from(next == 2))?;
/// let soft = goal.shaped(&[0.0, 5.0, 10.0], 0.9)?;
/// let other = RewardTable::from_fn(3, 1, |_, _, next| f64::from(next == 0))?;
/// let epic = Epic::new(0.9)?;
/// assert_eq!(epic.distance(&goal, &soft)?, 0.0);
/// assert!(epic.distance(&goal, &other)? > 0.8);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Epic {
    discount: f64,
    of_states: Option<Vec<f64>>,
    of_actions: Option<Vec<f64>>,
    coverage: Option<Vec<f64>>,
}

impl Epic {
    /// With states and actions drawn evenly, over all transitions. `discount`: γ, 0 to 1, that of the shaping to see through.
    ///
    /// # Errors
    /// [`SimilarityError::BadNumber`] for a discount that is not from 0 to 1.
    pub fn new(discount: f64) -> Result<Self, SimilarityError> {
        check_discount(discount)?;
        Ok(Self {
            discount,
            of_states: None,
            of_actions: None,
            coverage: None,
        })
    }

    /// With states drawn by these weights: one for each state, at least 0, in any proportion.
    #[must_use]
    pub fn with_states(self, weights: Vec<f64>) -> Self {
        Self {
            of_states: Some(weights),
            ..self
        }
    }

    /// With actions drawn by these weights: one for each action, at least 0, in any proportion.
    #[must_use]
    pub fn with_actions(self, weights: Vec<f64>) -> Self {
        Self {
            of_actions: Some(weights),
            ..self
        }
    }

    /// Compared over transitions of these weights: `(states, actions, states)` as in a [`RewardTable`], at least 0, in any
    /// proportion; what weighs 0 has no say but in the canonical shape. If none are given: state, action and next state
    /// drawn apart from each other.
    #[must_use]
    pub fn with_coverage(self, weights: Vec<f64>) -> Self {
        Self {
            coverage: Some(weights),
            ..self
        }
    }

    /// The reward in its canonical shape: the same for all that potential shaping and a shift make of it, but for rounding.
    ///
    /// # Errors
    /// [`SimilarityError::Shape`], [`SimilarityError::BadMass`] and [`SimilarityError::BadNumber`] for weights that do not
    /// fit, [`SimilarityError::BadReward`] where a shaped reward leaves ±1e100.
    pub fn canonical(&self, reward: &RewardTable) -> Result<RewardTable, SimilarityError> {
        let (of_states, _) = self.draws(reward)?;
        let pairs = self.pairs(reward)?;
        let rows = reward.values().chunks_exact(pairs.len());
        let from_state: Vec<f64> = rows
            .map(|row| sum(row.iter().zip(&pairs).map(|(a, b)| a * b)))
            .collect();
        let overall = sum(from_state.iter().zip(&of_states).map(|(mean, share)| mean * share));
        RewardTable::from_fn(reward.states(), reward.actions(), |state, action, next| {
            let means = Means {
                before: from_state[state],
                after: from_state[next],
                overall,
            };
            means.canonical(reward.reward(state, action, next), self.discount)
        })
    }

    /// How far apart two rewards are, 0 to 1. Time and memory `O(states² · actions)`.
    ///
    /// # Errors
    /// [`SimilarityError::SizesDiffer`] for tables of different sizes, else as [`Epic::canonical`].
    pub fn distance(&self, a: &RewardTable, b: &RewardTable) -> Result<f64, SimilarityError> {
        for (what, of_a, of_b) in [
            ("states", a.states(), b.states()),
            ("actions", a.actions(), b.actions()),
        ] {
            if of_a != of_b {
                return Err(SimilarityError::SizesDiffer {
                    of: "rewards",
                    what,
                    a: of_a,
                    b: of_b,
                });
            }
        }
        let weights = self.weights(a)?;
        let counted = self.counted(a, &weights)?;
        let direction = |reward: &RewardTable| -> Result<Direction, SimilarityError> {
            let rounding = ROUNDING * largest(reward.values(), counted.iter().copied());
            Ok(Direction::of(self.canonical(reward)?.values(), &weights, rounding))
        };
        Ok(direction(a)?.distance(&direction(b)?, &weights))
    }

    /// How often each state and each action is drawn.
    fn draws(&self, reward: &RewardTable) -> Result<(Vec<f64>, Vec<f64>), SimilarityError> {
        let shares_of = |of, weights: &Option<Vec<f64>>, count| match weights {
            Some(weights) => shares(of, weights, count),
            None => Ok(equal_shares(count)),
        };
        Ok((
            shares_of("weights of states", &self.of_states, reward.states())?,
            shares_of("weights of actions", &self.of_actions, reward.actions())?,
        ))
    }

    /// How often each action and next state are drawn together.
    fn pairs(&self, reward: &RewardTable) -> Result<Vec<f64>, SimilarityError> {
        let (of_states, of_actions) = self.draws(reward)?;
        let of_action = |action: &f64| {
            let action = *action;
            of_states.iter().map(move |next| action * next)
        };
        Ok(of_actions.iter().flat_map(of_action).collect())
    }

    /// Above 0 for transitions that are compared, or that a mean is taken over which counts; no other has a say, however large.
    fn counted(&self, reward: &RewardTable, weights: &[f64]) -> Result<Vec<f64>, SimilarityError> {
        let (mut from, _) = self.draws(reward)?;
        let pairs = self.pairs(reward)?;
        for (row, weights) in weights.chunks_exact(pairs.len()).enumerate() {
            for (index, weight) in weights.iter().enumerate() {
                from[row] += weight;
                from[index % reward.states()] += weight;
            }
        }
        let rows = weights.chunks_exact(pairs.len()).zip(&from);
        let of_row = |(weights, from): (&[f64], &f64)| {
            let drawn = weights.iter().zip(&pairs).map(|(weight, pair)| weight + from * pair);
            drawn.collect::<Vec<f64>>()
        };
        Ok(rows.flat_map(of_row).collect())
    }

    /// What each transition weighs.
    fn weights(&self, reward: &RewardTable) -> Result<Vec<f64>, SimilarityError> {
        if let Some(weights) = &self.coverage {
            return shares("weights of transitions", weights, reward.values().len());
        }
        let (of_states, _) = self.draws(reward)?;
        let pairs = self.pairs(reward)?;
        let of_state = |state: &f64| {
            let state = *state;
            pairs.iter().map(move |pair| state * pair)
        };
        let weights: Vec<f64> = of_states.iter().flat_map(of_state).collect();
        shares("weights of transitions", &weights, weights.len())
    }
}

/// Mean rewards of going on at random.
#[derive(Clone, Copy, Debug)]
pub(super) struct Means {
    /// From the state that a transition leaves.
    pub(super) before: f64,
    /// From the state that it enters.
    pub(super) after: f64,
    /// From a state that is drawn, too.
    pub(super) overall: f64,
}

impl Means {
    /// The canonical shape of a transition's reward.
    pub(super) fn canonical(self, reward: f64, discount: f64) -> f64 {
        reward + discount * (self.after - self.overall) - self.before
    }
}

/// Refuses a discount that is not from 0 to 1.
pub(super) fn check_discount(discount: f64) -> Result<(), SimilarityError> {
    if (0.0..=1.0).contains(&discount) {
        return Ok(());
    }
    Err(SimilarityError::BadNumber {
        of: "discount",
        found: discount,
        expected: "a number from 0 to 1",
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn table() -> impl Strategy<Value = RewardTable> {
        prop::collection::vec((-40_i32..40).prop_map(|k| f64::from(k) / 8.0), 18)
            .prop_map(|values| RewardTable::new(3, 2, values).unwrap())
    }

    /// States, actions and transitions drawn unevenly.
    fn uneven(discount: f64) -> Epic {
        let coverage = (0..18).map(|k| f64::from(k * 7 % 5)).collect();
        Epic::new(discount)
            .unwrap()
            .with_states(vec![1.0, 4.0, 2.0])
            .with_actions(vec![3.0, 1.0])
            .with_coverage(coverage)
    }

    #[test]
    fn a_reward_that_asks_for_nothing_lies_in_the_middle() {
        let epic = Epic::new(0.9).unwrap();
        let nothing = RewardTable::from_fn(3, 1, |_, _, _| 0.3).unwrap();
        let shaped = nothing.shaped(&[1.0, -7.3, 0.2], 0.9).unwrap();
        let goal = RewardTable::from_fn(3, 1, |_, _, next| f64::from(next == 1)).unwrap();
        assert_eq!(epic.distance(&nothing, &shaped).unwrap(), 0.0);
        assert_eq!(epic.distance(&goal, &shaped).unwrap(), 0.5);
    }

    #[test]
    fn shaping_of_another_discount_is_seen() {
        let goal = RewardTable::from_fn(3, 1, |_, _, next| f64::from(next == 1)).unwrap();
        let shaped = goal.shaped(&[5.0, 1.0, 0.0], 0.9).unwrap();
        assert!(Epic::new(0.5).unwrap().distance(&goal, &shaped).unwrap() > 0.1);
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let [one, two] = [1, 2].map(|states| RewardTable::from_fn(states, 1, |_, _, _| 0.0).unwrap());
        let epic = Epic::new(0.9).unwrap();
        let code = |epic: &Epic| epic.distance(&two, &two).unwrap_err().code();
        assert_eq!(epic.distance(&one, &two).unwrap_err().code(), "similarity/sizes-differ");
        assert_eq!(code(&epic.clone().with_states(vec![1.0])), "similarity/shape");
        assert_eq!(code(&epic.clone().with_actions(vec![-1.0])), "similarity/bad-mass");
        assert_eq!(code(&epic.with_coverage(vec![0.0; 4])), "similarity/bad-number");
        assert_eq!(Epic::new(1.1).unwrap_err().code(), "similarity/bad-number");
    }

    #[test]
    fn a_huge_reward_that_is_neither_compared_nor_drawn_has_no_say() {
        let table = |goal: usize| {
            RewardTable::from_fn(3, 1, |s, _, t| if s.max(t) == 2 { -1e90 } else { f64::from(t == goal) }).unwrap()
        };
        let coverage = (0..9).map(|k| f64::from(k / 3 < 2 && k % 3 < 2)).collect();
        let epic = Epic::new(0.9)
            .unwrap()
            .with_states(vec![1.0, 1.0, 0.0])
            .with_coverage(coverage);
        assert_eq!(epic.distance(&table(0), &table(1)), Ok(1.0));
        assert_eq!(epic.distance(&table(0), &table(0)), Ok(0.0));
    }

    proptest! {
        #[test]
        fn it_is_a_pseudometric(a in table(), b in table(), c in table(), discount in 0.0..=1.0) {
            let epic = uneven(discount);
            let apart = |a: &RewardTable, b: &RewardTable| epic.distance(a, b).unwrap();
            prop_assert_eq!(apart(&a, &a), 0.0);
            prop_assert_eq!(apart(&a, &b), apart(&b, &a));
            prop_assert!((0.0..=1.0).contains(&apart(&a, &b)));
            prop_assert!(apart(&a, &c) <= apart(&a, &b) + apart(&b, &c) + 1e-12);
        }

        #[test]
        fn what_asks_for_the_same_is_exactly_0_apart(
            a in table(),
            b in table(),
            potential in prop::collection::vec(-50.0..50.0, 3),
            by in -50.0..50.0,
            times in 0.01..100.0,
            discount in 0.0..=1.0,
        ) {
            let epic = uneven(discount);
            let shaped = a.shaped(&potential, discount).unwrap();
            let like = RewardTable::from_fn(3, 2, |s, k, t| shaped.reward(s, k, t) * times + by).unwrap();
            prop_assert_eq!(epic.distance(&a, &like).unwrap(), 0.0);
            let reversed = RewardTable::from_fn(3, 2, |s, k, t| -like.reward(s, k, t)).unwrap();
            let far = epic.distance(&a, &reversed).unwrap();
            prop_assert!(far == 0.0 || (far - 1.0).abs() < 1e-9, "{far}");
            prop_assert!((epic.distance(&a, &b).unwrap() - epic.distance(&like, &b).unwrap()).abs() < 1e-9);
        }
    }
}
