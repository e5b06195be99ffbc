//! [`Mdp`]: a finite decision process as plain tables. Distances and values are in the files beside.

use super::row::Row;
use crate::SimilarityError;
use crate::shares::sum;

/// Most states of an [`Mdp`].
pub const MAX_MDP_STATES: usize = 1 << 24;

/// How far the probabilities of an action may be from a sum of 1; what is left of it is divided out.
const SUM_WITHIN: f64 = 1e-9;

/// Largest size of a reward.
const LARGEST_REWARD: f64 = 1e100;

/// A finite Markov decision process: where each action leads from each state, how likely, and what it pays.
///
/// States and actions are numbered from 0. Rewards are of a state and an action, in any unit; where a reward hangs on the
/// next state, its mean stands here. What ends an episode is a state that leads to itself and pays nothing. Memory: 12 bytes for each
/// successor, 16 for each state and action.
///
/// # Example
/// ```
/// use driftworld_similarity::Mdp;
/// // From 0, action 0 stays and action 1 gets to 1 three times out of four; 1 pays and keeps.
/// let rows = [vec![(0, 1.0)], vec![(0, 0.25), (1, 0.75)], vec![(1, 1.0)], vec![(1, 1.0)]];
/// let process = Mdp::new(2, 2, &rows, vec![0.0, 0.0, 1.0, 1.0])?;
/// assert_eq!(process.successors(0, 1).collect::<Vec<_>>(), [(0, 0.25), (1, 0.75)]);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Mdp {
    states: usize,
    actions: usize,
    /// Where the successors of each state and action begin, and where the last end.
    starts: Vec<usize>,
    successors: Vec<u32>,
    probabilities: Vec<f64>,
    rewards: Vec<f64>,
}

impl Mdp {
    /// From `rows`: `(states · actions,)`, of each state action by action its successors with their probabilities, in any
    /// order; one named twice counts with both. `rewards`: `(states · actions,)` in the same order, any unit, each within
    /// ±1e100.
    ///
    /// # Errors
    /// [`SimilarityError::BadSuccessors`] for a successor that is no state, a probability that is not from 0 to 1, or
    /// probabilities whose sum is not 1 within 1e-9; [`SimilarityError::BadReward`]; [`SimilarityError::Shape`] for more or
    /// fewer rows or rewards, or none; [`SimilarityError::TooMany`] above [`MAX_MDP_STATES`].
    pub fn new(
        states: usize,
        actions: usize,
        rows: &[Vec<(usize, f64)>],
        rewards: Vec<f64>,
    ) -> Result<Self, SimilarityError> {
        check_sizes(states, actions, rows.len(), &rewards)?;
        let mut found = Self {
            states,
            actions,
            starts: vec![0],
            successors: Vec::new(),
            probabilities: Vec::new(),
            rewards,
        };
        let mut sorted = Vec::new();
        for (index, row) in rows.iter().enumerate() {
            check_row(row, states).map_err(|(found, expected)| SimilarityError::BadSuccessors {
                state: index / actions,
                action: index % actions,
                found,
                expected,
            })?;
            sorted.clear();
            sorted.extend(row.iter().filter(|(_, probability)| *probability > 0.0));
            sorted.sort_by_key(|(successor, _)| *successor);
            found.push_row(&sorted);
        }
        Ok(found)
    }

    /// With one successor for each state and action. `successors` and `rewards`: `(states · actions,)`, of each state action by
    /// action.
    ///
    /// # Errors
    /// As [`Mdp::new`].
    pub fn deterministic(
        states: usize,
        actions: usize,
        successors: &[usize],
        rewards: Vec<f64>,
    ) -> Result<Self, SimilarityError> {
        check_sizes(states, actions, successors.len(), &rewards)?;
        if let Some(index) = successors.iter().position(|successor| *successor >= states) {
            let (found, expected) = no_such(successors[index], states);
            return Err(SimilarityError::BadSuccessors {
                state: index / actions,
                action: index % actions,
                found,
                expected,
            });
        }
        Ok(Self {
            states,
            actions,
            starts: (0..=successors.len()).collect(),
            successors: successors.iter().map(|successor| *successor as u32).collect(),
            probabilities: vec![1.0; successors.len()],
            rewards,
        })
    }

    /// How many states there are, at least 1.
    pub fn states(&self) -> usize {
        self.states
    }

    /// How many actions there are, at least 1.
    pub fn actions(&self) -> usize {
        self.actions
    }

    /// What an action pays, on average. Panics where the process does not have the state or the action.
    pub fn reward(&self, state: usize, action: usize) -> f64 {
        self.rewards[self.index(state, action)]
    }

    /// Where an action may lead, by rising number, with probabilities above 0 of sum 1. Panics where the process does not have the
    /// state or the action.
    pub fn successors(&self, state: usize, action: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.row(state, action).iter()
    }

    /// The first state and action with more than one successor, if there is one.
    pub fn first_uncertain(&self) -> Option<(usize, usize)> {
        let index = self.starts.windows(2).position(|ends| ends[1] - ends[0] > 1)?;
        Some((index / self.actions, index % self.actions))
    }

    /// The least and the largest reward.
    pub(super) fn reward_range(&self) -> (f64, f64) {
        let ends = (f64::INFINITY, f64::NEG_INFINITY);
        let widen = |(low, high): (f64, f64), reward: &f64| (low.min(*reward), high.max(*reward));
        self.rewards.iter().fold(ends, widen)
    }

