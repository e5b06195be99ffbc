//! Distances of whole variants and whole worlds, made of many parts. The measures that the parts are made of are in their own folders.

mod distance;
mod drawn;
mod parts;
mod sketch;
mod value;
pub(crate) mod variant;
pub(crate) mod world;

pub use distance::{Distance, MAX_WEIGHT, Part, Weights};
