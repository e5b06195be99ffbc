//! How far apart finite decision processes are: by bisimulation, by where each action leads, by values. How a world becomes one is
//! known elsewhere.

mod bisimulation;
mod certain_sums;
mod paired;
mod process;
mod row;
mod state_distances;
mod values;
mod visits;
mod w1;

pub use bisimulation::{MAX_STATE_PAIRS, bisimulation};
pub use paired::{MAX_PAIRS, PairedBisimulation, paired_bisimulation};
pub use process::{MAX_MDP_STATES, Mdp};
pub use state_distances::{BestMatch, StateDistances};
pub use w1::{w1_mdp, w1_mdp_by_state, w1_mdp_pooled};

use crate::SimilarityError;

/// Refuses processes that do not have as many of something.
fn check_equal(what: &'static str, a: usize, b: usize) -> Result<(), SimilarityError> {
    if a == b {
        return Ok(());
    }
    Err(SimilarityError::SizesDiffer {
        of: "decision processes",
        what,
        a,
        b,
    })
}

/// Refuses a share of the future with which sums would not end.
fn check_discount(found: f64) -> Result<(), SimilarityError> {
    if (0.0..=0.9999).contains(&found) {
        return Ok(());
    }
    Err(SimilarityError::BadNumber {
        of: "discount",
        found,
        expected: "a number from 0 to 0.9999",
    })
}

/// Refuses a tolerance that says nothing.
fn check_tolerance(found: f64) -> Result<(), SimilarityError> {
    if found > 0.0 && found.is_finite() {
        return Ok(());
    }
    Err(SimilarityError::BadNumber {
        of: "tolerance",
        found,
        expected: "a finite number above 0",
    })
}

#[cfg(test)]
mod drawn {
    //! Small decision processes for the laws.

    use super::Mdp;
    use proptest::prelude::*;

    /// So many states and actions, up to 3 successors each, rewards of −2 to 2 in eighths.
    pub(super) fn process(states: usize, actions: usize) -> impl Strategy<Value = Mdp> {
        let row = prop::collection::vec((0..states, 1_u8..9), 1..4);
        let rewards = prop::collection::vec((-16_i8..=16).prop_map(|k| f64::from(k) / 8.0), states * actions);
        (prop::collection::vec(row, states * actions), rewards).prop_map(move |(rows, rewards)| {
            let rows: Vec<Vec<(usize, f64)>> = rows
                .iter()
                .map(|row| {
                    let sum: f64 = row.iter().map(|(_, weight)| f64::from(*weight)).sum();
                    row.iter().map(|&(to, weight)| (to, f64::from(weight) / sum)).collect()
                })
                .collect();
            Mdp::new(states, actions, &rows, rewards).unwrap()
        })
    }

    /// The same with one successor each.
    pub(super) fn certain(states: usize, actions: usize) -> impl Strategy<Value = Mdp> {
        let rewards = prop::collection::vec((-16_i8..=16).prop_map(|k| f64::from(k) / 8.0), states * actions);
        (prop::collection::vec(0..states, states * actions), rewards)
            .prop_map(move |(to, rewards)| Mdp::deterministic(states, actions, &to, rewards).unwrap())
    }

    /// With states under other names: state `s` becomes `names[s]`.
    pub(super) fn renamed(process: &Mdp, names: &[usize]) -> Mdp {
        let mut places: Vec<usize> = (0..names.len()).collect();
        places.sort_by_key(|place| names[*place]);
        let of_all = |state: usize| (0..process.actions()).map(move |action| (state, action));
        let pairs: Vec<(usize, usize)> = places.iter().copied().flat_map(of_all).collect();
        let row = |&(state, action): &(usize, usize)| {
            process
                .successors(state, action)
                .map(|(to, p)| (names[to], p))
                .collect()
        };
        let rows: Vec<Vec<(usize, f64)>> = pairs.iter().map(row).collect();
        let rewards = pairs
            .iter()
            .map(|&(state, action)| process.reward(state, action))
            .collect();
        Mdp::new(names.len(), process.actions(), &rows, rewards).unwrap()
    }

    /// With every reward times a factor, plus a number.
    pub(super) fn paying(process: &Mdp, times: f64, by: f64) -> Mdp {
        let of_all = |state| (0..process.actions()).map(move |action| (state, action));
        let pairs: Vec<(usize, usize)> = (0..process.states()).flat_map(of_all).collect();
        let rows: Vec<Vec<(usize, f64)>> = pairs.iter().map(|&(s, k)| process.successors(s, k).collect()).collect();
        let rewards = pairs.iter().map(|&(s, k)| process.reward(s, k) * times + by).collect();
        Mdp::new(process.states(), process.actions(), &rows, rewards).unwrap()
    }
}
