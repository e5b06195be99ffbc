//! [`RewardSamples`]: the equivalent-policy invariant comparison of rewards (EPIC) over given transitions.

use std::cell::Cell;

use super::direction::Direction;
use crate::SimilarityError;
use crate::sum::sum;

/// Largest absolute reward: squares of shaped rewards stay finite.
const MAX_REWARD: f64 = 1e100;

/// Maximum error of a shaped reward, as a multiple of 2⁻⁵² of the largest reward: half for the rewards themselves, about 2 for
/// each of three means, half the size of every partial sum; all doubled.
const ROUNDING: f64 = 32.0 * f64::EPSILON;

/// The samples on which rewards are compared: transitions, and pairs of an action and a state for the means.
///
/// `S` and `A` are the arguments of a reward: an index, a pose, a whole world. Both rewards must be measured on the same
/// samples.
#[derive(Clone, Debug)]
pub struct RewardSamples<S, A> {
    transitions: Vec<(S, A, S)>,
    draws: Vec<(A, S)>,
}

impl<S, A> RewardSamples<S, A> {
    /// `transitions`: state, action, next state, from the coverage distribution of the comparison; only possible ones, if
    /// impossible ones never pay. `draws`: actions and next states for estimating the canonical shape, drawn independently of
    /// each other; their states also serve as the random start states. Duplicates count twice.
    ///
    /// # Errors
    /// [`SimilarityError::NoSamples`] if one of them is empty.
    pub fn new(transitions: Vec<(S, A, S)>, draws: Vec<(A, S)>) -> Result<Self, SimilarityError> {
        if transitions.is_empty() || draws.is_empty() {
            return Err(SimilarityError::NoSamples);
        }
        Ok(Self { transitions, draws })
    }

    /// Evaluates a reward on these samples. It is called `transitions · (1 + 2 · draws) + draws²` times.
    ///
    /// # Errors
    /// [`SimilarityError::BadReward`] for one that is not within ±1e100.
    pub fn measure(&self, reward: impl Fn(&S, &A, &S) -> f64) -> Result<SampledReward, SimilarityError> {
        // Means of large rewards that cancel keep the rounding error of the large ones.
        let max_seen = Cell::new(0.0_f64);
        let reward = |state: &S, action: &A, next: &S| {
            let value = reward(state, action, next);
            max_seen.set(max_seen.get().max(value.abs()));
            value
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
        found.largest = means.fold(max_seen.get(), |max_seen, mean| max_seen.max(mean.abs()));
        found.check()?;
        Ok(found)
    }
}

/// A reward evaluated on some [`RewardSamples`].
///
/// # Example
/// ```
/// use driftworld_similarity::RewardSamples;
/// // States are positions on a line; there is only one action.
/// let positions = [0.0, 1.0, 2.0, 3.0];
/// let transitions = positions.iter().flat_map(|&from| positions.map(|to| (from, (), to))).collect();
/// let samples = RewardSamples::new(transitions, positions.map(|position| ((), position)).to_vec())?;
/// let goal = samples.measure(|_, (), to| f64::from(*to == 3.0))?;
/// let soft = samples.measure(|from, (), to| 2.0 * f64::from(*to == 3.0) + 0.9 * to - from)?;
/// assert_eq!(goal.distance(&soft, 0.9)?, 0.0);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SampledReward {
    /// The reward of each transition.
    rewards: Vec<f64>,
    /// The mean reward of a random step from the state that each transition leaves.
    before: Vec<f64>,
    /// The mean reward of a random step from the state that it enters.
    after: Vec<f64>,
    /// The mean reward of a random step from a random state.
    overall: f64,
    /// The largest absolute reward or mean.
    largest: f64,
}

impl SampledReward {
    fn check(&self) -> Result<(), SimilarityError> {
        for list in [&self.rewards, &self.before, &self.after, &vec![self.overall]] {
            if let Some(index) = list.iter().position(|value| value.is_nan() || value.abs() > MAX_REWARD) {
                return Err(SimilarityError::BadReward {
                    place: format!("transition {index}"),
                    found: list[index],
                });
            }
        }
        Ok(())
    }

    /// The reward of each transition in its canonical shape, `R(s, a, s') + E[γ R(s', A, S') − R(s, A, S') − γ R(S, A, S')]`
    /// with the same samples of `S`, `S'` and `A` for all.
    fn canonical(&self, discount: f64) -> Vec<f64> {
        let means = self.before.iter().zip(&self.after);
        let shaped = self.rewards.iter().zip(means);
        shaped
            .map(|(reward, (before, after))| reward + discount * (after - self.overall) - before)
            .collect()
    }

