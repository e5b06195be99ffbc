//! Moves the bodies of objects that move by themselves, and checks positions for respawning.

use rapier3d::prelude::*;
use smallvec::SmallVec;

use super::budget::Budget;
use super::collision_world::{CollisionWorld, EDGE, slot};
use super::footprint::Footprint;
use super::groups::{AGENT, SOLID, WALL};
use super::outline::Outline;
use super::slide::{Obstacles, SKIN};

/// Maximum displacement in metres that makes room for a body that turns beside a wall.
const TURN_ROOM: f64 = 0.25;

/// Number of bodies near a position at which it counts as occupied without further tests.
const MAX_NEARBY: usize = 256;

/// Cost of testing two shapes against each other, in queries.
const QUERIES_PER_SHAPE: usize = 16;

/// Cost per corner of moving a body with corners, in queries: its corners are added to those of every other body at most twice,
/// and finding room takes up to eight attempts.
const QUERIES_TO_TURN: usize = 12;

impl CollisionWorld {
    /// Updates the agent's collider, so that objects stop in front of it.
    pub(crate) fn place_agent(&mut self, at: [f32; 2]) {
        let handle = if let Some(handle) = self.agent_handle {
            handle
        } else {
            let outline = Outline::of_whole(Footprint::disc([0.0; 2], self.radius));
            self.insert(ColliderBuilder::new(self.agent.clone()), AGENT, outline, 0.0)
        };
        self.agent_handle = Some(handle);
        let pose = Pose::from_translation(Vector::new(at[0], at[1], 0.0));
        self.colliders[handle].set_position(pose);
        self.record_position(handle, 0.0);
    }

    /// Moves an object's body and turns it from one heading in degrees to another. It stops at walls, solid objects and the
    /// agent, and slides along them. A body with corners turns only if there is room; otherwise it slides on without turning.
    /// Returns its new position and heading. `None` for an absent object, and for one that has to wait because there are more
    /// bodies around it than the budget allows.
    pub(crate) fn push(
        &mut self,
        index: u32,
        by: [f32; 2],
        turn_deg: [f32; 2],
        budget: &mut Budget,
    ) -> Option<([f32; 2], f32)> {
        let handle = self.handles[index as usize]?;
        let start = self.colliders[handle].translation();
        let start = [start.x, start.y];
        let (from, way) = (start.map(f64::from), by.map(f64::from));
        let [facing, mut heading_deg] = turn_deg;
        let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
        let mut body = std::mem::take(&mut self.scratch.body);
        let outline = &self.body_data[slot(handle)].outline;
        outline.rotate_into(heading_deg, &mut body);
        let reach = length + TURN_ROOM + body.reach() + 2.0 * SKIN;
        let around = self.gather(SOLID | WALL | AGENT, Some(handle), [from, from], reach, budget);
        // The body's corners are added to those of each obstacle, and finding room costs queries.
        let extra_corners = if body.as_disc().is_some() {
            0
        } else {
            body.corners.len()
        };
        let num_corners = around.map(|corners| corners + extra_corners * self.scratch.numbers.len());
        let Some(num_corners) =
            num_corners.filter(|corners| extra_corners == 0 || budget.take(QUERIES_TO_TURN * corners))
        else {
            self.scratch.body = body;
            return None;
        };
        let mut scratch = std::mem::take(&mut self.scratch);
        scratch.strides.clear();
        if let Some(radius) = body.as_disc() {
            let obstacles = Obstacles {
                footprints: &self.whole,
                numbers: &scratch.numbers,
                num_corners,
            };
            obstacles.slide(from, way, radius, budget, &mut scratch.touched, &mut scratch.strides);
        } else {
            // Widens the obstacles by the body, so that the body becomes a point.
            let count = scratch.numbers.len();
            scratch.indices.clear();
            scratch.indices.extend(0..count as u32);
            // Enough capacity for most paths, so that steps do not allocate.
            while scratch.widened.len() < count.max(16) {
                scratch.widened.push(Footprint {
                    corners: SmallVec::with_capacity(8),
                    rounding: 0.0,
                });
            }
            self.widen(&scratch.numbers, &body, &mut scratch.widened);
            let mut start_of_slide = from;
            if heading_deg != facing {
                let turned = Obstacles {
                    footprints: &scratch.widened,
                    numbers: &scratch.indices,
                    num_corners,
                };
                if let Some(room) = turned.room_near(from, TURN_ROOM) {
                    start_of_slide = room;
                } else {
                    heading_deg = facing;
                    self.body_data[slot(handle)].outline.rotate_into(facing, &mut body);
                    self.widen(&scratch.numbers, &body, &mut scratch.widened);
                }
            }
            let obstacles = Obstacles {
                footprints: &scratch.widened,
                numbers: &scratch.indices,
                num_corners,
            };
            scratch.strides.push(start_of_slide);
            obstacles.slide(
                start_of_slide,
                way,
                0.0,
                budget,
                &mut scratch.touched,
                &mut scratch.strides,
            );
        }
        let end = scratch.strides.last().copied().unwrap_or(from);
        scratch.body = body;
        self.scratch = scratch;
        let mut place = end.map(|metres| metres as f32);
        for axis in 0..2 {
            let half = if start[axis].abs() <= self.half[axis] {
                self.half[axis]
            } else {
                EDGE
            };
            place[axis] = place[axis].clamp(-half, half);
        }
        Some((place, heading_deg))
    }

    /// Widens the footprints with these numbers by a body.
    fn widen(&self, numbers: &[u32], body: &Footprint, widened: &mut [Footprint]) {
        for (number, widened) in numbers.iter().zip(widened) {
            self.whole[*number as usize].widen_into(body, widened);
        }
    }

    /// Whether an object's body, which has been removed before, fits at a position. False if there are more bodies around it
    /// than the budget allows.
    pub(crate) fn is_free(&self, at: [f32; 2], radius: f32, budget: &mut Budget) -> bool {
        let [x, y] = [0, 1].map(|axis| self.half[axis] - radius - SKIN as f32 - at[axis].abs());
        if x < 0.0 || y < 0.0 {
            return false;
        }
        let ball = Ball::new(radius.max(0.05));
        let pose = Pose::from_translation(Vector::new(at[0], at[1], radius.max(0.05) + 0.01));
        let around = ball.compute_aabb(&pose);
        let area = [around.mins, around.maxs].map(|corner| [corner.x, corner.y]);
        let mut near: Vec<ColliderHandle> = self.around(SOLID | WALL | AGENT, None, area).take(MAX_NEARBY).collect();
        // The tree's order depends on its history, which a saved world does not contain.
        near.sort_unstable_by_key(|handle| self.body_data[slot(*handle)].rank);
        let meets = |handle: &ColliderHandle| {
            let collider = &self.colliders[*handle];
            let between = pose.inv_mul(collider.position());
            let dispatcher = self.engine.narrow_phase.query_dispatcher();
            dispatcher
                .intersection_test(&between, &ball, collider.shape())
                .is_ok_and(|result| result.intersecting)
        };
        budget.take(QUERIES_PER_SHAPE * near.len()) && near.len() < MAX_NEARBY && !near.iter().any(meets)
    }
}
