//! [`Stimulus`]: what triggers an object, and how often it does while it lasts.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fields::word;

/// A stimulus that triggers an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[expect(clippy::enum_variant_names, reason = "the words of L2Explorer's documents")]
pub enum Stimulus {
    /// The agent's body meets the object's; fires again only after they have been at least a quarter of a metre apart.
    AgentCollide,
    /// The agent interacts while the object is in the 1 m cube directly in front of it.
    AgentInteract,
    /// The centres come closer than `range_stimulus_distance`, even for part of a step; fires again only after they have been a
    /// quarter of a metre farther apart than that.
    AgentInRange,
}

/// How often a stimulus triggers an object while it lasts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Trigger {
    /// Once, when it begins.
    #[default]
    Edge,
    /// At every time step.
    Level,
}

word!(Stimulus);
word!(Trigger);
