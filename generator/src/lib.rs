//! Variant, seed and index to a concrete world; the variants between two variants, and those at a wanted distance.

mod at_distance;
mod cells;
mod clearance;
mod compiled;
mod draw;
mod drift;
mod error;
mod interpolation;
mod placement;
mod sampler;
mod sequence;
mod spatial_hash;
mod stream;

use driftworld_spec::{Variant, World};

pub use at_distance::{Found, Subject, at_distance};
pub use drift::{Drift, Switch, drift};
pub use error::{GeneratorError, WorldId};
pub use sampler::Sampler;
pub use sequence::Sequence;

/// World number `index` of a variant under a seed. Who draws many prepares a [`Sampler`] once.
///
/// # Errors
/// As [`Sampler::world`].
pub fn sample(variant: &Variant, seed: u64, index: u64) -> Result<World, GeneratorError> {
    Sampler::new(variant, seed).world(index)
}
