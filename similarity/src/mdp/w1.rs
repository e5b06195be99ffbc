//! [`w1_mdp`]: compares two decision processes by the reward and the successor of single steps.

use crate::SimilarityError;

/// Differences below this are rounding errors, such as those from summing over different numbers of steps.
const ROUNDING: f64 = 1e-12;

/// W₁-MDP of two deterministic processes, state by state: the mean distance between the outcomes of the same action in both.
/// Returns the share due to rewards and the share due to successors; their sum is the distance.
///
/// The Wasserstein-1 distance between two deterministic outcomes is the cost between them, here `|r − u| / unit + ground`, with `r`
/// and `u` the rewards of the same action in the same state of both. The mean is over all actions of the counted states;
/// outcomes are compared state by state, so swapping the effects of two actions is noticed.
///
/// `rewards`: for each process, `(states · actions,)`, state by state, then action by action. `unit`: the difference in
/// reward that counts as 1. `counted`: `(states,)`, at least one of them true. `ground(row)`: the distance between the
/// successors of a state and an action, by their index in `rewards`. With a metric between successors it is a metric on the
/// processes' counted states; a shift of both rewards does not change it.
///
/// Source: the Wasserstein-1 distance between the successors and rewards of transitions is the W₁-MDP distance of Birkbeck,
/// Sobey, Cerutti, Flynn and Norman 2024, "CHIRPs: change-induced regret proxy metrics for lifelong reinforcement
/// learning"; theirs pools the outcomes of all states and actions and uses a Euclidean ground distance. Matches
/// `SciPy`'s linear programs, see `tests/oracle/mdp.json`.
///
/// # Errors
/// [`SimilarityError::Shape`] for lists of rewards whose lengths differ or are not a multiple of the number of states.
///
/// # Example
/// ```
/// use driftworld_similarity::w1_mdp;
/// // A corridor of three cells; in the second, going right from the first cell is slower and costs 0.25.
/// let (a, b) = ([2, 2, 2_usize], [1, 2, 2_usize]);
/// let cells = |row: usize| a[row].abs_diff(b[row]) as f64;
/// let found = w1_mdp([&[0.0; 3], &[-0.25, 0.0, 0.0]], 1.0, &[true, false, false], cells)?;
/// assert_eq!(found, (0.25, 1.0));
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn w1_mdp(
    rewards: [&[f64]; 2],
    unit: f64,
    counted: &[bool],
    ground: impl Fn(usize) -> f64,
) -> Result<(f64, f64), SimilarityError> {
    let [a, b] = rewards;
    let actions = a.len() / counted.len().max(1);
    for found in [a.len(), b.len()] {
        let expected = (actions * counted.len()).max(1);
        SimilarityError::check_length("rewards of states × actions", found, expected)?;
    }
    let (mut reward_part, mut successor_part, mut rows) = (0.0, 0.0, 0_usize);
    for (state, _) in counted.iter().enumerate().filter(|(_, counts)| **counts) {
        for row in state * actions..(state + 1) * actions {
            let gap = (a[row] - b[row]).abs() / unit;
            reward_part += if gap < ROUNDING { 0.0 } else { gap };
            successor_part += ground(row);
        }
        rows += actions;
    }
    let rows = rows as f64;
    Ok((reward_part / rows, successor_part / rows))
}

#[cfg(test)]
mod tests {
    use super::super::Mdp;
    use super::super::drawn::process;
    use super::*;
    use proptest::prelude::*;

    const COUNTED: [bool; 4] = [true, true, false, true];

    fn scaled_distance(a: &Mdp, b: &Mdp, times: f64) -> f64 {
        let rewards = |of: &Mdp| -> Vec<f64> { rows().map(|(s, k)| times * of.reward(s, k) + 3.0).collect() };
        let ground = |row: usize| {
            let (s, k) = (row / 2, row % 2);
            times * f64::from(a.successor(s, k).abs_diff(b.successor(s, k)))
        };
        let (reward_part, successor_part) = w1_mdp([&rewards(a), &rewards(b)], 0.5, &COUNTED, ground).unwrap();
        reward_part + successor_part
    }

    fn rows() -> impl Iterator<Item = (usize, usize)> {
        (0..4).flat_map(|state| (0..2).map(move |action| (state, action)))
    }

    #[test]
    fn mismatched_lists_are_refused() {
        let code = |a: &[f64], b: &[f64], counted: &[bool]| w1_mdp([a, b], 1.0, counted, |_| 0.0).unwrap_err().code();
        assert_eq!(code(&[0.0; 4], &[0.0; 3], &[true; 2]), "similarity/shape");
        assert_eq!(code(&[0.0; 3], &[0.0; 3], &[true; 2]), "similarity/shape");
        assert_eq!(code(&[], &[], &[]), "similarity/shape");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 64)))]

        #[test]
        fn w1_mdp_is_a_pseudometric_that_scales(a in process(4, 2), b in process(4, 2), c in process(4, 2)) {
            let d = |a: &Mdp, b: &Mdp| scaled_distance(a, b, 1.0);
            prop_assert_eq!(d(&a, &a), 0.0);
            prop_assert_eq!(d(&a, &b), d(&b, &a));
            prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-12);
            prop_assert!((scaled_distance(&a, &b, 4.0) - 4.0 * d(&a, &b)).abs() < 1e-12);
        }

        #[test]
        fn single_step_distance_bounds_the_long_run(a in process(4, 2), b in process(4, 2)) {
            // By induction d ≤ max (|ΔR| + ground) for the diagonal, where the ground is the bisimulation metric of one of
            // them.
            let d = |a: &Mdp, b: &Mdp, s, t| crate::bisimulation(a, b, (s, t), 0.6, 100).unwrap().upper;
            let rewards = |of: &Mdp| -> Vec<f64> { rows().map(|(s, k)| of.reward(s, k)).collect() };
            let ground = |row: usize| {
                let (s, k) = (row / 2, row % 2);
                d(&b, &b, a.successor(s, k) as usize, b.successor(s, k) as usize)
            };
            let bound = (0..4).map(|state| {
                let only: Vec<bool> = (0..4).map(|other| other == state).collect();
                let (reward_part, successor_part) = w1_mdp([&rewards(&a), &rewards(&b)], 1.0, &only, ground).unwrap();
                // Mean over two actions: the larger one is at most twice that.
                2.0 * (reward_part + successor_part)
            });
            let bound = bound.fold(0.0, f64::max);
            for state in 0..4 {
                prop_assert!(d(&a, &b, state, state) <= bound / 0.4 + 1e-8);
            }
        }
    }
}
