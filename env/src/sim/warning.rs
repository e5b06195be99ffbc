//! What of a world is not as its author may think. What happens in a step is in `event.rs`.

use driftworld_spec::Enclosure;

use super::walls::Obstacle;

/// Something that the world asks for and that is not as its author may think.
#[derive(Clone, Debug, PartialEq, Eq, strum::Display)]
#[non_exhaustive]
pub enum Warning {
    /// Class and model are not known: a placeholder stands there.
    #[strum(to_string = "/objects/{object}: class {class:?} model {model:?} is not known; a placeholder stands there")]
    UnknownAsset {
        /// Index of the object.
        object: usize,
        /// Its class.
        class: String,
        /// Its model.
        model: String,
    },
    /// The object asks to move, and stands still: it has no speed, or a patrol no waypoints.
    #[strum(
        to_string = "/objects/{object}/motion_model: found no speed, or a patrol without waypoints; it stands still"
    )]
    StandsStill {
        /// Index of the object.
        object: usize,
    },
    /// The object stands inside a wall or a region that cannot be entered: nobody comes to it.
    #[strum(to_string = "/objects/{object}/coordinates: found a place inside {enclosure}; it is kept, out of reach")]
    StandsInWall {
        /// Index of the object.
        object: usize,
        /// Which wall or region.
        enclosure: Enclosure,
    },
    /// The agent starts inside something; it cannot move until it is put elsewhere.
    #[strum(to_string = "/agent_params/coordinates: found {obstacle}, expected free ground; it may not get out")]
    StartsInside {
        /// What it starts in.
        obstacle: Obstacle,
    },
    /// The object asks to be pushed, and is not: it is not solid, or moves by itself.
    #[strum(
        to_string = "/objects/{object}/pushable: found an object that moves by itself or is not solid; it is not pushed"
    )]
    IsNotPushed {
        /// Index of the object.
        object: usize,
    },
    /// The object can be pushed, and stands in a heap: more bodies are in its place than are moved out of each other in
    /// a time step. It stands fast until there are fewer. The first such object of a world stands for all.
    #[strum(
        to_string = "/objects/{object}/coordinates: found {bodies} bodies in the place of one that can be pushed, expected at \
        most {limit}; it stands fast until there are fewer: spread them"
    )]
    Heap {
        /// Index of the object.
        object: usize,
        /// How many others overlap it, by the boxes around them.
        bodies: usize,
        /// How many may.
        limit: usize,
    },
    /// The world is for photographs of its objects ([`Studio`](crate::Studio)); stepped, it runs as if it were for
    /// learning.
    #[strum(
        to_string = "/game_mode: collect_images is for `driftworld photograph` and driftworld-unity; stepped, the world runs as learn"
    )]
    ForPhotographs,
}
