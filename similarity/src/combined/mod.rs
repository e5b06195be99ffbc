//! Distances between whole variants and whole worlds, combined from many parts.

mod arena;
mod drawn;
mod kinds;
mod leaves;
mod matching;
mod parts;
mod read;
mod sketch;
mod value;
pub(crate) mod variant;
mod weighted_distance;
mod weights;
pub(crate) mod world;

pub use weighted_distance::{Distance, Part};
pub use weights::{MAX_WEIGHT, Weights};
pub(crate) use world::match_objects;
