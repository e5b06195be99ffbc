//! [`Comparison`]: the parts that the distance of two worlds is made of. Which fields each looks at is said beside the
//! fields; finding their numbers is `similarity`'s.

use crate::element::Element;

/// Declares the parts: for each what it looks at, the element of the decision process that it counts for, what tables
/// call it, and its unit: what counts 1.
macro_rules! comparisons {
    ($($(#[$doc:meta])* $part:ident: $element:ident, $name:literal, $unit:literal,)+) => {
        /// A part of the distance of two worlds.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Comparison {
            $($(#[$doc])* $part,)+
        }

        impl Comparison {
            /// All of them, in the order in which tables show them.
            pub const ALL: &[Self] = &[$(Self::$part),+];

            /// What tables call it.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$part => $name,)+
                }
            }

            /// The element of the decision process that it counts for.
            pub const fn element(self) -> Element {
                match self {
                    $(Self::$part => Element::$element,)+
                }
            }

            /// Its unit: what counts 1.
            pub const fn unit(self) -> &'static str {
                match self {
                    $(Self::$part => $unit,)+
                }
            }
        }
    };
}

comparisons! {
    /// Where objects stand, those that were matched.
    PlacesOfObjects: S, "places of objects", "10 m",
    /// Objects that were matched with none.
    Unmatched: S, "objects without a match", "an object",
    /// Where objects face.
    HeadingsOfObjects: S, "headings of objects", "180 degrees",
    /// Where the agent starts.
    Start: S, "agent's start", "10 m",
    /// Where the agent looks at the start.
    Heading: S, "agent's heading", "180 degrees",
    /// What the numbers of an action mean.
    ModelOfActions: A, "action model", "another word",
    /// How actions are given.
    SpaceOfActions: A, "action space", "another word",
    /// The agent's largest speed.
    LargestSpeed: A, "largest speed", "the larger one",
    /// The agent's largest turn rate.
    LargestTurnRate: A, "largest turn rate", "the larger one",
    /// How objects move by themselves.
    Motion: T, "motion of objects", "the larger one, or another word",
    /// How solid objects are, what becomes of them, and what energy they give.
    Bodies: T, "bodies of objects", "the larger one, or another word",
    /// Seconds of a step.
    TimeStep: T, "time step", "the larger one",
    /// The agent's width.
    Width: T, "agent's width", "the larger one",
    /// How the agent's energy changes.
    EnergyOfAgent: T, "agent's energy", "the larger one, or none",
    /// The map and its walls.
    MapAndWalls: T, "map and walls", "the larger one, or another word",
    /// What divides the arena: mazes, rooms and walls.
    Layouts: T, "layouts", "no wall in common, or ways of no likeness",
    /// The sides of the arena.
    ArenaSize: T, "sides of the arena", "the larger one",
    /// Where zones are that act on how the agent moves, and how.
    Zones: T, "zones", "10 m, the larger one, or a zone",
    /// What objects pay.
    Rewards: R, "rewards of objects", "100 points",
    /// For what objects pay.
    PaidFor: R, "what is paid for", "the larger one, or another word",
    /// How probable it is that an object pays.
    RewardProbabilities: R, "odds of reward", "from never to always",
    /// What a second pays.
    StepReward: R, "step reward", "1 point a second",
    /// Shaping, and what ends an episode.
    ShapingAndEndings: R, "shaping and endings", "the larger one, or another word",
    /// Where zones are that pay or end an episode, and what.
    ZonePay: R, "pay and endings of zones", "10 m, the larger one, or a zone",
    /// How long an episode may last.
    Limit: R, "limit of steps", "the larger one, or none",
    /// The colours of objects.
    ColorsOfObjects: O, "colours of objects", "black to white in Oklab",
    /// The looks of objects that were matched with none.
    UnmatchedLooks: O, "looks without a match", "an object",
    /// The models of objects.
    ModelsOfObjects: O, "models of objects", "another word",
    /// The sizes of objects.
    SizesOfObjects: O, "sizes of objects", "the larger one",
    /// How bright the sun is.
    Light: O, "light", "the larger one",
    /// The colours of walls, sky, ground and sunlight.
    ColorsOfSurroundings: O, "colours of surroundings", "black to white in Oklab",
    /// Where zones are that are seen, and their colours.
    ZoneLooks: O, "looks of zones", "10 m, the larger one, or a zone",
    /// What else decides what the agent sees.
    CameraAndWeather: O, "camera and weather", "the larger one, or another word",
}
