//! How often each state of a decision process is met by who acts at random: weights for distances state by state.

use super::process::Mdp;
use super::{check_discount, check_tolerance};
use crate::SimilarityError;
use crate::shares::shares;

impl Mdp {
    /// Where an agent is that takes every action alike, from its first step on: `(1 − γ) Σₜ γᵗ P(sₜ = s)`.
    ///
    /// `starts`: how likely each state is the first, at least 0, in any proportion. `discount`: γ, 0 to 0.9999; the agent has
    /// `1 / (1 − γ)` steps on average. `tolerance`: above 0, how much of the sum may be missing; it is divided out.
    /// Returns `(states,)`, of sum 1. Time `O(states · actions)` for each of `log(tolerance) / log(γ)` steps.
    ///
    /// # Errors
    /// [`SimilarityError::Shape`], [`SimilarityError::BadMass`] and [`SimilarityError::BadNumber`] for weights or settings
    /// that are none.
    ///
    /// # Example
    /// ```
    /// let process = driftworld_similarity::Mdp::deterministic(2, 1, &[1, 1], vec![0.0; 2])?;
    /// let visits = process.discounted_visits(&[1.0, 0.0], 0.75, 1e-12)?;
    /// assert!((visits[0] - 0.25).abs() < 1e-12);
    /// # Ok::<(), driftworld_similarity::SimilarityError>(())
    /// ```
    pub fn discounted_visits(
        &self,
        starts: &[f64],
        discount: f64,
        tolerance: f64,
    ) -> Result<Vec<f64>, SimilarityError> {
        check_discount(discount)?;
        check_tolerance(tolerance)?;
        let mut now = shares("weights of starts", starts, self.states())?;
        let mut visits = vec![0.0; self.states()];
        let (mut later, mut left) = (vec![0.0; self.states()], 1.0);
        while left > tolerance.max(f64::MIN_POSITIVE) {
            for (visits, here) in visits.iter_mut().zip(&now) {
                *visits += left * here;
            }
            left *= discount;
            self.step_at_random(&now, &mut later);
            std::mem::swap(&mut now, &mut later);
        }
        if visits.iter().all(|visits| *visits == 0.0) {
            return Ok(now);
        }
        shares("visits", &visits, self.states())
    }

    /// Where the next step leads.
    fn step_at_random(&self, now: &[f64], later: &mut [f64]) {
        later.fill(0.0);
        for (state, here) in now.iter().enumerate().filter(|(_, here)| **here > 0.0) {
            let each = here / self.actions() as f64;
            for action in 0..self.actions() {
                for (next, probability) in self.row(state, action).iter() {
                    later[next] += each * probability;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::drawn::process;
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn settings_that_are_none_are_refused() {
        let process = Mdp::deterministic(1, 1, &[0], vec![1.0]).unwrap();
        let code = |starts: &[f64], discount, tolerance| {
            process
                .discounted_visits(starts, discount, tolerance)
                .unwrap_err()
                .code()
        };
        assert_eq!(code(&[], 0.5, 1e-9), "similarity/shape");
        assert_eq!(code(&[1.0], 1.0, 1e-9), "similarity/bad-number");
        assert_eq!(code(&[1.0], 0.5, 0.0), "similarity/bad-number");
        assert_eq!(process.discounted_visits(&[2.0], 0.5, 7.0).unwrap(), [1.0]);
    }

    proptest! {
        #[test]
        fn visits_come_from_starts_and_from_visits(process in process(4, 2), discount in 0.0..0.9) {
            let starts = [0.5, 0.25, 0.25, 0.0];
            let visits = process.discounted_visits(&starts, discount, 1e-13).unwrap();
            let mut from = vec![0.0; 4];
            process.step_at_random(&visits, &mut from);
            for state in 0..4 {
                let expected = (1.0 - discount) * starts[state] + discount * from[state];
                prop_assert!((visits[state] - expected).abs() < 1e-12);
            }
        }
    }
}
