//! How far apart rewards are, whatever the dynamics: EPIC over tables and over drawn transitions. Which worlds or tasks the
//! rewards belong to is known elsewhere, but for those of worlds.

mod epic;
mod pearson_distance;
mod samples;
mod table;
mod worlds;

pub use epic::Epic;
pub use pearson_distance::pearson_distance;
pub use samples::{RewardSamples, SampledReward};
pub use table::{MAX_REWARDS, RewardTable};
pub use worlds::world_rewards_distance;
