//! What an episode pays beside the objects, and what ends it before its last step.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Rewards and endings that belong to the world as a whole.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Rules {
    /// Paid at every step; a small negative number makes haste worth while.
    #[schemars(range(min = -1e9, max = 1e9))]
    pub step_reward: f64,
    /// A soft reward for coming closer.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub shaping: Option<Shaping>,
    /// Any of these ends the episode as a success.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100))]
    pub success: Vec<EndCondition>,
    /// Any of these ends the episode as a failure.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100))]
    pub failure: Vec<EndCondition>,
}

/// Potential-based shaping: each step pays `scale × (distance before − distance after)`.
///
/// The distance is that to the nearest object of the tag, so the sum over an episode depends on its first and last
/// step only, and the best policy stays the best (Ng, Harada and Russell 1999, with discount 1).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Shaping {
    /// Tag of the objects that draw the agent.
    #[schemars(length(min = 1, max = 100))]
    pub toward: String,
    /// Reward per metre.
    #[schemars(range(min = -1e6, max = 1e6))]
    pub scale: f64,
}

/// What ends an episode.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum EndCondition {
    /// No object is left that pays a positive reward.
    AllCollected,
    /// The agent touches, or interacts with, an object of this tag.
    Touch(#[schemars(length(min = 1, max = 100))] String),
    /// The return of the episode reaches this.
    ReturnAtLeast(f64),
    /// The return of the episode falls to this.
    ReturnAtMost(f64),
}
