//! Options of a batch: its limits, the source of its worlds, and when the next episode begins.

use std::num::NonZeroU32;
use std::sync::Arc;

use driftworld_spec::{Modality, World};

use crate::render::{DepthForm, RendererKind};

/// Maximum number of environments in one batch.
pub const MAX_ENVS: usize = 65_536;

/// Maximum size of the outputs of one batch in bytes: 16 GiB.
pub const MAX_BATCH_BYTES: u64 = 16 << 30;

/// Whether to continue. Called before each environment's reset, from several threads.
pub type GoOn<'a> = &'a (dyn Fn() -> bool + Sync);

/// When an environment whose episode has ended starts the next one. Corresponds to Gymnasium's `AutoresetMode`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, strum::EnumString)]
#[strum(serialize_all = "snake_case")]
pub enum Autoreset {
    /// In the next step: its action is ignored, its reward is 0, and it returns the first observation.
    #[default]
    NextStep,
    /// In the same step: it returns the first observation of the next episode, and
    /// [`Batch::final_outputs`](super::Batch::final_outputs) keeps the last observation of the old one.
    SameStep,
    /// Only by a call to [`Batch::reset_where_while`](super::Batch::reset_where_while) or
    /// [`Batch::reset`](super::Batch::reset); stepping before that is an error.
    Disabled,
}

/// The episode and environment for which a world is requested.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Episode {
    /// Index of the environment in its batch.
    pub env: usize,
    /// Index of the episode in this environment, from 0.
    pub index: u64,
}

/// Source of worlds: returns the world of an episode, or the reason why there is none.
///
/// Called from several threads, in no particular order; worlds should depend only on the episode.
pub type WorldSource = Arc<dyn Fn(Episode) -> Result<World, String> + Send + Sync>;

/// How a batch runs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BatchOptions {
    /// When the next episode starts after one has ended.
    pub autoreset: Autoreset,
    /// Threads for stepping and drawing, at most one per environment and four per processor; 0 means one per processor.
    pub num_threads: usize,
    /// The renderer: the CPU draws environments one by one, a GPU draws them all at once.
    pub renderer: RendererKind,
    /// Modalities of the images; by default those of the first world. Modalities that a world does not request are 0
    /// everywhere.
    pub modalities: Option<Vec<Modality>>,
    /// The number format of depth images.
    pub depth: DepthForm,
    /// A step limit in addition to the worlds' own. An episode is truncated after this many steps, as by Gymnasium's
    /// `TimeLimit`.
    pub max_episode_steps: Option<NonZeroU32>,
}
