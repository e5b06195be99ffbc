//! What counts as a touch, and how long it lasts. What a touch pays is in `interactions.rs`.
//!
//! A contact begins when the gap between the agent and an object is no wider than [`TOUCH`] anywhere on their ways, and
//! ends when it is wider than [`RELEASE`], both when the agent has moved and when the objects have: who follows another
//! at its heels stays in touch. These are places, not times: how often one pass touches does not depend on speed or
//! time step.

use super::budget::Budget;
use super::collision_world::{CollisionWorld, slot};
use super::footprint::Point;
use super::groups::{GHOST, SOLID};

/// Widest gap that is a touch, in metres: a little more than the skin.
const TOUCH: f64 = 0.03;

/// Widest gap at which a contact lasts, in metres; a range is left as far beyond its edge.
pub(super) const RELEASE: f64 = 0.25;

impl CollisionWorld {
    /// Notes the objects that the agent touched on its way of this time step, each once, but for those that are
    /// `skipped`.
    pub(super) fn note_passed(&mut self, met: &mut Vec<u32>, skipped: impl Fn(u32) -> bool) {
        let Some((mut least, mut most)) = self.path().first().map(|&start| (start, start)) else {
            return;
        };
        for point in self.path() {
            for axis in 0..2 {
                least[axis] = least[axis].min(point[axis]);
                most[axis] = most[axis].max(point[axis]);
            }
        }
        let reach = self.radius + TOUCH;
        self.gather(SOLID | GHOST, None, [least, most], reach, &mut Budget::new(u64::MAX));
        for &number in &self.scratch.numbers {
            let Some(object) = self.standing[number as usize].object else {
                continue;
            };
            let footprint = &self.low[number as usize];
            let touched = self.path().windows(2).any(|ends| {
                let by = [0, 1].map(|axis| ends[1][axis] - ends[0][axis]);
                footprint.time_within(ends[0], by, reach).is_some()
            });
            if touched && !skipped(object) {
                note(met, object);
            }
        }
    }

    /// Notes an object that touched the agent while it came `by` metres to where it is now, and the agent from one
    /// place to another.
    pub(super) fn note_passing(&self, object: u32, by: [f32; 2], agent: [[f32; 2]; 2], met: &mut Vec<u32>) {
        let Some(handle) = self.handles[object as usize] else {
            return;
        };
        let footprint = &self.low[slot(handle)];
        // As the object sees it.
        let [start, end] = agent.map(|at| at.map(f64::from));
        let from = [0, 1].map(|axis| start[axis] + f64::from(by[axis]));
        let way = [0, 1].map(|axis| end[axis] - from[axis]);
        if footprint.time_within(from, way, self.radius + TOUCH).is_some() {
            note(met, object);
        }
    }

    /// Notes the objects that the agent's body touches where it is now.
    pub(super) fn note_touching(&mut self, at: [f32; 2], met: &mut Vec<u32>) {
        let at: Point = at.map(f64::from);
        let reach = self.radius + TOUCH;
        self.gather(SOLID | GHOST, None, [at, at], reach, &mut Budget::new(u64::MAX));
        for &number in &self.scratch.numbers {
            if self.low[number as usize].gap(at).distance <= reach
                && let Some(object) = self.standing[number as usize].object
            {
                note(met, object);
            }
        }
    }

    /// Whether an agent that goes straight from place to place touches an object, or comes nearer to a touch than so many metres,
    /// without going away from it.
    pub(super) fn would_touch(&self, object: u32, path: &[Point], metres: f64) -> bool {
        let Some(handle) = self.handles[object as usize] else {
            return false;
        };
        let footprint = &self.low[slot(handle)];
        let reach = self.radius + TOUCH + metres;
        // Who is nearer already may go away.
        let reach = path
            .first()
            .map_or(reach, |at| reach.min(footprint.gap(*at).distance - 1e-9));
        path.windows(2).any(|ends| {
            let by = [0, 1].map(|axis| ends[1][axis] - ends[0][axis]);
            footprint.time_within(ends[0], by, reach).is_some()
        })
    }

    /// Whether an object is so near to the agent that a contact lasts.
    pub(super) fn is_still_touched(&self, object: u32, at: [f32; 2]) -> bool {
        self.handles[object as usize].is_some_and(|handle| {
            let gap = self.low[slot(handle)].gap(at.map(f64::from));
            gap.distance <= self.radius + RELEASE
        })
    }
}

/// What is noted twice is met once: who reads the list sorts it.
fn note(met: &mut Vec<u32>, object: u32) {
    // Room for what most steps touch, so that no step takes memory.
    met.reserve(64);
    met.push(object);
}
