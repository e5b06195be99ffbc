//! How far apart worlds and variants are, element by element of the decision process, and in which order to meet them.
//!
//! [`variant_distance`] compares two variants of a task by what they declare, [`world_distance`] two concrete worlds by what
//! is in them; both explain themselves part by part. [`DistanceMatrix`] holds all distances among many, [`order`] puts the
//! many into a path. The measures that they are made of stand alone, too. Nothing here draws worlds or pictures.

mod assignment;
mod color;
mod combined;
mod correlation;
mod distribution;
mod error;
mod matrix;
mod nature;
mod occupancy;
mod order;
pub mod picture;
pub mod scalar;

pub use assignment::{Assignment, MAX_ASSIGNED};
pub use color::cie76::cie76;
pub use color::ciede2000::{ciede2000, ciede2000_to_each};
pub use color::hyab::hyab;
pub use color::lab::{Lab, LabTable};
pub use color::measure::ColorMeasure;
pub use color::oklab::{Oklab, oklab_distance};
pub use color::sets::color_sets_distance;
pub use color::srgb::srgb_distance;
pub use combined::variant::variant_distance;
pub use combined::world::{world_distance, world_sets_distance};
pub use combined::{Distance, Part, Weights};
pub use correlation::{
    Correlation, MAX_MANTEL_ITEMS, MAX_RELABELLINGS, MIN_CORRELATED, MantelTest, PairValue, mantel, pearson, ranks,
    spearman,
};
pub use distribution::planar::bures_wasserstein;
pub use distribution::wasserstein::{total_variation, wasserstein_1};
pub use error::SimilarityError;
pub use matrix::{DistanceMatrix, MAX_ITEMS};
pub use nature::Nature;
pub use occupancy::ospa::Ospa;
pub use occupancy::{Classes, Occupancy, hamming_distance, jaccard_distance};
pub use order::{MAX_EXACT, Method, Ordering, order};
