//! [`Comparison`]: the parts of the distance between two worlds. The table of fields assigns each field to its parts.

use crate::element::Element;

/// Declares the parts, each with its subject, its element of the decision process, its name in tables, and its unit,
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
    PlacesOfObjects: S, "places of objects", "10 m",
    /// Objects without a match.
    Unmatched: S, "objects without a match", "an object",
    /// Headings of objects.
    HeadingsOfObjects: S, "headings of objects", "180 degrees",
    /// The agent's start.
    Start: S, "agent's start", "10 m",
    /// The agent's heading at the start.
    Heading: S, "agent's heading", "180 degrees",
    /// The meaning of the numbers of an action.
    ModelOfActions: A, "action model", "another value",
    /// The action space, and whether the agent can interact and carry.
    SpaceOfActions: A, "action space", "another value",
    /// The agent's maximum speed.
    LargestSpeed: A, "largest speed", "the larger one",
    /// The agent's maximum turn rate.
    LargestTurnRate: A, "largest turn rate", "the larger one",
    /// How objects move by themselves.
    Motion: T, "motion of objects", "the larger one, or another value",
    /// Solidity and functions of objects, and the energy that they give.
    Bodies: T, "bodies of objects", "the larger one, or another value",
    /// Length of a time step in seconds.
    TimeStep: T, "time step", "the larger one",
    /// The agent's width.
    Width: T, "agent's width", "the larger one",
    /// How the agent's energy changes.
    EnergyOfAgent: T, "agent's energy", "the larger one, or none",
    /// The map and its walls.
    MapAndWalls: T, "map and walls", "the larger one, or another value",
    /// Mazes, rooms and walls that divide the arena.
    Layouts: T, "layouts", "no wall in common, or entirely different paths",
    /// The sides of the arena.
    ArenaSize: T, "sides of the arena", "the larger one",
    /// Positions and effects of zones that affect movement.
    Zones: T, "zones", "10 m, the larger one, or a zone",
    /// Rewards of objects.
    Rewards: R, "rewards of objects", "100 points",
    /// The stimuli that pay an object's reward.
    PaidFor: R, "what is paid for", "the larger one, or another value",
    /// Probability that an object pays.
    RewardProbabilities: R, "odds of reward", "from never to always",
    /// Reward per second.
    StepReward: R, "step reward", "1 point a second",
    /// Shaping rewards, and the conditions that end an episode.
    ShapingAndEndings: R, "shaping and endings", "the larger one, or another value",
    /// Positions and effects of zones that pay or end an episode.
    ZonePay: R, "pay and endings of zones", "10 m, the larger one, or a zone",
    /// The limit on the length of an episode.
    Limit: R, "limit of steps", "the larger one, or none",
    /// The colours of objects.
    ColorsOfObjects: O, "colours of objects", "black to white in Oklab",
    /// The appearance of objects without a match.
    UnmatchedLooks: O, "looks without a match", "an object",
    /// The models of objects.
    ModelsOfObjects: O, "models of objects", "another value",
    /// The sizes of objects.
    SizesOfObjects: O, "sizes of objects", "the larger one",
    /// Brightness of the sun.
    Light: O, "light", "the larger one",
    /// The colours of walls, sky, ground and sunlight.
    ColorsOfSurroundings: O, "colours of surroundings", "black to white in Oklab",
    /// Positions and colours of visible zones.
    ZoneLooks: O, "looks of zones", "10 m, the larger one, or a zone",
    /// Everything else that affects what the agent sees.
    CameraAndWeather: O, "camera and weather", "the larger one, or another value",
}
