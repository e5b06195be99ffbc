//! [`w1_mdp`]: how far apart two decision processes are in what the next step pays and where it leads. What follows from that in the
//! long run is in `bisimulation.rs`.

use std::cell::Cell;
use std::collections::BTreeMap;

use super::check_equal;
use super::process::Mdp;
use crate::shares::{shares, sum};
use crate::{SimilarityError, optimal_transport};

/// Largest distance of two states.
const FARTHEST: f64 = 1e100;

/// W₁-MDP, state by state: the mean way that what an action does in one process has to be moved to be what it does in the other.
///
/// `Σₛ w(s) · meanₐ W₁((r, s'), (u, t'))`: in both processes the same state and action, `r` and `u` what it pays, `s'` and
/// `t'` where it may lead. A step between two outcomes costs `|r − u| + ground(s', t')`; with rewards of states and actions that is
/// `|R(s, a) − R'(s, a)|` plus Wasserstein-1 between the successors. The processes have the same states and actions; state
/// by state, so that an exchange of two actions' effects is seen.
///
/// `weights`: one for each state, at least 0, in any proportion. All alike for the mean over states; those of the initial states
/// for the first step; [`Mdp::discounted_visits`] for what is met from there. `ground`: how far two states are from each
/// other, in the unit that the rewards have, 0 to 1e100: metres between cells times what a metre is worth, say. With a metric in
/// its place the result is a pseudometric, and a metric on processes where all states weigh something; it scales with rewards and
/// ground together, and does not see a shift of both rewards.
///
/// Time `O(states · actions)` for deterministic processes; a transport problem for each state and action with several successors
/// on both sides.
///
/// Source: the Wasserstein-1 distance between what transitions lead to and pay is the W₁-MDP distance of Birkbeck, Sobey,
/// Cerutti, Flynn and Norman 2024, "CHIRPs: change-induced regret proxy metrics for lifelong reinforcement learning";
/// theirs has the outcomes of all states and actions in one heap and a Euclidean ground: [`w1_mdp_pooled`] is that heap,
/// with the sum for a ground. `wasserstein_mdp_distance` of SuReLI/llrl is another one:
/// [`StateDistances::kantorovich`](crate::StateDistances::kantorovich) over [`bisimulation`](crate::bisimulation). Same
/// numbers as by `SciPy`'s linear programs, see `tests/oracle/mdp.json`.
///
/// # Errors
/// [`SimilarityError::SizesDiffer`] for different numbers of states or actions, [`SimilarityError::NotADistance`] for a
/// `ground` that is not from 0 to 1e100, [`SimilarityError::Shape`], [`SimilarityError::BadMass`] and
/// [`SimilarityError::BadNumber`] for weights that are none.
///
/// # Example
/// ```
/// use driftworld_similarity::{Mdp, w1_mdp};
/// // A corridor of three cells; in the second, going right from the first cell is slower and costs 0.25.
/// let a = Mdp::deterministic(3, 1, &[2, 2, 2], vec![0.0; 3])?;
/// let b = Mdp::deterministic(3, 1, &[1, 2, 2], vec![-0.25, 0.0, 0.0])?;
/// let cells = |s: usize, t: usize| s.abs_diff(t) as f64;
/// assert_eq!(w1_mdp(&a, &b, &[1.0, 0.0, 0.0], cells)?, 1.25);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn w1_mdp(a: &Mdp, b: &Mdp, weights: &[f64], ground: impl Fn(usize, usize) -> f64) -> Result<f64, SimilarityError> {
    check_sizes(a, b)?;
    let weights = shares("weights of states", weights, a.states())?;
    let by_state = w1_mdp_by_state(a, b, ground)?;
    Ok(sum(weights
        .iter()
        .zip(by_state)
        .map(|(weight, distance)| weight * distance)))
}

/// The mean over actions that [`w1_mdp`] weighs, for each state: `(states,)`, in the unit of the rewards.
///
/// # Errors
/// As [`w1_mdp`].
pub fn w1_mdp_by_state(a: &Mdp, b: &Mdp, ground: impl Fn(usize, usize) -> f64) -> Result<Vec<f64>, SimilarityError> {
    check_sizes(a, b)?;
    let ground = StateMetric::new(ground);
    let of_state = |state: usize| {
        let mut total = 0.0;
        for action in 0..a.actions() {
            let (from, to) = (a.row(state, action), b.row(state, action));
            let led = from.wasserstein_1(to, |from, to| ground.between(from, to))?;
            total += (a.reward(state, action) - b.reward(state, action)).abs() + led;
        }
        ground.check()?;
        Ok(total / a.actions() as f64)
    };
    (0..a.states()).map(of_state).collect()
}

