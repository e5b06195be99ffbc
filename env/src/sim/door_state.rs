//! [`DoorState`]: the state of a door besides being open or closed.

use driftworld_spec::Door;

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

/// Number of time steps until `seconds` have passed: at least one.
pub(super) fn ticks_of(seconds: f64, time_step: f64) -> u64 {
    // Subtracts a little, because 0.1 is inexact in binary, but 60 s must be 600 time steps of 0.1 s.
    ((seconds / time_step - 1e-6).ceil() as u64).max(1)
}
