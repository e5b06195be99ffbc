//! Bodies of objects that move: how far one comes before it meets something, and putting one back. Where it wants to go is
//! decided in `motion.rs`, what the agent bumps into is in `body.rs`.

use rapier3d::prelude::*;

use super::body::{AGENT, EDGE, Ground, SKIN, SOLID, WALL, shows_heading};

impl Ground {
    /// Tells the objects where the agent is: they stop in front of it.
    pub(crate) fn place_agent(&mut self, at: [f32; 2]) {
        let shape = self.agent.clone();
        let handle = match self.agent_handle {
            Some(handle) => handle,
            None => self.insert(ColliderBuilder::new(shape), AGENT),
        };
        self.agent_handle = Some(handle);
        self.put(handle, Pose::from_translation(Vector::new(at[0], at[1], 0.0)));
    }

    fn put(&mut self, handle: ColliderHandle, pose: Pose) {
        self.colliders[handle].set_position(pose);
        self.note_place(handle);
    }

    /// Turns an object's body to a heading in degrees and moves it towards where it means to go; it stops at walls, solid
    /// objects and the agent, and slides along them once. Hands back where it is then; nothing for an object that is not there.
    pub(crate) fn push(&mut self, index: u32, by: [f32; 2], heading_deg: f32) -> Option<[f32; 2]> {
        let handle = self.handles[index as usize]?;
        let collider = &self.colliders[handle];
        let shape = collider.shared_shape().clone();
        let mut pose = *collider.position();
        if shows_heading(&shape) {
            pose = Pose::new(pose.translation, Vector::new(0.0, 0.0, -heading_deg.to_radians()));
        }
        let mut left = Vector::new(by[0], by[1], 0.0);
        let start = pose.translation;
        for _ in 0..2 {
            if left.length() < 1e-6 {
                break;
            }
            let Some(hit) = self.first_met(SOLID | WALL | AGENT, Some(handle), &*shape, &pose, left) else {
                pose.translation += left;
                break;
            };
            pose.translation += left * hit.share;
            left *= 1.0 - hit.share;
            left -= hit.normal * left.dot(hit.normal).min(0.0);
        }
        // What a cast missed by rounding ends here: the body's middle never leaves the arena, nor changes sides of a wall.
        let from = [start.x, start.y];
        if self.leads_through(from, [pose.translation.x, pose.translation.y], index) {
            pose.translation = start;
        }
        for (axis, begun) in from.into_iter().enumerate() {
            let half = if begun.abs() <= self.half[axis] {
                self.half[axis]
            } else {
                EDGE
            };
            pose.translation[axis] = pose.translation[axis].clamp(-half, half);
        }
        self.put(handle, pose);
        Some([pose.translation.x, pose.translation.y])
    }

    /// Whether an object's body, taken away before, would stand free at a place.
    pub(crate) fn is_free(&self, at: [f32; 2], radius: f32) -> bool {
        let [x, y] = [0, 1].map(|axis| self.half[axis] - radius - SKIN - at[axis].abs());
        if x < 0.0 || y < 0.0 {
            return false;
        }
        let ball = Ball::new(radius.max(0.05));
        let pose = Pose::from_translation(Vector::new(at[0], at[1], radius.max(0.05) + 0.01));
        self.query_but(SOLID | WALL | AGENT, None)
            .intersect_shape(pose, &ball)
            .next()
            .is_none()
    }
}
