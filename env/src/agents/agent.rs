//! [`Agent`], the interface of agents, and [`Label`], the task label that they may see.

use super::steering::in_space;
use crate::sim::{Action, Environment, Step};

/// Something that acts in an environment.
pub trait Agent {
    /// The action for the environment's next step.
    fn act(&mut self, environment: &Environment) -> Action;

    /// Called before each episode, with a seed for all random numbers that the agent draws in it.
    ///
    /// Within a run, every evaluation of a world gets the same seed, so that an unchanged agent acts the same way again.
    /// Learning in that world again gets a different seed. Worlds with the same index and seed get the same agent seed in all
    /// variants of a task.
    fn begin(&mut self, _seed: u64) {}

    /// Called before [`begin`](Self::begin) with the label of the next task, if the scenario reveals it.
    fn set_task_label(&mut self, _label: &Label) {}

    /// Called after each step in which the agent may learn, never in an evaluation. So an agent that learns only here does not
    /// change during evaluations.
    fn learn(&mut self, _environment: &Environment, _step: &Step) {}

    /// Whether [`learn`](Self::learn) may change the agent. If not, its behaviour in an episode depends only on the label, the
    /// seed and its observations.
    fn learns(&self) -> bool {
        true
    }

    /// A copy that acts as this agent does now and never learns. Copies run evaluations, possibly several at a time. `None`,
    /// the default, means that the agent cannot be copied; it then runs its own evaluations one after another.
    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        None
    }
}

/// A task's label, for agents that may know it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Label {
    /// The name, as `task#variant`.
    pub name: String,
    /// Its index among the names of the lifetime, from 0 in order of first appearance.
    pub number: usize,
    /// Number of names in the lifetime: the length of a one-hot vector.
    pub of: usize,
    /// Whether the label is part of the observation; otherwise it is given separately from the observation.
    pub observed: bool,
}

impl Environment {
    /// The action of this world that is nearest to a speed in m/s, a clockwise turn rate in °/s, and whether to interact.
    pub fn action_near(&self, speed: f64, turn: f64, interact: bool) -> Action {
        in_space([speed, turn, if interact { 1.0 } else { 0.0 }], self.sim())
    }
}
