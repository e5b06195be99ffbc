//! Distances between rewards, independent of the dynamics: EPIC on given transitions, and for whole worlds.

mod direction;
mod epic;
mod worlds;

pub use epic::{RewardSamples, SampledReward};
pub use worlds::world_rewards_distance;
