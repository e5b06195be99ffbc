//! How far apart rewards are, whatever the dynamics: EPIC over drawn transitions, and the transitions of worlds.

mod direction;
mod epic;
mod worlds;

pub use epic::{RewardSamples, SampledReward};
pub use worlds::world_rewards_distance;
