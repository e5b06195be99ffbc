//! [`RewardSamples`]: the equivalent-policy invariant comparison of rewards (EPIC) over transitions. Drawing them is up to whoever
//! knows the world.

use std::cell::Cell;

use super::direction::Direction;
use crate::SimilarityError;
use crate::sum::sum;

/// Largest size of a reward: squares of shaped ones stay finite.
const LARGEST: f64 = 1e100;

/// How far off a shaped reward may be, as a multiple of 2⁻⁵² of the largest reward: half for the rewards themselves, some 2 for each
/// of three means, half the size of every partial sum; doubled.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

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
    /// the other; their states also stand for the state drawn. What is there twice counts twice.
    ///
    /// # Errors
    /// [`SimilarityError::NoSamples`] where one of them is empty.
    pub fn new(transitions: Vec<(S, A, S)>, draws: Vec<(A, S)>) -> Result<Self, SimilarityError> {
        if transitions.is_empty() || draws.is_empty() {
            return Err(SimilarityError::NoSamples);
        }
        Ok(Self { transitions, draws })
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
        let mut found = SampledReward {
            rewards: Vec::with_capacity(self.transitions.len()),
            before: Vec::with_capacity(self.transitions.len()),
            after: Vec::with_capacity(self.transitions.len()),
            overall: sum(self.draws.iter().map(|(_, state)| mean_from(state))) / draws,
            largest: 0.0,
        };
        for (state, action, next) in &self.transitions {
            found.rewards.push(reward(state, action, next));
            found.before.push(mean_from(state));
            found.after.push(mean_from(next));
        }
        let means = found.before.iter().chain(&found.after);
        found.largest = means.fold(most.get(), |most, mean| most.max(mean.abs()));
        found.check()?;
        Ok(found)
    }
}

/// A reward on some [`RewardSamples`].
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
    /// What each transition pays.
    rewards: Vec<f64>,
    /// The mean reward of going on at random from the state that each transition leaves.
    before: Vec<f64>,
    /// The same from the state that it enters.
    after: Vec<f64>,
    /// The same from a state that is drawn, too.
    overall: f64,
    /// The largest size of a reward, and of a mean.
    largest: f64,
}

impl SampledReward {
    fn check(&self) -> Result<(), SimilarityError> {
        for list in [&self.rewards, &self.before, &self.after, &vec![self.overall]] {
            if let Some(index) = list.iter().position(|value| value.is_nan() || value.abs() > LARGEST) {
                return Err(SimilarityError::BadReward {
                    place: format!("transition {index}"),
                    found: list[index],
                });
            }
        }
        Ok(())
    }

    /// The reward of each transition in its canonical shape, `R(s, a, s') + E[γ R(s', A, S') − R(s, A, S') − γ R(S, A, S')]`
    /// with `S`, `S'` and `A` drawn alike for all.
    fn canonical(&self, discount: f64) -> Vec<f64> {
        let means = self.before.iter().zip(&self.after);
        let shaped = self.rewards.iter().zip(means);
        shaped
            .map(|(reward, (before, after))| reward + discount * (after - self.overall) - before)
            .collect()
    }

