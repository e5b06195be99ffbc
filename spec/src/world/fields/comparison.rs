//! [`Comparison`]: the parts that the distance of two worlds is made of. Which fields each looks at is said beside the
//! fields; finding their numbers is `similarity`'s.

use crate::element::Element;

/// Declares the parts: for each what it looks at, the element of the decision process that it counts for, what tables
/// call it, and its measure with what that is divided by.
macro_rules! comparisons {
    ($($(#[$doc:meta])* $part:ident: $element:ident, $name:literal, $measure:literal,)+) => {
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

            /// The measure, and what its number is divided by.
            pub const fn measure(self) -> &'static str {
                match self {
                    $(Self::$part => $measure,)+
                }
            }
        }
    };
}

comparisons! {
    /// Where objects stand, matched within each class.
    PlacesOfObjects: S, "places of objects", "ospa / 10 m",
    /// The cells of 2 m in which something stands.
    CellsTaken: S, "cells taken", "jaccard",
    /// How many objects of each class there are.
    NumbersOfObjects: S, "numbers of objects", "jaccard of counts",
    /// Where the agent starts.
    Start: S, "agent's start", "euclidean, 10 m is a half",
    /// Where objects face.
    HeadingsOfObjects: S, "headings of objects", "turn / 180 degrees",
    /// Where the agent looks at the start.
    Heading: S, "agent's heading", "turn / 180 degrees",
    /// What the numbers of an action mean.
    ModelOfActions: A, "action model", "same or not",
    /// How actions are given.
    SpaceOfActions: A, "action space", "same or not",
    /// The agent's largest speed.
    LargestSpeed: A, "largest speed", "difference / larger",
    /// The agent's largest turn rate.
    LargestTurnRate: A, "largest turn rate", "difference / larger",
    /// How objects move by themselves.
    Motion: T, "motion of objects", "share that differs",
    /// How solid objects are, and what becomes of them.
    Bodies: T, "bodies of objects", "share that differs",
    /// Seconds of a step.
    TimeStep: T, "time step", "difference / larger",
    /// The agent's width.
    Width: T, "agent's width", "difference / larger",
    /// The map and its walls.
    MapAndWalls: T, "map and walls", "same or not",
    /// The area of the arena.
    ArenaSize: T, "size of the arena", "difference / larger",
    /// What objects pay.
    Rewards: R, "rewards of objects", "difference / twice the larger",
    /// For what objects pay.
    PaidFor: R, "what is paid for", "share that differs",
    /// How probable it is that an object pays.
    RewardProbabilities: R, "odds of reward", "difference",
    /// What a second pays.
    StepReward: R, "step reward", "difference / twice the larger",
    /// Shaping, and what ends an episode.
    ShapingAndEndings: R, "shaping and endings", "same or not",
    /// How long an episode may last.
    Limit: R, "limit of steps", "same or not",
    /// The colours of objects.
    ColorsOfObjects: O, "colours of objects", "oklab",
    /// The models and sizes of objects.
    ModelsOfObjects: O, "models of objects", "share that differs",
    /// How bright the sun is.
    Light: O, "light", "difference / larger",
    /// The colours of walls, sky, ground and sunlight.
    ColorsOfSurroundings: O, "colours of surroundings", "oklab",
    /// What else decides what the agent sees.
    CameraAndWeather: O, "camera and weather", "same or not",
}
