//! Distances between worlds and between variants, element by element of the decision process, and orders to learn them in.
//!
//! [`variant_distance`] compares two variants of a task by what they declare, [`world_distance`] two concrete worlds; both list
//! the parts of their result. [`DistanceMatrix`] holds all distances among many items, [`order`] sorts the items into a path.
//! The underlying measures can be used on their own. [`RewardSamples`] compares rewards up to shaping, [`bisimulation`] and
//! [`w1_mdp`] compare finite decision processes by rewards and transitions.

mod assignment;
mod color;
mod combined;
mod correlation;
pub mod distribution;
mod error;
mod layout_shape;
mod matrix;
mod mdp;
mod metric_properties;
mod occupancy;
mod order;
pub mod picture;
mod reward;
pub mod scalar;
mod split_mix;
mod sum;
#[cfg(test)]
#[path = "../../tests/tier.rs"]
mod tier;
mod transport;
mod world_measures;

pub use assignment::{Assignment, MAX_ASSIGNED};
pub use color::cie76::cie76;
pub use color::ciede2000::ciede2000;
pub use color::hyab::hyab;
pub use color::lab::Lab;
pub use color::measure::ColorMeasure;
pub use color::sets::color_sets_distance;
pub use color::srgb::srgb_distance;
pub use combined::variant::{VariantMeasure, variant_distance};
pub use combined::world::{Worlds, world_distance, world_sets_distance};
pub use combined::{Distance, MAX_WEIGHT, Part, Weights};
pub use correlation::{
    Correlation, MAX_MANTEL_ITEMS, MAX_RELABELLINGS, MIN_CORRELATED, MantelTest, PairValue, mantel, pearson, ranks,
    spearman,
};
pub use driftworld_spec::Oklab;
pub use error::SimilarityError;
pub use layout_shape::LayoutShape;
pub use matrix::{DistanceMatrix, MAX_DISTANCE, MAX_ITEMS, PlanarMap, classical_map};
pub use mdp::{Bisimulation, MAX_MDP_STATES, MAX_PAIRS, Mdp, bisimulation, w1_mdp};
pub use metric_properties::MetricProperties;
use occupancy::Raster;
pub use occupancy::{
    BitGrid, Grid, GridShape, MAX_CELLS, grid_chamfer_distance, grid_earth_movers_distance, grid_hausdorff_distance,
    grid_jaccard_distance, ospa,
};
pub use order::{MAX_EXACT, Method, NUM_RANDOM_ORDERS, OrderOptions, Ordering, order, share_of_shorter_orders};
pub use reward::{RewardSamples, SampledReward, world_rewards_distance};
pub use transport::{MAX_TRANSPORTED, Move, TransportPlan, earth_movers_distance, optimal_transport};
pub use world_measures::{Placements, WorldMeasure, world_sets_measure_distance};