    /// The successors of a state and an action.
    pub(super) fn row(&self, state: usize, action: usize) -> Row<'_> {
        let index = self.index(state, action);
        let places = self.starts[index]..self.starts[index + 1];
        Row::new(&self.successors[places.clone()], &self.probabilities[places])
    }

    fn index(&self, state: usize, action: usize) -> usize {
        assert!(action < self.actions, "an action that the process does not have");
        state * self.actions + action
    }

    /// Adds sorted successors, equal ones as one, with probabilities of sum 1.
    fn push_row(&mut self, sorted: &[(usize, f64)]) {
        let whole = sum(sorted.iter().map(|(_, probability)| *probability));
        for equal in sorted.chunk_by(|a, b| a.0 == b.0) {
            self.successors.push(equal[0].0 as u32);
            self.probabilities
                .push(sum(equal.iter().map(|(_, probability)| *probability)) / whole);
        }
        self.starts.push(self.successors.len());
    }
}

fn check_sizes(states: usize, actions: usize, rows: usize, rewards: &[f64]) -> Result<(), SimilarityError> {
    if states > MAX_MDP_STATES {
        return Err(SimilarityError::TooMany {
            found: states,
            limit: MAX_MDP_STATES,
        });
    }
    let expected = states.saturating_mul(actions).max(1);
    for (of, found) in [
        ("successors of states × actions", rows),
        ("rewards of states × actions", rewards.len()),
    ] {
        if found != expected || states == 0 || actions == 0 {
            return Err(SimilarityError::Shape { of, found, expected });
        }
    }
    match rewards
        .iter()
        .position(|reward| reward.is_nan() || reward.abs() > LARGEST_REWARD)
    {
        Some(index) => Err(SimilarityError::BadReward {
            place: format!("state {}, action {}", index / actions, index % actions),
            found: rewards[index],
        }),
        None => Ok(()),
    }
}

/// What is wrong with a row, and what would do.
fn check_row(row: &[(usize, f64)], states: usize) -> Result<(), (String, String)> {
    for &(successor, probability) in row {
        if successor >= states {
            return Err(no_such(successor, states));
        }
        if !(0.0..=1.0 + SUM_WITHIN).contains(&probability) {
            let found = format!("the probability {probability} of state {successor}");
            return Err((found, "a number from 0 to 1".into()));
        }
    }
    let whole = sum(row.iter().map(|(_, probability)| *probability));
    if (whole - 1.0).abs() > SUM_WITHIN {
        return Err((
            format!("probabilities of sum {whole}"),
            "a sum of 1; divide each by the sum".into(),
        ));
    }
    Ok(())
}

fn no_such(successor: usize, states: usize) -> (String, String) {
    (format!("state {successor}"), format!("one of 0 to {}", states - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_sorted_merged_and_brought_to_a_sum_of_1() {
        let rows = [
            vec![(2, 0.5), (0, 0.25), (1, 0.0), (2, 0.25 + 1e-10)],
            vec![(1, 1.0)],
            vec![(0, 1.0)],
        ];
        let process = Mdp::new(3, 1, &rows, vec![0.0; 3]).unwrap();
        let found: Vec<(usize, f64)> = process.successors(0, 0).collect();
        assert_eq!(found.iter().map(|(to, _)| *to).collect::<Vec<_>>(), [0, 2]);
        assert!((found[1].1 - 0.75).abs() < 1e-9);
        assert!((found[0].1 + found[1].1 - 1.0).abs() < 1e-15);
        assert_eq!(process.first_uncertain(), Some((0, 0)));
        let rows = [vec![(2, 0.5), (2, 0.5)], vec![(1, 1.0)], vec![(0, 1.0)]];
        let process = Mdp::new(3, 1, &rows, vec![0.0; 3]).unwrap();
        assert_eq!(process, Mdp::deterministic(3, 1, &[2, 1, 0], vec![0.0; 3]).unwrap());
        assert_eq!(process.first_uncertain(), None);
    }

    #[test]
    fn what_is_no_process_is_refused() {
        let said = |rows: &[Vec<(usize, f64)>], rewards: &[f64]| {
            Mdp::new(2, 1, rows, rewards.to_vec()).unwrap_err().to_string()
        };
        let stay = [vec![(0, 1.0)], vec![(1, 1.0)]];
        assert_eq!(
            said(&[vec![(0, 1.0)], vec![(1, 0.5)]], &[0.0; 2]),
            "successors of state 1, action 0: found probabilities of sum 0.5, expected a sum of 1; divide each by the sum"
        );
        assert_eq!(
            said(&[vec![(2, 1.0)], vec![(1, 1.0)]], &[0.0; 2]),
            "successors of state 0, action 0: found state 2, expected one of 0 to 1"
        );
        assert_eq!(
            said(&[vec![(0, 2.0), (1, -1.0)], vec![(1, 1.0)]], &[0.0; 2]),
            "successors of state 0, action 0: found the probability 2 of state 0, expected a number from 0 to 1"
        );
        assert_eq!(
            said(&stay, &[0.0, f64::NAN]),
            "reward of state 1, action 0: found NaN, expected a number from -1e100 to 1e100"
        );
        assert_eq!(
            said(&stay, &[0.0]),
            "rewards of states × actions: found 1 numbers, expected 2"
        );
        assert!(Mdp::deterministic(0, 1, &[], vec![]).is_err());
        assert!(Mdp::deterministic(1, 0, &[], vec![]).is_err());
        assert!(Mdp::deterministic(1, 1, &[1], vec![0.0]).is_err());
        assert!(Mdp::deterministic(MAX_MDP_STATES + 1, 1, &[], vec![]).is_err());
    }
}
