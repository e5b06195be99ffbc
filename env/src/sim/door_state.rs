//! [`DoorState`]: the state of a door besides being open or closed.

use driftworld_spec::Door;

use super::ticks::ticks_of;

/// A door's state besides being open or closed.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DoorState {
    /// Index of its object.
    pub(super) object: usize,
    /// Whether its key was used.
    pub(super) unlocked: bool,
    /// The time step in which it is due to close. It then closes as soon as nothing stands in it.
    pub(super) closes_at: Option<u64>,
}

impl DoorState {
    pub(super) fn new(index: usize, door: &Door, time_step: f64) -> Self {
        Self {
            object: index,
            unlocked: false,
            closes_at: door
                .closes_after
                .filter(|_| door.open)
                .map(|seconds| ticks_of(seconds, time_step)),
        }
    }
}