    /// EPIC: the distance between two rewards up to equivalence of their optimal policies, under any dynamics. Both must be
    /// measured on the same samples.
    ///
    /// Both are brought into their canonical shape; the distance is `√((1 − r) / 2)` with Pearson's correlation `r`
    /// over the transitions. 0 to 1: 0 between rewards that differ by potential shaping with this discount, by a factor
    /// above 0 and by a shift, and 1 between a reward and its reverse. A reward that is constant, apart from shaping, has
    /// no preference: it is 0 from another such reward and ½ from any other. Distances within rounding are exactly 0:
    /// up to 32 · 2⁻⁵² times (largest reward / standard deviation of the canonical one), summed over both rewards.
    ///
    /// A pseudometric for any samples. It differs from the distance over the sampled distributions by about `1 / √samples`.
    /// Differences where there is no sample go unnoticed.
    ///
    /// Source: Gleave, Dennis, Legg, Russell and Leike 2021, "Quantifying differences in reward functions", appendix A.1;
    /// `sample_canon_shaping` of `evaluating_rewards/distances/epic_sample.py`. On all transitions the same numbers as its
    /// tabular code (`tabular.py`), see `tests/oracle/reward.json`.
    ///
    /// # Errors
    /// [`SimilarityError::SizesDiffer`] for different numbers of transitions, [`SimilarityError::BadNumber`] for a discount
    /// outside 0 to 1.
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

    /// The reward of each transition: `(states, actions, states)`.
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

    fn reward_of(table: &Table, s: usize, k: usize, t: usize) -> f64 {
        table[(s * ACTIONS + k) * STATES + t]
    }

    fn shaped(table: &Table, potential: &[f64], discount: f64) -> Table {
        of_table(|s, k, t| reward_of(table, s, k, t) + discount * potential[t] - potential[s])
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

    fn distance_on(samples: &RewardSamples<usize, usize>, a: &Table, b: &Table, discount: f64) -> f64 {
        let measure = |table: &Table| samples.measure(|&s, &k, &t| reward_of(table, s, k, t)).unwrap();
        measure(a).distance(&measure(b), discount).unwrap()
    }

    #[test]
    fn constant_reward_is_halfway() {
        let nothing = of_table(|_, _, _| 0.3);
        let soft = shaped(&nothing, &[1.0, -7.3, 0.2, 4.0, 0.0], 0.9);
        let goal = of_table(|_, _, next| f64::from(next == 1));
        assert_eq!(distance_on(&every(), &nothing, &soft, 0.9), 0.0);
        assert_eq!(distance_on(&every(), &goal, &soft, 0.9), 0.5);
    }

    #[test]
    fn shaping_with_a_different_discount_is_noticed() {
        let goal = of_table(|_, _, next| f64::from(next == 1));
        let soft = shaped(&goal, &[5.0, 1.0, 0.0, 2.0, 3.0], 0.9);
        assert!(distance_on(&every(), &goal, &soft, 0.5) > 0.1);
    }

    #[test]
    fn error_falls_with_the_root_of_the_number_of_samples() {
        let mut rng = SplitMix64(2);
        let tables: Vec<_> = (0..30).map(|_| (table(&mut rng), table(&mut rng))).collect();
        let every = every();
        let mut error_of = |count: usize| {
            let errors = tables.iter().map(|(a, b)| {
                let drawn = samples(&mut rng, count);
                (distance_on(&drawn, a, b, 0.9) - distance_on(&every, a, b, 0.9)).abs()
            });
            errors.sum::<f64>() / tables.len() as f64
        };
        let [few, some, many] = [20, 80, 320].map(&mut error_of);
        assert!(some < 0.7 * few && many < 0.7 * some, "{few}, {some}, {many}");
        assert!(many < 0.03, "{many}");
    }

    #[test]
    fn incomparable_rewards_are_refused() {
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
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn epic_is_a_pseudometric_on_any_samples(seed in 0_u64..1000, discount in 0.0..=1.0) {
            let mut rng = SplitMix64(seed);
            let (a, b, c) = (table(&mut rng), table(&mut rng), table(&mut rng));
            for samples in [every(), samples(&mut rng, 12)] {
                let d = |a: &Table, b: &Table| distance_on(&samples, a, b, discount);
                prop_assert_eq!(d(&a, &a), 0.0);
                prop_assert_eq!(d(&a, &b), d(&b, &a));
                prop_assert!((0.0..=1.0).contains(&d(&a, &b)));
                prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-12);
            }
        }

        #[test]
        fn equivalent_rewards_are_exactly_0_apart(
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
                let d = |a: &Table, b: &Table| distance_on(&samples, a, b, discount);
                prop_assert_eq!(d(&a, &like), 0.0);
                let far = d(&a, &reversed);
                prop_assert!(far == 0.0 || (far - 1.0).abs() < 1e-9, "{far}");
                prop_assert!((d(&a, &b) - d(&like, &b)).abs() < 1e-9);
            }
        }
    }
}
