//! [`Mdp`]: a finite deterministic decision process as plain tables.

use crate::SimilarityError;

/// Maximum number of states of an [`Mdp`].
pub const MAX_MDP_STATES: usize = 1 << 24;

/// Largest absolute reward.
const MAX_REWARD: f64 = 1e100;

/// A finite deterministic Markov decision process: the successor and the reward of each action in each state.
///
/// States and actions are numbered from 0. Rewards depend on state and action, in any unit. An episode ends in a state that
/// leads to itself and pays nothing. Memory: 12 bytes for each state and action.
///
/// # Example
/// ```
/// use driftworld_similarity::Mdp;
/// // From 0, action 0 stays and action 1 leads to 1, where every action stays and pays 1.
/// let process = Mdp::new(2, 2, vec![0, 1, 1, 1], vec![0.0, 0.0, 1.0, 1.0])?;
/// assert_eq!((process.successor(0, 1), process.reward(1, 0)), (1, 1.0));
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Mdp {
    states: usize,
    actions: usize,
    successors: Vec<u32>,
    rewards: Vec<f64>,
}

impl Mdp {
    /// `successors` and `rewards`: `(states · actions,)`, state by state, then action by action; rewards within ±1e100.
    ///
    /// # Errors
    /// [`SimilarityError::NoSuchState`] for an invalid successor, [`SimilarityError::BadReward`] for a reward out of range,
    /// [`SimilarityError::Shape`] for more or fewer successors or rewards, or none, [`SimilarityError::TooMany`] above
    /// [`MAX_MDP_STATES`].
    pub fn new(
        states: usize,
        actions: usize,
        successors: Vec<u32>,
        rewards: Vec<f64>,
    ) -> Result<Self, SimilarityError> {
        SimilarityError::check_count(states, MAX_MDP_STATES)?;
        let expected = states.saturating_mul(actions).max(1);
        SimilarityError::check_length("successors of states × actions", successors.len(), expected)?;
        SimilarityError::check_length("rewards of states × actions", rewards.len(), expected)?;
        if let Some(found) = successors.iter().find(|successor| **successor as usize >= states) {
            return Err(no_such_state(*found as usize, states));
        }
        let bad = |reward: &f64| reward.is_nan() || reward.abs() > MAX_REWARD;
        if let Some(index) = rewards.iter().position(bad) {
            return Err(SimilarityError::BadReward {
                place: format!("state {}, action {}", index / actions, index % actions),
                found: rewards[index],
            });
        }
        Ok(Self {
            states,
            actions,
            successors,
            rewards,
        })
    }

    /// Number of states, at least 1.
    pub fn states(&self) -> usize {
        self.states
    }

    /// Number of actions, at least 1.
    pub fn actions(&self) -> usize {
        self.actions
    }

    /// The reward of an action. Panics if the process does not have the state or the action.
    pub fn reward(&self, state: usize, action: usize) -> f64 {
        self.rewards[self.index(state, action)]
    }

    /// The state that an action leads to. Panics if the process does not have the state or the action.
    pub fn successor(&self, state: usize, action: usize) -> u32 {
        self.successors[self.index(state, action)]
    }

    /// The smallest and the largest reward.
    pub(super) fn reward_range(&self) -> (f64, f64) {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let widen = |(low, high): (f64, f64), reward: &f64| (low.min(*reward), high.max(*reward));
        self.rewards.iter().fold(ends, widen)
    }

    fn index(&self, state: usize, action: usize) -> usize {
        assert!(action < self.actions, "the process does not have this action");
        state * self.actions + action
    }
}

pub(super) fn no_such_state(found: usize, states: usize) -> SimilarityError {
    SimilarityError::NoSuchState {
        found,
        most: states.saturating_sub(1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn invalid_processes_are_refused() {
        let message = |states, actions, successors: &[u32], rewards: &[f64]| {
            let result = Mdp::new(states, actions, successors.to_vec(), rewards.to_vec());
            result.unwrap_err().to_string()
        };
        assert_eq!(
            message(2, 1, &[2, 1], &[0.0; 2]),
            "state of a decision process: found 2, expected one of 0 to 1"
        );
        assert_eq!(
            message(2, 1, &[0, 1], &[0.0, f64::NAN]),
            "reward of state 1, action 0: found NaN, expected a number from -1e100 to 1e100"
        );
        assert_eq!(
            message(2, 1, &[0, 1], &[0.0]),
            "rewards of states × actions: found 1 numbers, expected 2"
        );
        assert!(Mdp::new(0, 1, vec![], vec![]).is_err());
        assert!(Mdp::new(1, 0, vec![], vec![]).is_err());
        assert!(Mdp::new(MAX_MDP_STATES + 1, 1, vec![], vec![]).is_err());
    }
}
