//! Defines when contacts begin and end.
//!
//! A contact begins when the gap between the agent and an object is at most [`TOUCH`] anywhere along their paths. It ends when
//! the gap exceeds [`RELEASE`] both after the agent and after the objects have moved, so that an agent that closely follows an
//! object stays in contact. These are distances, not times, so the number of contacts while passing depends neither on speed
//! nor on the time step.

use super::budget::Budget;
use super::collision_world::{CollisionWorld, slot};
use super::footprint::Point;
use super::groups::{GHOST, SOLID};

/// Maximum gap that counts as a touch, in metres; slightly more than the skin.
const TOUCH: f64 = 0.03;

/// Maximum gap at which a contact continues, in metres. An object's range is left at the same distance beyond its edge.
pub(super) const RELEASE: f64 = 0.25;

impl CollisionWorld {
    /// Records the objects that the agent touched along its path in this time step, each once, except `skipped` ones.
    pub(super) fn record_touched_on_path(&mut self, met_objects: &mut Vec<u32>, skipped: impl Fn(u32) -> bool) {
        let Some((mut low, mut high)) = self.path().first().map(|&start| (start, start)) else {
            return;
        };
        for point in self.path() {
            for axis in 0..2 {
                low[axis] = low[axis].min(point[axis]);
                high[axis] = high[axis].max(point[axis]);
            }
        }
        let reach = self.radius + TOUCH;
        self.gather(SOLID | GHOST, None, [low, high], reach, &mut Budget::new(u64::MAX));
        for &number in &self.scratch.numbers {
            let Some(object) = self.body_data[number as usize].object else {
                continue;
            };
            let footprint = &self.low[number as usize];
            let touched = self.path().windows(2).any(|ends| {
                let by = [0, 1].map(|axis| ends[1][axis] - ends[0][axis]);
                footprint.time_within(ends[0], by, reach).is_some()
            });
            if touched && !skipped(object) {
                record(met_objects, object);
            }
        }
    }

    /// Records an object if it touched the agent while the object moved by `by` metres to its current position, and the agent
    /// from one position to the other.
    pub(super) fn record_if_touched_in_motion(
        &self,
        object: u32,
        by: [f32; 2],
        agent: [[f32; 2]; 2],
        met_objects: &mut Vec<u32>,
    ) {
        let Some(handle) = self.handles[object as usize] else {
            return;
        };
        let footprint = &self.low[slot(handle)];
        // In the object's frame.
        let [start, end] = agent.map(|at| at.map(f64::from));
        let from = [0, 1].map(|axis| start[axis] + f64::from(by[axis]));
        let way = [0, 1].map(|axis| end[axis] - from[axis]);
        if footprint.time_within(from, way, self.radius + TOUCH).is_some() {
            record(met_objects, object);
        }
    }

    /// Records the objects that the agent's body touches at its current position.
    pub(super) fn record_touched_now(&mut self, at: [f32; 2], met_objects: &mut Vec<u32>) {
        let at: Point = at.map(f64::from);
        let reach = self.radius + TOUCH;
        self.gather(SOLID | GHOST, None, [at, at], reach, &mut Budget::new(u64::MAX));
        for &number in &self.scratch.numbers {
            if self.low[number as usize].gap(at).distance <= reach
                && let Some(object) = self.body_data[number as usize].object
            {
                record(met_objects, object);
            }
        }
    }

    /// Whether an agent that follows this path touches an object or comes within `metres` of a touch. If it starts nearer than
    /// that, only coming even nearer counts.
    pub(super) fn would_touch(&self, object: u32, path: &[Point], metres: f64) -> bool {
        let Some(handle) = self.handles[object as usize] else {
            return false;
        };
        let footprint = &self.low[slot(handle)];
        let reach = self.radius + TOUCH + metres;
        // An agent that is already nearer may still move away.
        let reach = path
            .first()
            .map_or(reach, |at| reach.min(footprint.gap(*at).distance - 1e-9));
        path.windows(2).any(|ends| {
            let by = [0, 1].map(|axis| ends[1][axis] - ends[0][axis]);
            footprint.time_within(ends[0], by, reach).is_some()
        })
    }

    /// Whether an object is near enough to the agent for a contact to continue.
    pub(super) fn is_still_touched(&self, object: u32, at: [f32; 2]) -> bool {
        self.handles[object as usize].is_some_and(|handle| {
            let gap = self.low[slot(handle)].gap(at.map(f64::from));
            gap.distance <= self.radius + RELEASE
        })
    }
}

/// Adds an object to a list. Duplicates are removed when the list is sorted.
fn record(met_objects: &mut Vec<u32>, object: u32) {
    // Enough capacity for most steps, so that they do not allocate.
    met_objects.reserve(64);
    met_objects.push(object);
}
