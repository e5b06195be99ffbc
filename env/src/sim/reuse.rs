//! Stepping without new memory: for callers that step often. What a step does is in `environment.rs`.

use super::action::Action;
use super::environment::Environment;
use super::event::Step;
use crate::EnvError;

impl Environment {
    /// Whether the action could be carried out now.
    ///
    /// # Errors
    /// Those of [`Environment::step`].
    pub fn check(&self, action: Action) -> Result<(), EnvError> {
        if self.ended() {
            return Err(EnvError::Ended);
        }
        action.numbers(&self.world().agent_params.actions).map(drop)
    }

    /// As [`Environment::step`], into a step whose memory is used again.
    ///
    /// # Errors
    /// Those of [`Environment::step`]; `step` is as it was then.
    pub fn step_into(&mut self, action: Action, step: &mut Step) -> Result<(), EnvError> {
        *step = self.step(action)?;
        Ok(())
    }

    /// Writes the state vector.
    pub fn write_state(&self, state: &mut [f32]) {
        state.copy_from_slice(&self.state_vector());
    }
}

impl Step {
    /// Forgets what happened, and keeps the memory.
    pub fn clear(&mut self) {
        let mut events = std::mem::take(&mut self.events);
        events.clear();
        *self = Self {
            events,
            ..Self::default()
        };
    }
}
