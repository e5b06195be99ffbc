//! Distances between finite decision processes: by bisimulation, and by single transitions.

mod bisimulation;
mod certain_sums;
mod process;
mod w1;

pub use bisimulation::{Bisimulation, MAX_PAIRS, bisimulation};
pub use process::{MAX_MDP_STATES, Mdp};
pub use w1::w1_mdp;

#[cfg(test)]
mod drawn {
    //! Small random decision processes for property tests.

    use super::Mdp;
    use proptest::prelude::*;

    /// Processes with these numbers of states and actions, and rewards from −2 to 2 in steps of 1/8.
    pub(super) fn process(states: usize, actions: usize) -> impl Strategy<Value = Mdp> {
        let rewards = prop::collection::vec((-16_i8..=16).prop_map(|k| f64::from(k) / 8.0), states * actions);
        (prop::collection::vec(0..states as u32, states * actions), rewards)
            .prop_map(move |(to, rewards)| Mdp::new(states, actions, to, rewards).unwrap())
    }
}
