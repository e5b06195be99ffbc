//! Agents that come with the environment: one acts at random, one knows the map, one follows a script. None learns.

mod on_rails;
mod random;
mod route;
mod script;
mod scripted;
mod steering;

use crate::sim::{Action, Environment, Step};

pub use on_rails::OnRailsAgent;
pub use random::RandomAgent;
pub use scripted::ScriptedAgent;

/// Something that acts in an environment.
pub trait Agent {
    /// The action for the environment's next step.
    fn act(&mut self, environment: &Environment) -> Action;

    /// Told before each episode, with a number that is the episode's own.
    fn begin(&mut self, _seed: u64) {}

    /// Told after each step in which the agent may learn, and never in an evaluation: whoever learns only here is frozen
    /// there.
    fn learn(&mut self, _environment: &Environment, _step: &Step) {}
}
