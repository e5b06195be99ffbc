//! [`bisimulation`]: how far each state of one decision process is from each of another, in what can be earned and where it leads.
//! What the table says of the processes as wholes is in `state_distances.rs`; large deterministic ones are in `paired.rs`.

use rayon::prelude::*;

use super::process::Mdp;
use super::state_distances::StateDistances;
use super::{check_discount, check_equal, check_tolerance};
use crate::SimilarityError;

/// Most pairs of a state of one process and a state of the other that [`bisimulation`] takes: two tables of 128 MiB.
pub const MAX_STATE_PAIRS: usize = 1 << 24;

/// The bisimulation metric between the states of two decision processes with the same actions.
///
/// The one solution of `d(s, t) = maxₐ (1 − c) |R(s, a) − R(t, a)| + c W₁(P(s, a), P(t, a); d)`, `c` the `discount` and W₁ the
/// Wasserstein-1 distance by `d` itself. In the unit of the rewards, 0 to the largest difference of two rewards. 0 exactly where
/// no sequence of actions can tell the states apart by what it earns. A pseudometric on the states of all processes with
/// these actions together; a state is 0 from itself. Both rewards scaled by a factor scale it, both shifted leave it alone.
///
/// `discount`: 0 to 0.9999, the weight of where an action leads against what it pays. For optimal values under a discount of no
/// more than `c`, `(1 − c) |V*(s) − V*(t)| ≤ d(s, t)`. `tolerance`: above 0, in the unit of the rewards. Distances are never
/// too large, but for rounding, and too small by at most [`StateDistances::error`], which is within the tolerance unless rounding
/// stops the search before.
///
/// Iterated from 0; each sweep brings the error down to `c` times what it was, so that it takes
/// `log(tolerance / largest difference) / log(c)` sweeps of a transport problem for each pair and action. Where one of two actions has
/// one successor that is a sum, else [`optimal_transport`](crate::optimal_transport). On as many threads as rayon has, with
/// the same numbers on any.
///
/// Source: Ferns, Panangaden and Precup 2004, "Metrics for finite Markov decision processes", with `c_R = 1 − c`, `c_T = c`;
/// between two processes as in Song, Gao, Wang and An 2016. `bi_simulation_distance` in SuReLI/llrl is the same with
/// `cr = 1 − c`. Same numbers as by `SciPy`'s linear programs, see `tests/oracle/mdp.json`.
///
/// # Errors
/// [`SimilarityError::SizesDiffer`] for different numbers of actions, [`SimilarityError::TooMany`] above
/// [`MAX_STATE_PAIRS`], [`SimilarityError::BadNumber`] for a discount or a tolerance that is none.
///
/// # Example
/// ```
/// use driftworld_similarity::{Mdp, bisimulation};
/// // A state that pays 1 for ever, against one that pays 1 once and then nothing.
/// let pays = Mdp::deterministic(1, 1, &[0], vec![1.0])?;
/// let stops = Mdp::deterministic(2, 1, &[1, 1], vec![1.0, 0.0])?;
/// let d = bisimulation(&pays, &stops, 0.9, 1e-12)?;
/// assert!((d.between(0, 1) - 1.0).abs() < 1e-11);
/// assert!((d.between(0, 0) - 0.9).abs() < 1e-11);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn bisimulation(a: &Mdp, b: &Mdp, discount: f64, tolerance: f64) -> Result<StateDistances, SimilarityError> {
    check_equal("actions", a.actions(), b.actions())?;
    check_discount(discount)?;
    check_tolerance(tolerance)?;
    let pairs = a.states().saturating_mul(b.states());
    if pairs > MAX_STATE_PAIRS {
        return Err(SimilarityError::TooMany {
            found: pairs,
            limit: MAX_STATE_PAIRS,
        });
    }
    let columns = b.states();
    let (mut values, mut following) = (vec![0.0; pairs], vec![0.0; pairs]);
    loop {
        let step = |state: usize, line: &mut [f64]| -> Result<f64, SimilarityError> {
            let mut change = 0.0_f64;
            for (other, distance) in line.iter_mut().enumerate() {
                *distance = stepped(a, b, (state, other), discount, &values)?;
                change = change.max((*distance - values[state * columns + other]).abs());
            }
            Ok(change)
        };
        let lines = following.par_chunks_mut(columns).enumerate();
        let changes = lines.map(|(state, line)| step(state, line));
        let change = changes.try_reduce(|| 0.0, |a, b| Ok(a.max(b)))?;
        std::mem::swap(&mut values, &mut following);
        let error = discount / (1.0 - discount) * change;
        let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(*value));
        if error <= tolerance || change <= 8.0 * f64::EPSILON * largest {
            return Ok(StateDistances::new(a.states(), columns, values, error));
        }
    }
}

