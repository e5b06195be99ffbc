//! The features of the state vector, which accompanies the images.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fields::word;

/// One named part of the state vector.
///
/// "Ahead" and "right" are the agent's own axes; a *target* is an object that pays a positive reward now, its turn in a sequence included; a *goal* is an object
/// of the tag that the world's shaping, or else its success by touch, names. Where there is none, numbers are 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StateFeature {
    /// The agent's x and y in metres, each within half the arena's side.
    Position,
    /// The agent's heading in degrees, 0..360, clockwise from +y.
    Heading,
    /// The agent's velocity along x and y over the last time step, in metres per second.
    Velocity,
    /// Sine and cosine of the heading: where the agent looks along x and y, −1..1.
    Direction,
    /// The agent's velocity ahead and to the right, in metres per second.
    OwnVelocity,
    /// Way to the nearest goal, ahead and to the right, in metres; then 1 if there is a goal, else 0.
    Goal,
    /// Way to the nearest target, ahead and to the right, in metres; then 1 if there is a target, else 0.
    NearestTarget,
    /// How many targets are left; then how many objects have been collected.
    Counts,
    /// What the last step paid.
    LastReward,
    /// The last event of the last step: 0 for none, 1 for a contact, 2 for an interaction, 3 for coming into range; then what it
    /// paid; then 1 if it destroyed its object, else 0.
    LastEvent,
    /// Share of the steps that are left, 1 to 0; always 1 without a limit.
    StepsLeft,
    /// How many things the agent carries; then of the one that was picked up last the number of its class, and its index in the
    /// world plus 1, as in pictures of classes and instances.
    Carrying,
    /// The agent's energy; 0 where it has none to use.
    Energy,
    /// How many zones the agent is in; then what a second in them pays.
    Zone,
}

impl StateFeature {
    /// The original's state vector: position, heading, velocity.
    pub const CLASSIC: [Self; 3] = [Self::Position, Self::Heading, Self::Velocity];

    /// Number of values of the feature.
    pub fn num_values(self) -> usize {
        match self {
            Self::Heading | Self::LastReward | Self::StepsLeft | Self::Energy => 1,
            Self::Position | Self::Velocity | Self::Direction | Self::OwnVelocity | Self::Counts | Self::Zone => 2,
            Self::Goal | Self::NearestTarget | Self::LastEvent | Self::Carrying => 3,
        }
    }
}

word!(StateFeature);