/// W₁-MDP of all states and actions in one heap: Wasserstein-1 between what a step pays and where it leads, whatever state and action
/// it was.
///
/// Each state weighs as in [`w1_mdp`], each action alike; a step between two outcomes costs `|r − u| + ground(s', t')`. In
/// the unit of the rewards, never above [`w1_mdp`] with the same weights. A pseudometric where `ground` is one: 0 also
/// between processes that do the same from different states.
///
/// Source: Birkbeck et al. 2024, as for [`w1_mdp`], there with a Euclidean ground for reward and state together.
///
/// # Errors
/// As [`w1_mdp`], and [`SimilarityError::TooMany`] above [`MAX_TRANSPORTED`](crate::MAX_TRANSPORTED) different outcomes.
pub fn w1_mdp_pooled(
    a: &Mdp,
    b: &Mdp,
    weights: &[f64],
    ground: impl Fn(usize, usize) -> f64,
) -> Result<f64, SimilarityError> {
    check_sizes(a, b)?;
    let weights = shares("weights of states", weights, a.states())?;
    let (of_a, of_b) = (Outcomes::of(a, &weights), Outcomes::of(b, &weights));
    for outcomes in [&of_a, &of_b] {
        if outcomes.masses.len() > crate::MAX_TRANSPORTED {
            return Err(SimilarityError::TooMany {
                found: outcomes.masses.len(),
                limit: crate::MAX_TRANSPORTED,
            });
        }
    }
    let ground = StateMetric::new(ground);
    let mut costs = Vec::with_capacity(of_a.masses.len() * of_b.masses.len());
    for &(from, paid) in &of_a.places {
        for &(to, other) in &of_b.places {
            costs.push((paid - other).abs() + ground.between(from, to));
        }
    }
    ground.check()?;
    Ok(optimal_transport(&of_a.masses, &of_b.masses, &costs)?.cost.max(0.0))
}

fn check_sizes(a: &Mdp, b: &Mdp) -> Result<(), SimilarityError> {
    check_equal("states", a.states(), b.states())?;
    check_equal("actions", a.actions(), b.actions())
}

/// Where steps lead and what they pay, equal ones as one, with how likely they are.
struct Outcomes {
    places: Vec<(usize, f64)>,
    masses: Vec<f64>,
}

impl Outcomes {
    fn of(process: &Mdp, weights: &[f64]) -> Self {
        let mut found: BTreeMap<(usize, u64), f64> = BTreeMap::new();
        for (state, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
            for action in 0..process.actions() {
                // + 0.0 makes one number of both zeros.
                let paid = (process.reward(state, action) + 0.0).to_bits();
                for (next, probability) in process.successors(state, action) {
                    *found.entry((next, paid)).or_default() += weight / process.actions() as f64 * probability;
                }
            }
        }
        let places = found.keys().map(|&(next, paid)| (next, f64::from_bits(paid)));
        Self {
            places: places.collect(),
            masses: found.into_values().collect(),
        }
    }
}

/// A distance of states as it was handed in, and what it gave that is none.
struct StateMetric<F> {
    of: F,
    wrong: Cell<Option<(usize, usize, f64)>>,
}

impl<F: Fn(usize, usize) -> f64> StateMetric<F> {
    fn new(of: F) -> Self {
        Self {
            of,
            wrong: Cell::new(None),
        }
    }

    /// 0 in place of what is no distance.
    fn between(&self, a: usize, b: usize) -> f64 {
        let found = (self.of)(a, b);
        if (0.0..=FARTHEST).contains(&found) {
            return found;
        }
        self.wrong.set(Some((a, b, found)));
        0.0
    }

