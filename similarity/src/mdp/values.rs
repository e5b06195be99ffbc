//! What can be earned from each state of a decision process. How far apart two are is in the files beside.

use super::certain_sums::CertainSums;
use super::process::Mdp;
use super::{check_discount, check_tolerance};
use crate::SimilarityError;

impl Mdp {
    /// The most that can be earned from each state: `V*(s) = maxₐ R(s, a) + γ Σ P(s' | s, a) V*(s')`.
    ///
    /// `discount`: γ, 0 to 0.9999. `tolerance`: above 0, in the unit of the rewards; each value is within it, unless rounding
    /// (some 1e-15 of the largest value, over `1 − γ`) does not allow that. Returns `(states,)`, of the unit of the rewards,
    /// within `± largest reward / (1 − γ)`. By value iteration, whose error shrinks by γ each round; by policy iteration where
    /// each action has one successor.
    ///
    /// Source: Puterman 1994, "Markov decision processes", sections 6.3 and 6.4.
    ///
    /// # Errors
    /// [`SimilarityError::BadNumber`] for a discount or a tolerance that is none.
    ///
    /// # Example
    /// ```
    /// let process = driftworld_similarity::Mdp::deterministic(2, 1, &[1, 1], vec![0.0, 1.0])?;
    /// let values = process.optimal_values(0.5, 1e-12)?;
    /// assert!((values[0] - 1.0).abs() < 1e-12 && (values[1] - 2.0).abs() < 1e-12);
    /// # Ok::<(), driftworld_similarity::SimilarityError>(())
    /// ```
    pub fn optimal_values(&self, discount: f64, tolerance: f64) -> Result<Vec<f64>, SimilarityError> {
        check_discount(discount)?;
        check_tolerance(tolerance)?;
        let pairs = (0..self.states()).flat_map(|state| (0..self.actions()).map(move |action| (state, action)));
        if self.first_uncertain().is_some() {
            return Ok(self.iterated(discount, tolerance));
        }
        let next: Vec<u32> = pairs
            .clone()
            .map(|(state, action)| self.row(state, action).only())
            .collect();
        let costs: Vec<f64> = pairs.map(|(state, action)| self.reward(state, action)).collect();
        let sums = CertainSums {
            steps: self.actions(),
            next: &next,
            costs: &costs,
            discount,
        };
        Ok(sums.solve().0)
    }

    fn iterated(&self, discount: f64, tolerance: f64) -> Vec<f64> {
        let mut values = vec![0.0; self.states()];
        loop {
            let (mut change, mut largest) = (0.0_f64, 0.0_f64);
            // In place: what a state before has become counts at once, and each round is a contraction still.
            for state in 0..self.states() {
                let earned = |action| {
                    let later: f64 = self.row(state, action).iter().map(|(next, p)| p * values[next]).sum();
                    self.reward(state, action) + discount * later
                };
                let best = (0..self.actions()).map(earned).fold(f64::NEG_INFINITY, f64::max);
                change = change.max((best - values[state]).abs());
                largest = largest.max(best.abs());
                values[state] = best;
            }
            if discount / (1.0 - discount) * change <= tolerance || change <= 8.0 * f64::EPSILON * largest {
                return values;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::drawn::{certain, process};
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_risk_is_worth_its_mean() {
        // Take 1 now, or have a half of 4 for ever after.
        let rows = [
            vec![(1, 1.0)],
            vec![(1, 0.5), (2, 0.5)],
            vec![(1, 1.0)],
            vec![(1, 1.0)],
            vec![(2, 1.0)],
            vec![(2, 1.0)],
        ];
        let process = Mdp::new(3, 2, &rows, vec![1.0, 0.0, 0.0, 0.0, 4.0, 4.0]).unwrap();
        let values = process.optimal_values(0.5, 1e-13).unwrap();
        for (found, expected) in values.into_iter().zip([2.0, 0.0, 8.0]) {
            assert!((found - expected).abs() < 1e-12, "{found}, expected {expected}");
        }
    }

    #[test]
    fn settings_that_are_none_are_refused() {
        let process = Mdp::deterministic(1, 1, &[0], vec![1.0]).unwrap();
        for (discount, tolerance) in [(1.0, 1e-9), (-0.1, 1e-9), (0.5, 0.0), (0.5, f64::NAN)] {
            let error = process.optimal_values(discount, tolerance).unwrap_err();
            assert_eq!(error.code(), "similarity/bad-number");
        }
    }

    proptest! {
        #[test]
        fn no_action_earns_more(process in process(5, 3), discount in 0.0..0.9) {
            let values = process.optimal_values(discount, 1e-11).unwrap();
            for (state, value) in values.iter().enumerate() {
                let earned = (0..3).map(|action| {
                    let later: f64 = process.successors(state, action).map(|(next, p)| p * values[next]).sum();
                    process.reward(state, action) + discount * later
                });
                prop_assert!((earned.fold(f64::NEG_INFINITY, f64::max) - value).abs() < 1e-10);
            }
        }

        #[test]
        fn both_ways_find_the_same(process in certain(7, 3), discount in 0.0..0.95) {
            let values = process.optimal_values(discount, 1e-10).unwrap();
            for (found, expected) in values.iter().zip(process.iterated(discount, 1e-11)) {
                prop_assert!((found - expected).abs() < 1e-10);
            }
        }
    }
}
