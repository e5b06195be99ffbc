//! [`Recorder`] records an episode while it runs.

use driftworld_spec::World;

use super::{Edit, EpisodeOrigin, Recording};
use crate::sim::{Action, EndedBy, Environment};

/// Records the current episode of an environment.
#[derive(Clone, Debug, Default)]
pub struct Recorder {
    world: Option<World>,
    edits: Vec<Edit>,
    actions: Vec<Action>,
}

impl Recorder {
    /// Starts recording in an environment that may have run before.
    pub fn from_now(environment: &Environment) -> Self {
        let mut recorder = Self::default();
        recorder.begin(environment.state());
        recorder
    }

    /// Begins an episode in this world, to which the environment was reset; discards the previous episode.
    pub fn begin(&mut self, world: World) {
        self.world = Some(world);
        self.edits.clear();
        self.actions.clear();
    }

    /// Records an action that was carried out.
    pub fn step(&mut self, action: Action) {
        self.actions.push(action);
    }

    /// Records a change to the world that an action did not cause.
    pub fn edit(&mut self, environment: &Environment) {
        let (step, world) = (self.num_steps(), environment.state());
        // Of several changes between the same steps, only the last counts.
        self.edits.retain(|edit| edit.step != step);
        self.edits.push(Edit { step, world });
    }

    /// Number of recorded steps.
    pub fn num_steps(&self) -> u32 {
        u32::try_from(self.actions.len()).unwrap_or(u32::MAX)
    }

    /// The episode so far; `ended_by` is the cause of its end.
    pub fn recording(&self, environment: &Environment, ended_by: Option<EndedBy>) -> Recording {
        Recording {
            origin: EpisodeOrigin::default(),
            recorded_by: env!("CARGO_PKG_VERSION").to_owned(),
            world: self.world.clone().unwrap_or_else(|| environment.world().clone()),
            edits: self.edits.clone(),
            actions: self.actions.clone(),
            reward: environment.episode_return(),
            ended_by,
        }
    }
}
