//! [`RewardSamples`]: EPIC over drawn transitions, for rewards that no table can hold. Drawing them is up to whoever knows the world.

use std::cell::Cell;
use std::iter::repeat;

use super::epic::{Means, ROUNDING, check_discount};
use super::pearson_distance::{Direction, check, largest};
use super::table::is_reward;
use crate::SimilarityError;
use crate::shares::{equal_shares, sum};

/// What rewards are compared on: transitions, and pairs of an action and a state that their mean is taken over.
///
/// `S` and `A` are whatever a reward is a function of: an index, a pose, a whole world. Both rewards have to be measured on
/// the same samples.
#[derive(Clone, Debug)]
pub struct RewardSamples<S, A> {
    transitions: Vec<(S, A, S)>,
    draws: Vec<(A, S)>,
}

impl<S, A> RewardSamples<S, A> {
    /// `transitions`: state, action, next state, from the coverage that rewards are to be compared over; possible ones, if
    /// others never pay. `draws`: actions and next states by which the canonical shape is estimated, each drawn apart from
    /// the other; their states also stand for the state drawn.
    ///
    /// # Errors
    /// [`SimilarityError::NoSamples`] where one of them is empty.
    pub fn new(transitions: Vec<(S, A, S)>, draws: Vec<(A, S)>) -> Result<Self, SimilarityError> {
        if transitions.is_empty() || draws.is_empty() {
            return Err(SimilarityError::NoSamples);
        }
        Ok(Self { transitions, draws })
    }

    /// The transitions.
    pub fn transitions(&self) -> &[(S, A, S)] {
        &self.transitions
    }

    /// The pairs that means are taken over.
    pub fn draws(&self) -> &[(A, S)] {
        &self.draws
    }

    /// What a reward gives on these samples. It is asked `transitions · (1 + 2 · draws) + draws²` times.
    ///
    /// # Errors
    /// [`SimilarityError::BadReward`] for one that is not within ±1e100.
    pub fn measure(&self, reward: impl Fn(&S, &A, &S) -> f64) -> Result<SampledReward, SimilarityError> {
        // Means of large rewards that cancel out are rounded as large ones are.
        let most = Cell::new(0.0_f64);
        let reward = |state: &S, action: &A, next: &S| {
            let paid = reward(state, action, next);
            most.set(most.get().max(paid.abs()));
            paid
        };
        let draws = self.draws.len() as f64;
        let mean_from = |state: &S| sum(self.draws.iter().map(|(action, next)| reward(state, action, next))) / draws;
        let paid = self
            .transitions
            .iter()
            .map(|(state, action, next)| reward(state, action, next));
        let before = self.transitions.iter().map(|(state, ..)| mean_from(state));
        let after = self.transitions.iter().map(|(.., next)| mean_from(next));
        let overall = sum(self.draws.iter().map(|(_, state)| mean_from(state))) / draws;
        let found = SampledReward::new(paid.collect(), before.collect(), after.collect(), overall)?;
        Ok(SampledReward {
            largest: found.largest.max(most.get()),
            ..found
        })
    }
}

/// A reward on some [`RewardSamples`], or from means that were worked out elsewhere.
///
/// # Example
/// ```
/// use driftworld_similarity::RewardSamples;
/// // States are places on a line, and there is nothing to choose.
/// let places = [0.0, 1.0, 2.0, 3.0];
/// let transitions = places.iter().flat_map(|&from| places.map(|to| (from, (), to))).collect();
/// let samples = RewardSamples::new(transitions, places.map(|place| ((), place)).to_vec())?;
/// let goal = samples.measure(|_, (), to| f64::from(*to == 3.0))?;
/// let soft = samples.measure(|from, (), to| 2.0 * f64::from(*to == 3.0) + 0.9 * to - from)?;
/// assert_eq!(goal.distance(&soft, 0.9)?, 0.0);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SampledReward {
    rewards: Vec<f64>,
    before: Vec<f64>,
    after: Vec<f64>,
    overall: f64,
    /// The largest size of a reward, and of a mean.
    largest: f64,
}

