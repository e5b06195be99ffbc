//! An agent that knows the map and tours what pays: the ceiling that a learner may come near. How it chooses is in
//! `rails_policy.rs`.

use super::Agent;
use super::rails_policy::RailsPolicy;
use crate::sim::{Action, Environment};

/// Tours all objects that pay, nearest first by the way around obstacles and surest first where rewards are uncertain,
/// and then goes where the world's success lies.
///
/// It reads the world's state, not its pictures.
#[derive(Clone, Debug, Default)]
pub struct OnRailsAgent {
    policy: RailsPolicy,
}

impl OnRailsAgent {
    /// An agent at the start of its tour.
    pub fn new() -> Self {
        Self::default()
    }

    /// Whether nothing is worth going to.
    pub(crate) fn is_done(environment: &Environment) -> bool {
        RailsPolicy::is_done(environment.sim())
    }
}

impl Agent for OnRailsAgent {
    fn act(&mut self, environment: &Environment) -> Action {
        self.policy.act(environment.sim())
    }

    fn begin(&mut self, _seed: u64) {
        self.policy.begin();
    }

    fn learns(&self) -> bool {
        false
    }

    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        Some(Box::new(self.clone()))
    }
}