/// The distance of two states by the distances of their successors.
fn stepped(
    a: &Mdp,
    b: &Mdp,
    (state, other): (usize, usize),
    discount: f64,
    values: &[f64],
) -> Result<f64, SimilarityError> {
    let mut most = 0.0_f64;
    for action in 0..a.actions() {
        let paid = (a.reward(state, action) - b.reward(other, action)).abs();
        let (from, to) = (a.row(state, action), b.row(other, action));
        let led = from.wasserstein_1(to, |from, to| values[from * b.states() + to])?;
        most = most.max((1.0 - discount) * paid + discount * led);
    }
    Ok(most)
}

#[cfg(test)]
mod tests {
    use super::super::drawn::{paying, process, renamed};
    use super::*;
    use proptest::prelude::*;

    const WITHIN: f64 = 1e-9;

    fn apart(a: &Mdp, b: &Mdp) -> StateDistances {
        bisimulation(a, b, 0.6, WITHIN).unwrap()
    }

    #[test]
    fn what_cannot_be_compared_is_refused() {
        let one = Mdp::deterministic(1, 1, &[0], vec![0.0]).unwrap();
        let two = Mdp::deterministic(1, 2, &[0; 2], vec![0.0; 2]).unwrap();
        let code = |b: &Mdp, discount, tolerance| bisimulation(&one, b, discount, tolerance).unwrap_err().code();
        assert_eq!(code(&two, 0.5, 1e-9), "similarity/sizes-differ");
        assert_eq!(code(&one, 1.0, 1e-9), "similarity/bad-number");
        assert_eq!(code(&one, 0.5, 0.0), "similarity/bad-number");
        let many = Mdp::deterministic(5000, 1, &vec![0; 5000], vec![0.0; 5000]).unwrap();
        let error = bisimulation(&many, &many, 0.5, 1e-9).unwrap_err();
        assert_eq!(error.code(), "similarity/too-many");
    }

    #[test]
    fn a_tolerance_below_rounding_ends_as_well() {
        let a = Mdp::deterministic(1, 1, &[0], vec![1.0 / 3.0]).unwrap();
        let b = Mdp::deterministic(1, 1, &[0], vec![-1.0 / 7.0]).unwrap();
        let d = bisimulation(&a, &b, 0.99, 1e-300).unwrap();
        assert!((d.between(0, 0) - 10.0 / 21.0).abs() < 1e-12);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn it_is_a_pseudometric(a in process(3, 2), b in process(2, 2), c in process(3, 2)) {
            let (ab, bc, ac) = (apart(&a, &b), apart(&b, &c), apart(&a, &c));
            let (ba, aa) = (apart(&b, &a), apart(&a, &a));
            for s in 0..3 {
                prop_assert!(aa.between(s, s) == 0.0, "a state is 0 from itself");
                for t in 0..2 {
                    prop_assert!((ab.between(s, t) - ba.between(t, s)).abs() < 1e-12);
                    for u in 0..3 {
                        prop_assert!(ac.between(s, u) <= ab.between(s, t) + bc.between(t, u) + 2.0 * WITHIN);
                    }
                }
            }
            let off = (ab.hausdorff(), bc.hausdorff(), ac.hausdorff());
            prop_assert!(off.2 <= off.0 + off.1 + 2.0 * WITHIN);
        }

        #[test]
        fn names_of_states_are_no_distance(
            a in process(4, 2),
            b in process(3, 2),
            names in Just([0, 1, 2, 3]).prop_shuffle(),
        ) {
            let other = renamed(&a, &names);
            let (found, expected) = (apart(&other, &b), apart(&a, &b));
            for (s, &name) in names.iter().enumerate() {
                for t in 0..3 {
                    prop_assert!((found.between(name, t) - expected.between(s, t)).abs() < 2.0 * WITHIN);
                }
                prop_assert!(apart(&a, &other).between(s, name) < WITHIN);
            }
            prop_assert!((found.hausdorff() - expected.hausdorff()).abs() < 2.0 * WITHIN);
            prop_assert!(apart(&a, &other).hausdorff() < WITHIN);
        }

        #[test]
        fn it_scales_with_the_rewards_and_shifts_with_neither(a in process(3, 2), b in process(3, 2)) {
            let expected = apart(&a, &b);
            let larger = apart(&paying(&a, 4.0, 3.0), &paying(&b, 4.0, 3.0));
            for (found, expected) in larger.values().iter().zip(expected.values()) {
                prop_assert!((found - 4.0 * expected).abs() < 8.0 * WITHIN, "{found}, {expected}");
            }
        }

        #[test]
        fn optimal_values_are_no_farther_apart_than_states(a in process(3, 2), b in process(4, 2), discount in 0.0..0.8) {
            let d = bisimulation(&a, &b, 0.8, WITHIN).unwrap();
            let of_a = a.optimal_values(discount, WITHIN).unwrap();
            let of_b = b.optimal_values(discount, WITHIN).unwrap();
            for (s, v) in of_a.iter().enumerate() {
                for (t, w) in of_b.iter().enumerate() {
                    prop_assert!(0.2 * (v - w).abs() <= d.between(s, t) + 3.0 * WITHIN);
                }
            }
        }
    }
}
