//! [`Recording`]: an episode's initial world and actions, from which it can be replayed and rendered.

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

/// Identifies a recorded episode; unknown fields are `None`.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct EpisodeOrigin {
    /// Index of the experience within the whole lifetime, as in the log; without a lifetime, the episode's index in its file.
    /// From 0.
    pub experience: u64,
    /// Its block, from 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub block: Option<u64>,
    /// The task.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub task: Option<String>,
    /// The variant; during a drift, its start and end variants, as in the log's summary.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub variant: Option<String>,
    /// The seed of its world.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// The index of its world under the seed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub index: Option<u64>,
}

/// A change to the world during an episode that its own rules did not cause.
#[derive(Clone, Debug, PartialEq)]
pub struct Edit {
    /// Number of steps before the change.
    pub step: u32,
    /// The world after the change ([`Environment::state`](crate::Environment::state)).
    pub world: World,
}

/// A whole or partial episode.
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
    /// The episode's identity.
    pub origin: EpisodeOrigin,
    /// The version of Driftworld that recorded it.
    pub recorded_by: String,
    /// The initial world.
    pub world: World,
    /// Changes to the world, in the order of their steps.
    pub edits: Vec<Edit>,
    /// The action of each step.
    pub actions: Vec<Action>,
    /// The sum of rewards, including those that the initial world had already paid, if it was saved during an episode.
    pub reward: f64,
    /// The cause of the end, if the episode has ended.
    pub ended_by: Option<EndedBy>,
}

impl Recording {
    /// Duration of one action in seconds of simulated time.
    pub fn seconds_per_step(&self) -> f64 {
        let agent = &self.world.agent_params;
        agent.time_step * f64::from(agent.frame_skip.max(1))
    }
}
