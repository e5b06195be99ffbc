//! Turns a variant, a seed and an index into a concrete world; interpolates variants, and finds variants at a given distance.

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
#[cfg(test)]
#[path = "../../tests/tier.rs"]
mod tier;

use driftworld_spec::{Variant, World};

pub use at_distance::{Found, Subject, at_distance};
pub use drift::{Drift, Switch, drift};
pub use error::{GeneratorError, WorldId};
pub use sampler::Sampler;
pub use sequence::Sequence;

/// World number `index` of a variant under a seed. To sample many worlds, prepare a [`Sampler`] once.
///
/// # Errors
/// As [`Sampler::world`].
pub fn sample(variant: &Variant, seed: u64, index: u64) -> Result<World, GeneratorError> {
    Sampler::new(variant, seed).world(index)
}
