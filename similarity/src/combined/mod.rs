//! Distances of whole variants and whole worlds, made of many parts. The measures that the parts are made of are in their own folders.

mod distance;
pub(crate) mod variant;
pub(crate) mod world;

pub use distance::{Distance, Part, Weights};
