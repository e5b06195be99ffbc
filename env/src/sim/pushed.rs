//! [`Pushed`]: the motion of a pushable object.

use driftworld_spec::{MotionModel, Object};

/// The motion of one pushable body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pushed {
    /// The object's index in the world.
    pub(super) object: usize,
    /// Velocity in metres per second.
    pub(super) velocity: [f32; 2],
    /// Spin in degrees per second, clockwise.
    pub(super) spin_deg: f32,
}

impl Pushed {
    /// An object's motion, at rest; `None` if it cannot be pushed.
    pub(super) fn new(object_index: usize, object: &Object) -> Option<Self> {
        is_pushed(object).then_some(Self {
            object: object_index,
            velocity: [0.0; 2],
            spin_deg: 0.0,
        })
    }

    /// Stops its motion.
    pub(super) fn stop(&mut self) {
        (self.velocity, self.spin_deg) = ([0.0; 2], 0.0);
    }

    pub(super) fn moves(&self) -> bool {
        self.velocity != [0.0; 2] || self.spin_deg != 0.0
    }
}

/// Whether an object can be pushed: it is pushable and solid, is not a door, and does not move by itself.
pub(super) fn is_pushed(object: &Object) -> bool {
    object.pushable.is_some() && object.door.is_none() && object.solid && object.motion_model == MotionModel::Stationary
}
