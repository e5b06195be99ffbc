//! The options that say which world a command is about. Reading or drawing it is the library's.

use std::path::PathBuf;

use crate::Failure;
use crate::env::EpisodeOrigin;
use crate::spec::{DEFAULT_VARIANT, World};
use crate::tasks;
use crate::worlds::{WorldRequest, is_world_file};
use clap::Args;

use super::output;

/// Which world a command is about: one of a file, or one drawn from a variant.
#[derive(Args)]
pub(crate) struct WorldChoice {
    /// A world file, or a variant: PATH, PATH#variant, or a built-in such as `find_objects#red`.
    world: String,
    /// Seed for drawing the world from a variant.
    #[arg(long, default_value_t = 0, allow_negative_numbers = true, value_parser = super::numbers::seed)]
    seed: u64,
    /// Index of the world under the seed.
    #[arg(long, default_value_t = 0)]
    index: u64,
    /// Read the world in L2Explorer's format, with warnings.
    #[arg(long)]
    l2explorer: bool,
    /// Use the layouts in this maps file, or folder of them, instead of the built-in maps.
    #[arg(long, value_name = "PATH")]
    maps: Option<PathBuf>,
}

impl WorldChoice {
    /// The name that was given.
    pub(crate) fn name(&self) -> &str {
        &self.world
    }

    /// The same for the library.
    pub(crate) fn request(&self) -> WorldRequest {
        WorldRequest {
            world: self.world.clone(),
            seed: self.seed,
            index: self.index,
            l2explorer: self.l2explorer,
            maps: self.maps.clone(),
        }
    }

    /// What names an episode in this world.
    pub(crate) fn origin(&self) -> EpisodeOrigin {
        let (task, variant) = tasks::split(&self.world);
        let is_drawn = !self.l2explorer && !is_world_file(&self.world);
        // Without a name it is the variant in which every parameter has its default.
        let variant = variant.or(is_drawn.then_some(DEFAULT_VARIANT));
        EpisodeOrigin {
            task: Some(task.to_owned()),
            variant: variant.map(str::to_owned),
            seed: is_drawn.then_some(self.seed),
            index: is_drawn.then_some(self.index),
            ..EpisodeOrigin::default()
        }
    }

    /// Reads or draws the world, with warnings to standard error.
    pub(crate) fn world(&self) -> Result<World, Failure> {
        self.request().world(&|text| output::warning(text))
    }
}
