//! What acts in an environment, and what it may know of its task.

use crate::sim::{Action, Environment, Step};

/// Something that acts in an environment.
pub trait Agent {
    /// The action for the environment's next step.
    fn act(&mut self, environment: &Environment) -> Action;

    /// Called before each episode, with a seed for all random numbers that the agent draws in it.
    ///
    /// Within one run, each evaluation of a world comes with the same seed, so that an agent that has not changed acts
    /// the same again. Learning in that world again comes with another seed. Worlds of the same index under the same
    /// seed come with the same number in all variants of a task.
    fn begin(&mut self, _seed: u64) {}

    /// Called before [`begin`](Self::begin) with the label of the coming task, where the scenario reveals it.
    fn set_task_label(&mut self, _label: &Label) {}

    /// Called after each step in which the agent may learn, and never in an evaluation. An agent that learns only here
    /// is frozen in evaluations.
    fn learn(&mut self, _environment: &Environment, _step: &Step) {}

    /// Whether [`learn`](Self::learn) may change the agent. If not, what it does in an episode depends only on the
    /// label, the seed and what it observes there.
    fn learns(&self) -> bool {
        true
    }

    /// A copy that acts as this agent does now and never learns. Copies run evaluations, one or several at a time. `None`,
    /// the default, for an agent that cannot be copied: it runs its evaluations itself, one after the other.
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
