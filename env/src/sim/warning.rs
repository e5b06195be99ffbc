//! [`Warning`]: settings of a world that may not be as intended.

use driftworld_spec::Enclosure;

use super::obstacle::Obstacle;

/// A setting of a world that may not be as intended.
#[derive(Clone, Debug, PartialEq, Eq, strum::Display)]
#[non_exhaustive]
pub enum Warning {
    /// The class or model is unknown; a placeholder is shown.
    #[strum(to_string = "/objects/{object}: class {class:?} model {model:?} is not known; a placeholder is shown")]
    UnknownAsset {
        /// Index of the object.
        object: usize,
        /// Its class.
        class: String,
        /// Its model.
        model: String,
    },
    /// The object should move but stands still: it has no speed, or a patrol without waypoints.
    #[strum(
        to_string = "/objects/{object}/motion_model: found no speed, or a patrol without waypoints; it stands still"
    )]
    StandsStill {
        /// Index of the object.
        object: usize,
    },
    /// The object is inside a wall or a region that cannot be entered, out of reach.
    #[strum(to_string = "/objects/{object}/coordinates: found a place inside {enclosure}; it is kept but unreachable")]
    StandsInWall {
        /// Index of the object.
        object: usize,
        /// The wall or region.
        enclosure: Enclosure,
    },
    /// The agent starts inside an obstacle; it cannot move until it is moved out.
    #[strum(to_string = "/agent_params/coordinates: found {obstacle}, expected free ground; it may be stuck")]
    StartsInside {
        /// The obstacle.
        obstacle: Obstacle,
    },
    /// The object is pushable but cannot be pushed: it is not solid, moves by itself, or is a door.
    #[strum(
        to_string = "/objects/{object}/pushable: found an object that moves by itself or is not solid; it is not pushed"
    )]
    IsNotPushed {
        /// Index of the object.
        object: usize,
    },
    /// A pushable object is in a heap: more bodies overlap it than a time step can separate, so it stays put until there are
    /// fewer. Only the first such object of a world is reported.
    #[strum(
        to_string = "/objects/{object}/coordinates: found {bodies} bodies that overlap a pushable object, expected at \
        most {limit}; it stays in place until there are fewer: spread them out"
    )]
    Heap {
        /// Index of the object.
        object: usize,
        /// Number of other objects that overlap it, by bounding boxes.
        bodies: usize,
        /// Maximum number allowed.
        limit: usize,
    },
    /// The world is meant for photographs of its objects ([`Studio`](crate::Studio)); when stepped, it runs as if it were for
    /// learning.
    #[strum(
        to_string = "/game_mode: collect_images is for `driftworld photograph` and driftworld-unity; when stepped, the world runs as in mode learn"
    )]
    ForPhotographs,
}