impl SampledReward {
    /// From numbers: `rewards`, what each transition pays; `before` and `after`, the mean reward of going on at random from
    /// the state that it leaves and from the one that it enters; `overall`, the mean of that over drawn states. All in one unit.
    ///
    /// # Errors
    /// [`SimilarityError::Shape`] for lists that are not of one length, [`SimilarityError::NoSamples`] for empty ones,
    /// [`SimilarityError::BadReward`] for a number that is not within ±1e100.
    pub fn new(rewards: Vec<f64>, before: Vec<f64>, after: Vec<f64>, overall: f64) -> Result<Self, SimilarityError> {
        if rewards.is_empty() {
            return Err(SimilarityError::NoSamples);
        }
        for (of, list) in [("mean rewards before", &before), ("mean rewards after", &after)] {
            if list.len() != rewards.len() {
                return Err(SimilarityError::Shape {
                    of,
                    found: list.len(),
                    expected: rewards.len(),
                });
            }
        }
        for list in [&rewards, &before, &after] {
            check(list)?;
        }
        if !is_reward(overall) {
            return Err(SimilarityError::BadReward {
                place: "the mean over drawn states".into(),
                found: overall,
            });
        }
        let lists = [&rewards, &before, &after];
        Ok(Self {
            largest: lists
                .iter()
                .fold(0.0, |most: f64, list| most.max(largest(list, repeat(1.0)))),
            rewards,
            before,
            after,
            overall,
        })
    }

    /// The reward of each transition in its canonical shape, by the means of the samples; see [`Epic`](crate::Epic).
    pub fn canonical(&self, discount: f64) -> Vec<f64> {
        let means = self.before.iter().zip(&self.after);
        let shaped = self.rewards.iter().zip(means).map(|(reward, (&before, &after))| {
            let overall = self.overall;
            Means { before, after, overall }.canonical(*reward, discount)
        });
        shaped.collect()
    }

