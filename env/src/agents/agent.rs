//! What acts in an environment, and what it may know of its task.

use crate::sim::{Action, Environment, Step};

/// Something that acts in an environment.
pub trait Agent {
    /// The action for the environment's next step.
    fn act(&mut self, environment: &Environment) -> Action;

    /// Told before each episode, with a seed for all that it draws in it.
    ///
    /// In a lifetime, every evaluation of the same world comes with the same number, so that an agent that has not changed acts
    /// alike in it; what is learned in the same world again comes with another. The worlds of one number under one seed
    /// come with one number in all variants of a task.
    fn begin(&mut self, _seed: u64) {}

    /// Told before [`begin`](Self::begin) what the coming task is called, where the scenario lets the agent know.
    fn told(&mut self, _label: &Label) {}

    /// Told after each step in which the agent may learn, and never in an evaluation: whoever learns only here is frozen
    /// there.
    fn learn(&mut self, _environment: &Environment, _step: &Step) {}

    /// Whether it may change by what it is told in [`learn`](Self::learn). One that does not acts in an episode by what it was
    /// told before it and sees in it alone.
    fn learns(&self) -> bool {
        true
    }

    /// A copy that acts in any episode as this agent does now, and is never told to learn. Copies live episodes at the same
    /// time. `None`, the default, for an agent that cannot be copied: its episodes are lived one after the other.
    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        None
    }
}

/// What a task is called, for agents that may know it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The name, as `task#variant`.
    pub name: String,
    /// Its number among the names of the lifetime, from 0 in the order in which they first come.
    pub number: usize,
    /// How many names the lifetime has: the width of the number as a one-hot vector.
    pub of: usize,
    /// Whether it is a part of what is observed; else it is known beside the observation.
    pub observed: bool,
}
