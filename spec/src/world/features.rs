//! The features of the state vector, which accompanies the images.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fields::word;

/// One named part of the state vector.
///
/// "Ahead" and "right" are the agent's own axes. A *target* is an object that would pay a positive reward now, taking its turn
/// in a sequence into account. A *goal* is an object with the tag named by the world's shaping or, without shaping, by its
/// success by touch. If there is none, the numbers are 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum StateFeature {
    /// The agent's x and y in metres, each within half the arena's side.
    Position,
    /// The agent's heading in degrees, 0..360, clockwise from +y.
    Heading,
    /// The agent's velocity along x and y over the last time step, in metres per second.
    Velocity,
    /// Sine and cosine of the heading: the agent's direction of view along x and y, −1..1.
    Direction,
    /// The agent's velocity ahead and to the right, in metres per second.
    OwnVelocity,
    /// Offset of the nearest goal, ahead and to the right, in metres; then 1 if there is a goal, otherwise 0.
    Goal,
    /// Offset of the nearest target, ahead and to the right, in metres; then 1 if there is a target, otherwise 0.
    NearestTarget,
    /// Number of targets left; then number of objects collected.
    Counts,
    /// Reward of the last step.
    LastReward,
    /// The last event of the last step: 0 for none, 1 for a contact, 2 for an interaction, 3 for coming into range; then its
    /// reward; then 1 if it destroyed its object, otherwise 0.
    LastEvent,
    /// Share of the steps left, from 1 down to 0; always 1 without a limit.
    StepsLeft,
    /// Number of things the agent carries; then, for the one picked up last, the number of its class and its index in the world
    /// plus 1, as in images of classes and instances.
    Carrying,
    /// The agent's energy; 0 in worlds without energy.
    Energy,
    /// Number of zones the agent is in; then their reward per second.
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