    /// EPIC by samples: [`Epic::distance`](crate::Epic::distance) with means over the draws for the expectations, and the
    /// transitions for the coverage. 0 to 1; both measured on the same samples.
    ///
    /// Whatever the samples: a pseudometric, and exactly 0 under potential shaping of that discount, a factor above 0 and a
    /// shift. It differs from the distance of the distributions that were drawn from by something like `1 / √samples`. A
    /// difference where no sample lies is not seen.
    ///
    /// # Errors
    /// [`SimilarityError::SizesDiffer`] for rewards of different samples, [`SimilarityError::BadNumber`] for a discount that is
    /// not from 0 to 1.
    ///
    /// Source: Gleave et al. 2021, appendix A.1; `sample_canon_shaping` of `evaluating_rewards/distances/epic_sample.py`.
    pub fn distance(&self, other: &Self, discount: f64) -> Result<f64, SimilarityError> {
        check_discount(discount)?;
        let (a, b) = (self.rewards.len(), other.rewards.len());
        if a != b {
            return Err(SimilarityError::SizesDiffer {
                of: "rewards",
                what: "transitions",
                a,
                b,
            });
        }
        let weights = equal_shares(a);
        let direction = |reward: &Self| Direction::of(&reward.canonical(discount), &weights, ROUNDING * reward.largest);
        Ok(direction(self).distance(&direction(other), &weights))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::split_mix::SplitMix64;
    use crate::{Epic, RewardTable};
    use proptest::prelude::*;

    const STATES: u64 = 5;
    const ACTIONS: u64 = 3;

    fn table(rng: &mut SplitMix64) -> RewardTable {
        let values = (0..STATES * ACTIONS * STATES).map(|_| rng.unit() - 0.5).collect();
        RewardTable::new(STATES as usize, ACTIONS as usize, values).unwrap()
    }

    /// As many transitions as draws, evenly drawn.
    fn samples(rng: &mut SplitMix64, count: usize) -> RewardSamples<usize, usize> {
        let mut state = || rng.below(STATES) as usize;
        let states: Vec<[usize; 3]> = (0..count).map(|_| [state(), state(), state()]).collect();
        let mut action = || rng.below(ACTIONS) as usize;
        let draws = states.iter().map(|[.., drawn]| (action(), *drawn)).collect();
        let transitions = states.iter().map(|&[from, to, _]| (from, action(), to)).collect();
        RewardSamples::new(transitions, draws).unwrap()
    }

    fn sampled(samples: &RewardSamples<usize, usize>, a: &RewardTable, b: &RewardTable) -> f64 {
        let measure = |table: &RewardTable| samples.measure(|&s, &k, &t| table.reward(s, k, t)).unwrap();
        measure(a).distance(&measure(b), 0.9).unwrap()
    }

    #[test]
    fn samples_of_every_transition_give_the_distance_of_the_tables() {
        let mut rng = SplitMix64(1);
        let (states, actions) = (0..STATES as usize, 0..ACTIONS as usize);
        let draws: Vec<(usize, usize)> = actions.flat_map(|k| states.clone().map(move |t| (k, t))).collect();
        let from = |s: usize| draws.iter().map(move |&(k, t)| (s, k, t));
        let transitions = states.flat_map(from).collect();
        let every = RewardSamples::new(transitions, draws.clone()).unwrap();
        for _ in 0..20 {
            let (a, b) = (table(&mut rng), table(&mut rng));
            let expected = Epic::new(0.9).unwrap().distance(&a, &b).unwrap();
            let found = sampled(&every, &a, &b);
            assert!((found - expected).abs() < 1e-14, "{found}, tables {expected}");
        }
    }

    #[test]
    fn the_error_falls_with_the_root_of_the_number_of_samples() {
        let mut rng = SplitMix64(2);
        let tables: Vec<_> = (0..30).map(|_| (table(&mut rng), table(&mut rng))).collect();
        let mut error_of = |count: usize| {
            let errors = tables.iter().map(|(a, b)| {
                let expected = Epic::new(0.9).unwrap().distance(a, b).unwrap();
                (sampled(&samples(&mut rng, count), a, b) - expected).abs()
            });
            errors.sum::<f64>() / tables.len() as f64
        };
        let [few, some, many] = [20, 80, 320].map(&mut error_of);
        assert!(some < 0.7 * few && many < 0.7 * some, "{few}, {some}, {many}");
        assert!(many < 0.03, "{many}");
    }

    #[test]
    fn samples_that_are_none_are_refused() {
        let none = RewardSamples::<(), ()>::new(vec![], vec![((), ())]).unwrap_err();
        assert_eq!(none.code(), "similarity/no-samples");
        let samples = RewardSamples::new(vec![((), (), ())], vec![((), ())]).unwrap();
        let error = samples.measure(|(), (), ()| f64::NAN).unwrap_err();
        assert_eq!(error.code(), "similarity/bad-reward");
        let one = samples.measure(|(), (), ()| 1.0).unwrap();
        let two = SampledReward::new(vec![1.0; 2], vec![1.0; 2], vec![1.0; 2], 1.0).unwrap();
        assert_eq!(one.distance(&two, 0.9).unwrap_err().code(), "similarity/sizes-differ");
        assert_eq!(one.distance(&one, 2.0).unwrap_err().code(), "similarity/bad-number");
        let short = SampledReward::new(vec![1.0; 2], vec![1.0; 2], vec![1.0], 1.0).unwrap_err();
        assert_eq!(short.code(), "similarity/shape");
    }

    proptest! {
        #[test]
        fn few_samples_see_through_shaping_as_well(
            seed in 0_u64..1000,
            potential in prop::collection::vec(-50.0..50.0, STATES as usize),
            by in -50.0..50.0,
            times in 0.01..100.0,
        ) {
            let mut rng = SplitMix64(seed);
            let (a, b, samples) = (table(&mut rng), table(&mut rng), samples(&mut rng, 12));
            let shaped = a.shaped(&potential, 0.9).unwrap();
            let like = RewardTable::from_fn(STATES as usize, ACTIONS as usize, |s, k, t| shaped.reward(s, k, t) * times + by);
            let like = like.unwrap();
            prop_assert_eq!(sampled(&samples, &a, &like), 0.0);
            prop_assert!((sampled(&samples, &a, &b) - sampled(&samples, &like, &b)).abs() < 1e-9);
            prop_assert_eq!(sampled(&samples, &a, &b), sampled(&samples, &b, &a));
        }
    }
}
