//! What may be asked of a batch: how many environments, where their worlds come from, when the next episode begins.

use std::num::NonZeroU32;
use std::sync::Arc;

use driftworld_spec::{Modality, World};

use super::depth::DepthForm;
use crate::render::RendererKind;

/// The most environments of one batch.
pub const MAX_ENVS: usize = 65_536;

/// The most bytes that the outputs of one batch may take: 16 GiB.
pub const MAX_BATCH_BYTES: u64 = 16 << 30;

/// Whether to go on: asked before each environment's reset, by several threads.
pub type GoOn<'a> = &'a (dyn Fn() -> bool + Sync);

/// When an environment whose episode has ended starts the next one. Corresponds to Gymnasium's `AutoresetMode`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, strum::EnumString)]
#[strum(serialize_all = "snake_case")]
pub enum Autoreset {
    /// In the next step: its action is ignored, it pays 0, and hands out the first observation.
    #[default]
    NextStep,
    /// In the same step: it hands out the first observation of the next episode, and keeps the last of the old one in
    /// [`Batch::final_outputs`](super::Batch::final_outputs).
    SameStep,
    /// When [`Batch::reset_where_while`](super::Batch::reset_where_while) says so; stepping before is an error.
    Disabled,
}

/// Which episode of which environment a world is wanted for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Episode {
    /// Number of the environment in its batch.
    pub env: usize,
    /// Number of the episode in this environment, from 0.
    pub index: u64,
}

/// Where worlds come from: one for each episode, or the reason why there is none.
///
/// It is called from several threads, in no particular order; worlds should depend on the episode alone.
pub type WorldSource = Arc<dyn Fn(Episode) -> Result<World, String> + Send + Sync>;

/// How a batch runs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BatchOptions {
    /// When episodes that have ended are followed by the next.
    pub autoreset: Autoreset,
    /// Threads that step and draw, never more than there are environments, nor more than four for each processor; 0 is
    /// one for each processor.
    pub num_threads: usize,
    /// What draws: the processor, each environment by itself; or a graphics card, all environments at once.
    pub renderer: RendererKind,
    /// Which images there are; those of the first world if absent. A world that asks for fewer has 0 in the others.
    pub modalities: Option<Vec<Modality>>,
    /// The numbers of depth images.
    pub depth: DepthForm,
    /// A limit of steps beside that of the worlds, which know nothing of it: an episode of so many steps is truncated,
    /// whatever else it is. As Gymnasium's `TimeLimit` does.
    pub max_episode_steps: Option<NonZeroU32>,
}