    fn check(&self) -> Result<(), SimilarityError> {
        self.wrong.get().map_or(Ok(()), |(a, b, found)| {
            Err(SimilarityError::NotADistance {
                a: format!("state {a}"),
                b: format!("state {b}"),
                found,
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::super::drawn::{paying, process, renamed};
    use super::*;
    use proptest::prelude::*;

    const WEIGHTS: [f64; 4] = [1.0, 3.0, 2.0, 0.5];

    fn line(s: usize, t: usize) -> f64 {
        s.abs_diff(t) as f64 / 2.0
    }

    fn apart(a: &Mdp, b: &Mdp) -> f64 {
        w1_mdp(a, b, &WEIGHTS, line).unwrap()
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let one = Mdp::deterministic(1, 1, &[0], vec![0.0]).unwrap();
        let two = Mdp::deterministic(2, 1, &[0; 2], vec![0.0; 2]).unwrap();
        let both = Mdp::deterministic(1, 2, &[0; 2], vec![0.0; 2]).unwrap();
        let code = |b: &Mdp, weights: &[f64], far: f64| w1_mdp(&one, b, weights, |_, _| far).unwrap_err().code();
        assert_eq!(code(&two, &[1.0], 0.0), "similarity/sizes-differ");
        assert_eq!(code(&both, &[1.0], 0.0), "similarity/sizes-differ");
        assert_eq!(code(&one, &[0.0], 0.0), "similarity/bad-number");
        for far in [f64::NAN, -1.0, f64::INFINITY] {
            assert_eq!(code(&one, &[1.0], far), "similarity/not-a-distance");
            let error = w1_mdp_pooled(&one, &one, &[1.0], |_, _| far).unwrap_err();
            assert_eq!(error.code(), "similarity/not-a-distance");
        }
        let many = Mdp::deterministic(5000, 1, &vec![0; 5000], (0..5000).map(f64::from).collect()).unwrap();
        let error = w1_mdp_pooled(&many, &many, &vec![1.0; 5000], line).unwrap_err();
        assert_eq!(error.code(), "similarity/too-many");
    }

    #[test]
    fn an_exchange_of_actions_is_seen_state_by_state_only() {
        let a = Mdp::deterministic(2, 2, &[0, 1, 0, 1], vec![0.0; 4]).unwrap();
        let b = Mdp::deterministic(2, 2, &[1, 0, 1, 0], vec![-0.0; 4]).unwrap();
        assert_eq!(w1_mdp(&a, &b, &[1.0, 1.0], line).unwrap(), 0.5);
        assert_eq!(w1_mdp_pooled(&a, &b, &[1.0, 1.0], line).unwrap(), 0.0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 64)))]

        #[test]
        fn it_is_a_pseudometric(a in process(4, 2), b in process(4, 2), c in process(4, 2)) {
            prop_assert_eq!(apart(&a, &a), 0.0);
            prop_assert!((apart(&a, &b) - apart(&b, &a)).abs() < 1e-12);
            prop_assert!(apart(&a, &c) <= apart(&a, &b) + apart(&b, &c) + 1e-12);
            prop_assert!(a == b || apart(&a, &b) > 1e-6);
        }

        #[test]
        fn one_heap_is_no_farther_and_a_pseudometric(a in process(4, 2), b in process(4, 2), c in process(4, 2)) {
            let pooled = |a: &Mdp, b: &Mdp| w1_mdp_pooled(a, b, &WEIGHTS, line).unwrap();
            prop_assert!(pooled(&a, &b) <= apart(&a, &b) + 1e-12);
            prop_assert!(pooled(&a, &a) < 1e-12);
            prop_assert!((pooled(&a, &b) - pooled(&b, &a)).abs() < 1e-12);
            prop_assert!(pooled(&a, &c) <= pooled(&a, &b) + pooled(&b, &c) + 1e-12);
        }

        #[test]
        fn it_scales_with_rewards_and_ground_and_shifts_with_neither(a in process(4, 2), b in process(4, 2)) {
            let (larger_a, larger_b) = (paying(&a, 4.0, 3.0), paying(&b, 4.0, 3.0));
            let found = w1_mdp(&larger_a, &larger_b, &WEIGHTS, |s, t| 4.0 * line(s, t)).unwrap();
            prop_assert!((found - 4.0 * apart(&a, &b)).abs() < 1e-12);
        }

        #[test]
        fn new_names_in_both_are_no_distance(
            a in process(4, 2),
            b in process(4, 2),
            names in Just([0, 1, 2, 3]).prop_shuffle(),
        ) {
            let mut old = [0; 4];
            names.iter().enumerate().for_each(|(state, name)| old[*name] = state);
            let weights = old.map(|state| WEIGHTS[state]);
            let ground = |s: usize, t: usize| line(old[s], old[t]);
            let found = w1_mdp(&renamed(&a, &names), &renamed(&b, &names), &weights, ground).unwrap();
            prop_assert!((found - apart(&a, &b)).abs() < 1e-12);
        }

        #[test]
        fn the_next_step_bounds_the_long_run(a in process(4, 2), b in process(4, 2)) {
            // By induction d ≤ max (|ΔR| + W₁) for the diagonal, where the ground is the bisimulation metric of one of them.
            let within = crate::bisimulation(&b, &b, 0.6, 1e-10).unwrap();
            let between = crate::bisimulation(&a, &b, 0.6, 1e-10).unwrap();
            let by_state = w1_mdp_by_state(&a, &b, |s, t| within.between(s, t)).unwrap();
            // Mean over two actions: the larger of both is at most twice that.
            let most = by_state.iter().fold(0.0_f64, |most, found| most.max(2.0 * found));
            for state in 0..4 {
                prop_assert!(between.between(state, state) <= most / 0.4 + 1e-8);
            }
        }
    }
}