    /// EPIC: how far apart two rewards are in what they ask for, under any dynamics. Both measured on the same samples.
    ///
    /// Both are brought into their canonical shape; then it is `√((1 − r) / 2)`, `r` Pearson's correlation over the
    /// transitions. 0 to 1: 0 between rewards that differ by potential shaping of this discount, by a factor above 0 and by a
    /// shift, and 1 between a reward and its reverse. A reward that is the same for all transitions, but for shaping, asks for
    /// nothing: it is 0 from its like and ½ from any other. What rounding alone can make is given as exactly 0: up to
    /// 32 · 2⁻⁵² times (largest reward / standard deviation of the canonical one), both rewards' added up.
    ///
    /// A pseudometric, whatever the samples. It differs from the distance of the distributions that were drawn from by something
    /// like `1 / √samples`. A difference where no sample lies is not seen.
    ///
    /// Source: Gleave, Dennis, Legg, Russell and Leike 2021, "Quantifying differences in reward functions", appendix A.1;
    /// `sample_canon_shaping` of `evaluating_rewards/distances/epic_sample.py`. On all transitions the same numbers as its
    /// tabular code (`tabular.py`), see `tests/oracle/reward.json`.
    ///
    /// # Errors
    /// [`SimilarityError::SizesDiffer`] for rewards of different samples, [`SimilarityError::BadNumber`] for a discount that is
    /// not from 0 to 1.
    pub fn distance(&self, other: &Self, discount: f64) -> Result<f64, SimilarityError> {
        if !(0.0..=1.0).contains(&discount) {
            return Err(SimilarityError::BadNumber {
                of: "discount",
                found: discount,
                expected: "a number from 0 to 1",
            });
        }
        let (a, b) = (self.rewards.len(), other.rewards.len());
        if a != b {
            return Err(SimilarityError::SizesDiffer {
                of: "rewards",
                what: "transitions",
                a,
                b,
            });
        }
        let direction = |reward: &Self| Direction::of(&reward.canonical(discount), ROUNDING * reward.largest);
        Ok(direction(self).distance(&direction(other)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::split_mix::SplitMix64;
    use proptest::prelude::*;

    const STATES: usize = 5;
    const ACTIONS: usize = 3;

    /// What each transition pays: `(states, actions, states)`.
    type Table = Vec<f64>;

    fn table(rng: &mut SplitMix64) -> Table {
        (0..STATES * ACTIONS * STATES).map(|_| rng.unit() - 0.5).collect()
    }

    fn of_table(build: impl Fn(usize, usize, usize) -> f64) -> Table {
        let build = &build;
        let rows = (0..STATES).flat_map(|s| (0..ACTIONS).map(move |k| (s, k)));
        rows.flat_map(|(s, k)| (0..STATES).map(move |t| build(s, k, t)))
            .collect()
    }

    fn paid(table: &Table, s: usize, k: usize, t: usize) -> f64 {
        table[(s * ACTIONS + k) * STATES + t]
    }

    fn shaped(table: &Table, potential: &[f64], discount: f64) -> Table {
        of_table(|s, k, t| paid(table, s, k, t) + discount * potential[t] - potential[s])
    }

    fn samples(rng: &mut SplitMix64, count: usize) -> RewardSamples<usize, usize> {
        let state = |rng: &mut SplitMix64| rng.below(STATES as u64) as usize;
        let action = |rng: &mut SplitMix64| rng.below(ACTIONS as u64) as usize;
        let transitions = (0..count).map(|_| (state(rng), action(rng), state(rng))).collect();
        let draws = (0..count).map(|_| (action(rng), state(rng))).collect();
        RewardSamples::new(transitions, draws).unwrap()
    }

    /// Every transition and every draw.
    fn every() -> RewardSamples<usize, usize> {
        let draws: Vec<(usize, usize)> = (0..ACTIONS).flat_map(|k| (0..STATES).map(move |t| (k, t))).collect();
        let from = |s: usize| draws.iter().map(move |&(k, t)| (s, k, t));
        RewardSamples::new((0..STATES).flat_map(from).collect(), draws.clone()).unwrap()
    }

    fn apart(samples: &RewardSamples<usize, usize>, a: &Table, b: &Table, discount: f64) -> f64 {
        let measure = |table: &Table| samples.measure(|&s, &k, &t| paid(table, s, k, t)).unwrap();
        measure(a).distance(&measure(b), discount).unwrap()
    }

    #[test]
    fn a_reward_that_asks_for_nothing_lies_in_the_middle() {
        let nothing = of_table(|_, _, _| 0.3);
        let soft = shaped(&nothing, &[1.0, -7.3, 0.2, 4.0, 0.0], 0.9);
        let goal = of_table(|_, _, next| f64::from(next == 1));
        assert_eq!(apart(&every(), &nothing, &soft, 0.9), 0.0);
        assert_eq!(apart(&every(), &goal, &soft, 0.9), 0.5);
    }

    #[test]
    fn shaping_of_another_discount_is_seen() {
        let goal = of_table(|_, _, next| f64::from(next == 1));
        let soft = shaped(&goal, &[5.0, 1.0, 0.0, 2.0, 3.0], 0.9);
        assert!(apart(&every(), &goal, &soft, 0.5) > 0.1);
    }

    #[test]
    fn the_error_falls_with_the_root_of_the_number_of_samples() {
        let mut rng = SplitMix64(2);
        let tables: Vec<_> = (0..30).map(|_| (table(&mut rng), table(&mut rng))).collect();
        let every = every();
        let mut error_of = |count: usize| {
            let errors = tables.iter().map(|(a, b)| {
                let drawn = samples(&mut rng, count);
                (apart(&drawn, a, b, 0.9) - apart(&every, a, b, 0.9)).abs()
            });
            errors.sum::<f64>() / tables.len() as f64
        };
        let [few, some, many] = [20, 80, 320].map(&mut error_of);
        assert!(some < 0.7 * few && many < 0.7 * some, "{few}, {some}, {many}");
        assert!(many < 0.03, "{many}");
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let none = RewardSamples::<(), ()>::new(vec![], vec![((), ())]).unwrap_err();
        assert_eq!(none.code(), "similarity/no-samples");
        let samples = RewardSamples::new(vec![((), (), ())], vec![((), ())]).unwrap();
        for bad in [f64::NAN, 1e101] {
            let error = samples.measure(|(), (), ()| bad).unwrap_err();
            assert_eq!(error.code(), "similarity/bad-reward");
        }
        let one = samples.measure(|(), (), ()| 1.0).unwrap();
        let samples = RewardSamples::new(vec![((), (), ()); 2], vec![((), ())]).unwrap();
        let two = samples.measure(|(), (), ()| 1.0).unwrap();
        assert_eq!(one.distance(&two, 0.9).unwrap_err().code(), "similarity/sizes-differ");
        assert_eq!(one.distance(&one, 2.0).unwrap_err().code(), "similarity/bad-number");
    }

    proptest! {
        #[test]
        fn it_is_a_pseudometric_on_any_samples(seed in 0_u64..1000, discount in 0.0..=1.0) {
            let mut rng = SplitMix64(seed);
            let (a, b, c) = (table(&mut rng), table(&mut rng), table(&mut rng));
            for samples in [every(), samples(&mut rng, 12)] {
                let d = |a: &Table, b: &Table| apart(&samples, a, b, discount);
                prop_assert_eq!(d(&a, &a), 0.0);
                prop_assert_eq!(d(&a, &b), d(&b, &a));
                prop_assert!((0.0..=1.0).contains(&d(&a, &b)));
                prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-12);
            }
        }

        #[test]
        fn what_asks_for_the_same_is_exactly_0_apart(
            seed in 0_u64..1000,
            potential in prop::collection::vec(-50.0..50.0, STATES),
            by in -50.0..50.0,
            times in 0.01..100.0,
            discount in 0.0..=1.0,
        ) {
            let mut rng = SplitMix64(seed);
            let (a, b) = (table(&mut rng), table(&mut rng));
            let soft = shaped(&a, &potential, discount);
            let like: Table = soft.iter().map(|reward| reward * times + by).collect();
            let reversed: Table = like.iter().map(|reward| -reward).collect();
            for samples in [every(), samples(&mut rng, 12)] {
                let d = |a: &Table, b: &Table| apart(&samples, a, b, discount);
                prop_assert_eq!(d(&a, &like), 0.0);
                let far = d(&a, &reversed);
                prop_assert!(far == 0.0 || (far - 1.0).abs() < 1e-9, "{far}");
                prop_assert!((d(&a, &b) - d(&like, &b)).abs() < 1e-9);
            }
        }
    }
}
