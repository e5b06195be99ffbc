//! [`Element`]: the parts of a decision process. What of a world belongs to which is in `world/comparison.rs`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An element of the decision process that a parameter touches.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema, strum::IntoStaticStr,
)]
pub enum Element {
    /// The states: what is where.
    S,
    /// The actions that the agent has.
    A,
    /// The transitions: how the world answers an action.
    T,
    /// The rewards.
    R,
    /// The observations: what the agent sees of a state.
    O,
}

impl Element {
    /// All elements, in the order in which tables show them.
    pub const ALL: [Self; 5] = [Self::S, Self::A, Self::T, Self::R, Self::O];

    /// The element in a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::S => "state",
            Self::A => "action",
            Self::T => "transition",
            Self::R => "reward",
            Self::O => "observation",
        }
    }

    /// The letter by which documents name the element.
    pub fn letter(self) -> &'static str {
        self.into()
    }
}
