//! [`Replay`] runs a recorded episode again and compares the results.

use super::Recording;
use crate::EnvError;
use crate::assets::Catalogue;
use crate::sim::{EndedBy, Environment, Step};

/// A replay in progress.
pub struct Replay<'a> {
    recording: &'a Recording,
    environment: Environment,
    /// Number of steps so far, and number of recorded edits applied so far.
    steps: usize,
    edits: usize,
    /// The cause of the end, if it has ended.
    ended_by: Option<EndedBy>,
}

impl<'a> Replay<'a> {
    /// An episode at its start; `catalogue` should be the one with which it was recorded.
    pub fn new(recording: &'a Recording, catalogue: &Catalogue) -> Self {
        let mut replay = Self {
            recording,
            environment: Environment::with_catalogue(recording.world.clone(), catalogue.clone()),
            steps: 0,
            edits: 0,
            ended_by: None,
        };
        replay.edit();
        replay
    }

    /// Restarts the episode.
    pub fn restart(&mut self) {
        self.environment.reset(self.recording.world.clone());
        (self.steps, self.edits, self.ended_by) = (0, 0, None);
        self.edit();
    }

    /// The environment in its current state, for inspection.
    pub fn environment(&mut self) -> &mut Environment {
        &mut self.environment
    }

    /// Number of steps so far.
    pub fn num_steps(&self) -> usize {
        self.steps
    }

    /// Takes the next step; `None` after the last.
    ///
    /// # Errors
    /// [`EnvError::Replay`] if the action cannot be carried out.
    pub fn step(&mut self) -> Result<Option<Step>, EnvError> {
        let Some(action) = self.recording.actions.get(self.steps) else {
            return Ok(None);
        };
        let step = self.environment.step(*action).map_err(|error| {
            let step = self.steps;
            self.differs("step", format!("{step}: {error}"), "a step that succeeds".to_owned())
        })?;
        self.steps += 1;
        self.ended_by = step.ended_by;
        self.edit();
        Ok(Some(step))
    }

    /// After the last step, checks that the reward and the end match the recording.
    ///
    /// # Errors
    /// [`EnvError::Replay`] if they differ.
    pub fn check(&self) -> Result<(), EnvError> {
        let (found, expected) = (self.environment.episode_return(), self.recording.reward);
        if found.to_bits() != expected.to_bits() {
            return Err(self.differs("reward", found.to_string(), expected.to_string()));
        }
        let (found, expected) = (self.ended_by, self.recording.ended_by);
        // The step limit of the recording may not have been part of the world.
        if found != expected && (found, expected) != (None, Some(EndedBy::Steps)) {
            let word = |ended_by: Option<EndedBy>| ended_by.map_or("nothing", EndedBy::word).to_owned();
            return Err(self.differs("ended_by", word(found), word(expected)));
        }
        Ok(())
    }

    /// Applies the recorded edits before the next step.
    fn edit(&mut self) {
        while let Some(edit) = self.recording.edits.get(self.edits)
            && edit.step as usize == self.steps
        {
            self.environment.reset(edit.world.clone());
            self.edits += 1;
        }
    }

    fn differs(&self, what: &'static str, found: String, expected: String) -> EnvError {
        EnvError::Replay {
            experience: self.recording.origin.experience,
            what,
            found,
            expected,
            recorded_by: self.recording.recorded_by.clone(),
            now: env!("CARGO_PKG_VERSION"),
        }
    }
}
