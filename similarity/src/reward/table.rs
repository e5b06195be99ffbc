//! [`RewardTable`]: what each transition of a finite decision process pays. Comparing two is up to `epic.rs`.

use crate::SimilarityError;

/// Most numbers in a [`RewardTable`]: half a gibibyte.
pub const MAX_REWARDS: usize = 1 << 26;

/// Largest size of a reward: squares of shaped ones stay finite.
pub(super) const LARGEST: f64 = 1e100;

/// Rewards `R(s, a, s')` of a finite decision process, for every state, action and next state, possible or not.
///
/// # Example
/// ```
/// use driftworld_similarity::RewardTable;
/// // Two states, one action: being sent to state 1 pays 1.
/// let table = RewardTable::new(2, 1, vec![0.0, 1.0, 0.0, 1.0])?;
/// assert_eq!(table.reward(0, 0, 1), 1.0);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RewardTable {
    states: usize,
    actions: usize,
    values: Vec<f64>,
}

impl RewardTable {
    /// From `values`: `(states, actions, states)`, next state by next state, then action by action; any unit, each within ±1e100.
    ///
    /// # Errors
    /// [`SimilarityError::Shape`] when there are more or fewer values, or none, [`SimilarityError::TooMany`] above
    /// [`MAX_REWARDS`] values, [`SimilarityError::BadReward`] for one that is not within ±1e100.
    pub fn new(states: usize, actions: usize, values: Vec<f64>) -> Result<Self, SimilarityError> {
        let expected = states.saturating_mul(actions).saturating_mul(states);
        if expected > MAX_REWARDS {
            return Err(SimilarityError::TooMany {
                found: expected,
                limit: MAX_REWARDS,
            });
        }
        if values.len() != expected || expected == 0 {
            return Err(SimilarityError::Shape {
                of: "rewards of states × actions × next states",
                found: values.len(),
                expected: expected.max(1),
            });
        }
        let bad = values.iter().position(|value| !is_reward(*value));
        if let Some(index) = bad {
            let (state, action, next) = (index / states / actions, index / states % actions, index % states);
            return Err(SimilarityError::BadReward {
                place: format!("state {state}, action {action}, next state {next}"),
                found: values[index],
            });
        }
        Ok(Self {
            states,
            actions,
            values,
        })
    }

    /// From a function of state, action and next state.
    ///
    /// # Errors
    /// As [`RewardTable::new`].
    pub fn from_fn(
        states: usize,
        actions: usize,
        reward: impl Fn(usize, usize, usize) -> f64,
    ) -> Result<Self, SimilarityError> {
        if states.saturating_mul(actions).saturating_mul(states) > MAX_REWARDS {
            return Self::new(states, actions, Vec::new());
        }
        let reward = &reward;
        let of_state =
            |state| (0..actions).flat_map(move |action| (0..states).map(move |next| reward(state, action, next)));
        Self::new(states, actions, (0..states).flat_map(of_state).collect())
    }

    /// How many states there are, at least 1.
    pub fn states(&self) -> usize {
        self.states
    }

    /// How many actions there are, at least 1.
    pub fn actions(&self) -> usize {
        self.actions
    }

    /// All rewards: `(states, actions, states)`, the next state running fastest.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// What going from `state` to `next` by `action` pays. Panics where one of them is not in the table.
    pub fn reward(&self, state: usize, action: usize, next: usize) -> f64 {
        assert!(action < self.actions && next < self.states, "a place outside the table");
        self.values[(state * self.actions + action) * self.states + next]
    }

    /// The same reward with potential shaping: `R(s, a, s') + discount · Φ(s') − Φ(s)`, which leaves every optimal policy as it is.
    ///
    /// `potential`: Φ, one number for each state, in the unit of the rewards.
    ///
    /// # Errors
    /// [`SimilarityError::Shape`] for a potential of other than all states, [`SimilarityError::BadReward`] where a sum is not
    /// within ±1e100.
    ///
    /// Source: Ng, Harada and Russell 1999, "Policy invariance under reward transformations".
    pub fn shaped(&self, potential: &[f64], discount: f64) -> Result<Self, SimilarityError> {
        if potential.len() != self.states {
            return Err(SimilarityError::Shape {
                of: "potential",
                found: potential.len(),
                expected: self.states,
            });
        }
        Self::from_fn(self.states, self.actions, |state, action, next| {
            self.reward(state, action, next) + discount * potential[next] - potential[state]
        })
    }
}

/// Whether a number can be a reward.
pub(super) fn is_reward(value: f64) -> bool {
    value.abs() <= LARGEST
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reward_stands_where_its_transition_is() {
        let table = RewardTable::from_fn(3, 2, |s, a, t| (100 * s + 10 * a + t) as f64).unwrap();
        assert_eq!(table.values().len(), 18);
        assert_eq!(table.reward(2, 1, 0), 210.0);
        assert_eq!(table.reward(0, 1, 2), 12.0);
    }

    #[test]
    fn tables_that_are_none_are_refused() {
        let code =
            |states, actions, values: &[f64]| RewardTable::new(states, actions, values.to_vec()).unwrap_err().code();
        assert_eq!(code(1, 2, &[1.0]), "similarity/shape");
        assert_eq!(code(0, 2, &[]), "similarity/shape");
        assert_eq!(code(1 << 20, 1 << 20, &[]), "similarity/too-many");
        let error = RewardTable::new(2, 1, vec![0.0, 1.0, f64::NAN, 1.0]).unwrap_err();
        assert_eq!(
            error.to_string(),
            "reward of state 1, action 0, next state 0: found NaN, expected a number from -1e100 to 1e100"
        );
    }
}
