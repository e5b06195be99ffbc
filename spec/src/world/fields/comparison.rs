//! [`Comparison`]: the parts of the distance between two worlds. The table of fields assigns each field to its parts.

use crate::element::Element;

/// Declares the parts, each with its subject, its element of the decision process, its name in tables, and its unit:
/// the difference that counts as 1.
macro_rules! comparisons {
    ($($(#[$doc:meta])* $part:ident: $element:ident, $name:literal, $unit:literal,)+) => {
        /// A part of the distance between two worlds.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Comparison {
            $($(#[$doc])* $part,)+
        }

        impl Comparison {
            /// All parts, in the order in which tables list them.
            pub const ALL: &[Self] = &[$(Self::$part),+];

            /// Its name in tables.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$part => $name,)+
                }
            }

            /// Its element of the decision process.
            pub const fn element(self) -> Element {
                match self {
                    $(Self::$part => Element::$element,)+
                }
            }

            /// Its unit, the difference that counts as 1.
            pub const fn unit(self) -> &'static str {
                match self {
                    $(Self::$part => $unit,)+
                }
            }
        }
    };
}

comparisons! {
    /// Positions of matched objects.
    PlacesOfObjects: S, "object positions", "10 m",
    /// Objects without a match.
    Unmatched: S, "unmatched objects", "an object",
    /// Headings of objects.
    HeadingsOfObjects: S, "object headings", "180 degrees",
    /// The agent's start.
    Start: S, "agent's start", "10 m",
    /// The agent's heading at the start.
    Heading: S, "agent's heading", "180 degrees",
    /// The meaning of the numbers of an action.
    ModelOfActions: A, "action model", "a different value",
    /// The action space, and whether the agent can interact and carry.
    SpaceOfActions: A, "action space", "a different value",
    /// The agent's maximum speed.
    LargestSpeed: A, "maximum speed", "the larger value",
    /// The agent's maximum turn rate.
    LargestTurnRate: A, "maximum turn rate", "the larger value",
    /// How objects move by themselves.
    Motion: T, "object motion", "the larger value, or a different value",
    /// Solidity and functions of objects, and the energy that they give.
    Bodies: T, "object bodies", "the larger value, or a different value",
    /// Length of a time step in seconds.
    TimeStep: T, "time step", "the larger value",
    /// The agent's width.
    Width: T, "agent's width", "the larger value",
    /// How the agent's energy changes.
    EnergyOfAgent: T, "agent's energy", "the larger value, or none",
    /// The map and its walls.
    MapAndWalls: T, "map and walls", "the larger value, or a different value",
    /// Mazes, rooms and walls that divide the arena.
    Layouts: T, "layouts", "no wall in common, or entirely different paths",
    /// The sides of the arena.
    ArenaSize: T, "arena size", "the larger value",
    /// Positions and effects of zones that affect movement.
    Zones: T, "zones", "10 m, the larger value, or a zone",
    /// Rewards of objects.
    Rewards: R, "object rewards", "100 points",
    /// The stimuli for which an object pays its reward, and when it pays.
    PaidFor: R, "reward conditions", "the larger value, or a different value",
    /// Probability that an object pays.
    RewardProbabilities: R, "reward probability", "from never to always",
    /// Reward per second.
    StepReward: R, "step reward", "1 point per second",
    /// Shaping rewards, and the conditions that end an episode.
    ShapingAndEndings: R, "shaping and endings", "the larger value, or a different value",
    /// Positions and effects of zones that pay or end an episode.
    ZonePay: R, "zone rewards and endings", "10 m, the larger value, or a zone",
    /// The limit on the length of an episode.
    Limit: R, "episode limit", "the larger value, or none",
    /// The colours of objects.
    ColorsOfObjects: O, "object colours", "black to white in Oklab",
    /// The appearance of objects without a match.
    UnmatchedLooks: O, "appearance of unmatched objects", "an object",
    /// The models of objects.
    ModelsOfObjects: O, "object models", "a different value",
    /// The sizes of objects.
    SizesOfObjects: O, "object sizes", "the larger value",
    /// Brightness of the sun.
    Light: O, "light", "the larger value",
    /// The colours of walls, sky, ground and sunlight.
    ColorsOfSurroundings: O, "surrounding colours", "black to white in Oklab",
    /// Positions and colours of visible zones.
    ZoneLooks: O, "zone appearance", "10 m, the larger value, or a zone",
    /// Everything else that affects what the agent sees.
    CameraAndWeather: O, "camera and weather", "the larger value, or a different value",
}
