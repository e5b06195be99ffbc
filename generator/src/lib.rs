//! Variant, seed and index to a concrete world.

mod compiled;
mod coverage;
mod crowd;
mod draw;
mod error;
mod philox;
mod placement;
mod regions;
mod sampler;
mod stream;

use driftworld_spec::{Variant, World};

pub use coverage::Coverage;
pub use error::GeneratorError;
pub use sampler::Sampler;

/// World number `index` of a variant under a seed. Who draws many prepares a [`Sampler`] once.
///
/// # Errors
/// As [`Sampler::world`].
pub fn sample(variant: &Variant, seed: u64, index: u64) -> Result<World, GeneratorError> {
    Sampler::new(variant, seed).world(index)
}
