//! Bodies of objects that move: how far one comes before it meets something, and putting one back. Where it wants to go is
//! decided in `motion.rs`, what the agent bumps into is in `body.rs`.

use rapier3d::prelude::*;

use super::body::{AGENT, EDGE, Ground, SOLID, WALL, shows_heading, slot};
use super::footprint::Footprint;
use super::outline::Outline;
use super::slide::{Obstacles, SKIN};

impl Ground {
    /// Tells the objects where the agent is: they stop in front of it.
    pub(crate) fn place_agent(&mut self, at: [f32; 2]) {
        let handle = match self.agent_handle {
            Some(handle) => handle,
            None => {
                let outline = Outline::disc(self.radius as f32);
                self.insert(ColliderBuilder::new(self.agent.clone()), AGENT, outline, 0.0)
            }
        };
        self.agent_handle = Some(handle);
        let pose = Pose::from_translation(Vector::new(at[0], at[1], 0.0));
        self.colliders[handle].set_position(pose);
        self.note_place(handle, 0.0);
    }

    /// Puts an object's body, where it is there, at a place and turns it to a heading in degrees.
    pub(super) fn put(&mut self, index: u32, at: [f32; 2], heading_deg: f32) {
        let Some(handle) = self.handles[index as usize] else {
            return;
        };
        let collider = &self.colliders[handle];
        let mut pose = *collider.position();
        if shows_heading(collider.shared_shape()) {
            pose = Pose::new(pose.translation, Vector::new(0.0, 0.0, -heading_deg.to_radians()));
        }
        (pose.translation.x, pose.translation.y) = (at[0], at[1]);
        self.colliders[handle].set_position(pose);
        self.note_place(handle, heading_deg);
    }

    /// Turns an object's body to a heading in degrees and moves it towards where it means to go; it stops at walls, solid
    /// objects and the agent, and slides along them. Hands back where it is then; nothing for an object that is not there.
    pub(crate) fn push(&mut self, index: u32, by: [f32; 2], heading_deg: f32) -> Option<[f32; 2]> {
        let handle = self.handles[index as usize]?;
        let start = self.colliders[handle].translation();
        let start = [start.x, start.y];
        let (from, way) = (start.map(f64::from), by.map(f64::from));
        let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
        let mut end = from;
        if length >= 1e-6 {
            let mut body = std::mem::take(&mut self.scratch.body);
            self.standing[slot(handle)].outline.turned_into(heading_deg, &mut body);
            self.gather(
                SOLID | WALL | AGENT,
                Some(handle),
                [from, from],
                length + body.reach() + 2.0 * SKIN,
            );
            let mut scratch = std::mem::take(&mut self.scratch);
            scratch.strides.clear();
            if let Some(radius) = body.as_disc() {
                let obstacles = Obstacles {
                    footprints: &self.whole,
                    numbers: &scratch.numbers,
                };
                obstacles.slide(from, way, radius, &mut scratch.touched, &mut scratch.strides);
            } else {
                let count = scratch.numbers.len();
                // Room for what most ways meet, so that no step takes memory.
                while scratch.widened.len() < count.max(16) {
                    scratch.widened.push(Footprint::with_room());
                }
                for (place, number) in scratch.numbers.iter_mut().enumerate() {
                    self.whole[*number as usize].widened_into(&body, &mut scratch.widened[place]);
                    *number = place as u32;
                }
                let obstacles = Obstacles {
                    footprints: &scratch.widened,
                    numbers: &scratch.numbers,
                };
                obstacles.slide(from, way, 0.0, &mut scratch.touched, &mut scratch.strides);
            }
            end = scratch.strides.last().copied().unwrap_or(from);
            scratch.body = body;
            self.scratch = scratch;
        }
        let mut place = end.map(|metres| metres as f32);
        for axis in 0..2 {
            let half = if start[axis].abs() <= self.half[axis] {
                self.half[axis]
            } else {
                EDGE
            };
            place[axis] = place[axis].clamp(-half, half);
        }
        self.put(index, place, heading_deg);
        Some(place)
    }

    /// Whether an object's body, taken away before, would stand free at a place.
    pub(crate) fn is_free(&self, at: [f32; 2], radius: f32) -> bool {
        let [x, y] = [0, 1].map(|axis| self.half[axis] - radius - SKIN as f32 - at[axis].abs());
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
