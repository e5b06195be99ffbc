//! [`Comparison`]: the parts that the distance of two worlds is made of. Which fields each looks at is said beside the
//! fields; finding their numbers is `similarity`'s.

use crate::element::Element;

/// A part of the distance of two worlds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Comparison {
    /// Where objects stand, matched within each class.
    PlacesOfObjects,
    /// The cells of 2 m in which something stands.
    CellsTaken,
    /// How many objects of each class there are.
    NumbersOfObjects,
    /// Where the agent starts.
    Start,
    /// Where objects face.
    HeadingsOfObjects,
    /// Where the agent looks at the start.
    Heading,
    /// What the numbers of an action mean.
    ModelOfActions,
    /// How actions are given.
    SpaceOfActions,
    /// The agent's largest speed.
    LargestSpeed,
    /// The agent's largest turn rate.
    LargestTurnRate,
    /// How objects move by themselves.
    Motion,
    /// How solid objects are, and what becomes of them.
    Bodies,
    /// Seconds of a step.
    TimeStep,
    /// The agent's width.
    Width,
    /// The map and its walls.
    MapAndWalls,
    /// The area of the arena.
    ArenaSize,
    /// What objects pay.
    Rewards,
    /// For what objects pay.
    PaidFor,
    /// How probable it is that an object pays.
    RewardProbabilities,
    /// What a second pays.
    StepReward,
    /// Shaping, and what ends an episode.
    ShapingAndEndings,
    /// How long an episode may last.
    Limit,
    /// The colours of objects.
    ColorsOfObjects,
    /// The models and sizes of objects.
    ModelsOfObjects,
    /// How bright the sun is.
    Light,
    /// The colours of walls, sky, ground and sunlight.
    ColorsOfSurroundings,
    /// What else decides what the agent sees.
    CameraAndWeather,
}

impl Comparison {
    /// All of them, in the order in which tables show them.
    pub const ALL: [Self; 27] = [
        Self::PlacesOfObjects,
        Self::CellsTaken,
        Self::NumbersOfObjects,
        Self::Start,
        Self::HeadingsOfObjects,
        Self::Heading,
        Self::ModelOfActions,
        Self::SpaceOfActions,
        Self::LargestSpeed,
        Self::LargestTurnRate,
        Self::Motion,
        Self::Bodies,
        Self::TimeStep,
        Self::Width,
        Self::MapAndWalls,
        Self::ArenaSize,
        Self::Rewards,
        Self::PaidFor,
        Self::RewardProbabilities,
        Self::StepReward,
        Self::ShapingAndEndings,
        Self::Limit,
        Self::ColorsOfObjects,
        Self::ModelsOfObjects,
        Self::Light,
        Self::ColorsOfSurroundings,
        Self::CameraAndWeather,
    ];

    /// Its name in tables, the element of the decision process that it counts for, and its measure with what that is
    /// divided by.
    const fn row(self) -> (&'static str, Element, &'static str) {
        use Element::{A, O, R, S, T};
        match self {
            Self::PlacesOfObjects => ("places of objects", S, "ospa / 10 m"),
            Self::CellsTaken => ("cells taken", S, "jaccard"),
            Self::NumbersOfObjects => ("numbers of objects", S, "jaccard of counts"),
            Self::Start => ("agent's start", S, "euclidean, 10 m is a half"),
            Self::HeadingsOfObjects => ("headings of objects", S, "turn / 180 degrees"),
            Self::Heading => ("agent's heading", S, "turn / 180 degrees"),
            Self::ModelOfActions => ("action model", A, "same or not"),
            Self::SpaceOfActions => ("action space", A, "same or not"),
            Self::LargestSpeed => ("largest speed", A, "difference / larger"),
            Self::LargestTurnRate => ("largest turn rate", A, "difference / larger"),
            Self::Motion => ("motion of objects", T, "share that differs"),
            Self::Bodies => ("bodies of objects", T, "share that differs"),
            Self::TimeStep => ("time step", T, "difference / larger"),
            Self::Width => ("agent's width", T, "difference / larger"),
            Self::MapAndWalls => ("map and walls", T, "same or not"),
            Self::ArenaSize => ("size of the arena", T, "difference / larger"),
            Self::Rewards => ("rewards of objects", R, "difference / twice the larger"),
            Self::PaidFor => ("what is paid for", R, "share that differs"),
            Self::RewardProbabilities => ("odds of reward", R, "difference"),
            Self::StepReward => ("step reward", R, "difference / twice the larger"),
            Self::ShapingAndEndings => ("shaping and endings", R, "same or not"),
            Self::Limit => ("limit of steps", R, "same or not"),
            Self::ColorsOfObjects => ("colours of objects", O, "oklab"),
            Self::ModelsOfObjects => ("models of objects", O, "share that differs"),
            Self::Light => ("light", O, "difference / larger"),
            Self::ColorsOfSurroundings => ("colours of surroundings", O, "oklab"),
            Self::CameraAndWeather => ("camera and weather", O, "same or not"),
        }
    }

    /// What tables call it.
    pub const fn name(self) -> &'static str {
        self.row().0
    }

    /// The element of the decision process that it counts for.
    pub const fn element(self) -> Element {
        self.row().1
    }

    /// The measure, and what its number is divided by.
    pub const fn measure(self) -> &'static str {
        self.row().2
    }
}
