//! [`Recording`]: an episode as the world that it began in and the actions that were carried out, so that it can be run, and drawn, once
//! more. How it is written down is in `lines.rs`, how it is read in `reader.rs`, how it is run in `replay.rs`; files are the callers'.

mod lines;
mod packed;
mod reader;
mod recorder;
mod replay;

use driftworld_spec::World;
use serde::{Deserialize, Serialize};

pub use lines::{RECORDING_FORMAT, RecordingLines};
pub use packed::MAX_RECORDED_STEPS;
pub use reader::{MAX_RECORDING_LINE, RecordedEpisode, RecordingMark, RecordingReader};
pub use recorder::Recorder;
pub use replay::Replay;

use crate::sim::{Action, EndedBy};

/// Which episode a recording is of: what names it, where it has names.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct EpisodeOrigin {
    /// The number of the experience over the whole lifetime, as the log has it; else of the episode in its file, from 0.
    pub experience: u64,
    /// Its block, from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub block: Option<u64>,
    /// The task.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub task: Option<String>,
    /// The variant; in a drift both ends, as in the log's summary.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variant: Option<String>,
    /// The seed of its world.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// The number of its world under the seed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub index: Option<u64>,
}

/// What was changed from outside while an episode ran.
#[derive(Clone, Debug, PartialEq)]
pub struct Edit {
    /// How many steps had been made.
    pub step: u32,
    /// The world as it was then ([`Environment::state`](crate::Environment::state)).
    pub world: World,
}

/// An episode, or the beginning of one.
///
/// # Example
/// ```
/// use driftworld_env::{Action, Catalogue, Environment, Recorder, Replay};
/// use driftworld_spec::World;
/// let world = World::default();
/// let (mut environment, mut recorder) = (Environment::new(world.clone()), Recorder::default());
/// recorder.begin(world);
/// let action = Action::Continuous([10.0, 90.0, 0.0]);
/// environment.step(action)?;
/// recorder.step(action);
/// let recording = recorder.recording(&environment, None);
/// let mut replay = Replay::new(&recording, &Catalogue::default());
/// while replay.step()?.is_some() {}
/// replay.check()?;
/// assert_eq!(replay.environment().agent(), environment.agent());
/// # Ok::<(), driftworld_env::EnvError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// Which episode it is.
    pub origin: EpisodeOrigin,
    /// The version of Driftworld that recorded it.
    pub recorded_by: String,
    /// The world that it began in.
    pub world: World,
    /// Changes from outside, in the order of their steps.
    pub edits: Vec<Edit>,
    /// What was done in each step.
    pub actions: Vec<Action>,
    /// The sum of the rewards of its steps; with that of the world at the beginning where that had run before.
    pub reward: f64,
    /// What ended it, if anything did.
    pub ended_by: Option<EndedBy>,
}

impl Recording {
    /// Steps of the world's own time that one action is held for, and their seconds.
    pub fn seconds_per_step(&self) -> f64 {
        let agent = &self.world.agent_params;
        agent.time_step * f64::from(agent.frame_skip.max(1))
    }
}
