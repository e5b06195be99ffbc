//! Fuzz target for network files: an accepted network can act in a small world.

use driftworld_env::{Agent, Environment, NetworkAgent};
use driftworld_spec::World;

use crate::refusal;

/// Number of steps to play.
const STEPS: usize = 2;

/// An accepted network chooses valid actions.
pub(crate) fn check(bytes: &[u8]) {
    let mut agent = match NetworkAgent::parse("a.safetensors", bytes) {
        Ok(agent) => agent,
        Err(error) => return refusal::message(&error.to_string()),
    };
    let mut environment = Environment::new(World::default());
    agent.begin(1);
    for _ in 0..STEPS {
        let action = agent.act(&environment);
        let step = environment.step(action).expect("the network chooses a valid action");
        assert!(step.reward.is_finite());
    }
}
