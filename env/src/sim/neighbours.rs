//! Chooses the pushable bodies that move in a time step: those that are moving or that the agent may meet, and those that these
//! may meet in turn.
//!
//! The cost of physics grows with the number of contacts, and in a heap all bodies are in contact. So the number of contacts
//! per time step is limited. Bodies beyond the limit stand still in this time step, and are at rest after it.

use rapier3d::prelude::ColliderHandle;

use super::budget::Budget;
use super::collision_world::{CollisionWorld, slot};
use super::groups::{SOLID, WALL};
use super::sim_ref::SimRef;
use super::warning::Warning;

/// Margin in metres, added to the bodies' paths, within which they count as able to meet.
pub(super) const MARGIN: f32 = 0.2;

/// Maximum number of bodies checked around all bodies that may move.
const MAX_QUERIES: u64 = 200_000;

/// Maximum number of possible encounters of all moving bodies with other bodies on their paths in a time step.
const MAX_ENCOUNTERS: u64 = 40_000;

/// Maximum number of moving bodies, times the number of physics steps in the time step.
const MAX_MOVES: u64 = 36_000;

/// Maximum number of initial overlaps of moving bodies, by bounding boxes, times the number of physics steps; and a lower bound
/// of that maximum.
const MAX_OVERLAPS: u64 = 30_000;
const MIN_OVERLAP_LIMIT: u64 = 1_500;

/// Maximum number of pairs of bodies near each other while they move, times the number of physics steps; and a lower bound of
/// that maximum.
const MAX_PAIRS: u64 = 60_000;
const MIN_PAIR_LIMIT: u64 = 4_000;

/// Maximum number of bodies that are checked around one body, that it may meet, and that it overlaps. A body in contact with
/// many others at once would cost more than its share.
const MAX_QUERIES_PER_BODY: usize = 8192;
const MAX_ENCOUNTERS_PER_BODY: usize = 1024;
const MAX_OVERLAPS_PER_BODY: usize = 256;

/// The bodies that move in a time step.
pub(super) struct Chosen {
    /// Indices among the pushed bodies, in ascending order.
    pub(super) indices: Vec<usize>,
    /// Whether the list contains all bodies that should move.
    pub(super) is_complete: bool,
    /// Maximum number of pairs that may be near each other while they move.
    pub(super) max_pairs: usize,
    /// Number of bodies checked.
    #[cfg(test)]
    pub(super) num_queries: u64,
}

/// The surroundings of one body.
#[derive(Default)]
struct Around {
    /// Other pushable bodies that it may meet, by index among the pushed bodies.
    neighbours: Vec<usize>,
    /// Number of bodies that it may meet.
    may_meet: usize,
    /// Number of bodies that it overlaps initially.
    overlaps: usize,
}

/// The bodies that move in a time step of `parts` physics steps: those in `first`, and those that these may meet.
pub(super) fn with_neighbours(sim: SimRef, first: Vec<usize>, seconds: f32, parts: u32) -> Chosen {
    let pushed = &sim.state.pushed;
    let radii = pushed.iter().map(|body| sim.body_radius(body.object));
    let widest = radii.fold(0.0, f32::max);
    let mut budget = Budget::new(MAX_QUERIES);
    let parts = u64::from(parts);
    let mut may_meet = Budget::new(MAX_ENCOUNTERS);
    let mut overlap = Budget::new(MIN_OVERLAP_LIMIT.max(MAX_OVERLAPS / parts));
    let max_moving = (MAX_MOVES / parts) as usize;
    let mut seen = vec![false; pushed.len()];
    for index in &first {
        seen[*index] = true;
    }
    let (mut queue, mut next) = (first, 0);
    let mut indices = Vec::new();
    while let Some(&index) = queue.get(next) {
        next += 1;
        let Some(around) = around_pushed(sim, index, seconds, widest, &mut budget) else {
            continue;
        };
        let fits = |left: Budget, count: usize| count as u64 <= left.left();
        if around.may_meet > MAX_ENCOUNTERS_PER_BODY || around.overlaps > MAX_OVERLAPS_PER_BODY {
            continue;
        }
        let is_full = indices.len() >= max_moving;
        if is_full || !fits(may_meet, around.may_meet) || !fits(overlap, around.overlaps) {
            continue;
        }
        may_meet.take(around.may_meet);
        overlap.take(around.overlaps);
        indices.push(index);
        for other in around.neighbours {
            if !std::mem::replace(&mut seen[other], true) {
                queue.push(other);
            }
        }
    }
    indices.sort_unstable();
    Chosen {
        is_complete: indices.len() == queue.len(),
        indices,
        max_pairs: MIN_PAIR_LIMIT.max(MAX_PAIRS / parts) as usize,
        #[cfg(test)]
        num_queries: MAX_QUERIES - budget.left(),
    }
}

/// The surroundings of a body that may move; `None` if they exceed the budget.
fn around_pushed(sim: SimRef, index: usize, seconds: f32, widest: f32, budget: &mut Budget) -> Option<Around> {
    let pushed = &sim.state.pushed;
    let object = pushed[index].object;
    let own = sim.views.bodies.handles[object]?;
    let at = sim.objects()[object].position;
    let radius = sim.body_radius(object);
    let reach = max_path_length(sim, index, seconds) + MARGIN;
    let box_around = |half: f32| [at.map(|metres| metres - half), at.map(|metres| metres + half)];
    let area = box_around(radius.max(0.05) + reach + 2.0 * widest);
    let own_box = sim.views.bodies.box_of(own);
    let surroundings = box_around(static_reach(sim, index, seconds));
    let mut around = Around::default();
    for (count, handle) in sim.views.bodies.around(SOLID | WALL, Some(own), area).enumerate() {
        if !budget.take(1) || count > MAX_QUERIES_PER_BODY {
            return None;
        }
        let other = sim.views.bodies.body_data[slot(handle)].object;
        let pushed_index = other.and_then(|other| {
            let other = other as usize;
            pushed.binary_search_by_key(&other, |body| body.object).ok()
        });
        let other_box = sim.views.bodies.box_of(handle);
        around.overlaps += usize::from(overlap(other_box, own_box));
        let may_be_met = if let Some(pushed_index) = pushed_index {
            let other = pushed[pushed_index].object;
            let to = sim.objects()[other].position;
            let distance = ((to[0] - at[0]).powi(2) + (to[1] - at[1]).powi(2)).sqrt();
            // The order of the sum matters for rounding.
            let way = max_path_length(sim, index, seconds);
            let is_near = distance < radius + sim.body_radius(other) + way + MARGIN;
            if is_near {
                around.neighbours.push(pushed_index);
            }
            is_near
        } else {
            overlap(other_box, surroundings)
        };
        around.may_meet += usize::from(may_be_met);
    }
    // The tree's order depends on its history, which a saved world does not contain.
    around.neighbours.sort_unstable();
    Some(around)
}

/// A warning about the first pushable object that overlaps with more bodies than allowed.
pub(super) fn heap_warning(sim: SimRef) -> Option<Warning> {
    let others = |object: usize| {
        let own = sim.views.bodies.handles[object];
        let area = own.map(|own| sim.views.bodies.box_of(own));
        area.into_iter()
            .flat_map(move |area| sim.views.bodies.around(SOLID | WALL, own, area))
    };
    let mut objects = sim.state.pushed.iter().map(|body| body.object);
    let object = objects.find(|object| others(*object).nth(MAX_OVERLAPS_PER_BODY).is_some())?;
    Some(Warning::Heap {
        object,
        bodies: others(object).count(),
        limit: MAX_OVERLAPS_PER_BODY,
    })
}

/// Upper bound of the path length of a pushed body in a time step, in metres.
pub(super) fn max_path_length(sim: SimRef, index: usize, seconds: f32) -> f32 {
    let agent_speed = sim.world.agent_params.max_linear_speed as f32;
    let [vx, vy] = sim.state.pushed[index].velocity;
    (vx * vx + vy * vy).sqrt().max(agent_speed) * seconds
}

/// Maximum distance from a pushed body's centre to static bodies that it may meet, in metres along each axis.
pub(super) fn static_reach(sim: SimRef, index: usize, seconds: f32) -> f32 {
    let radius = sim.body_radius(sim.state.pushed[index].object).max(0.05);
    radius + max_path_length(sim, index, seconds) + MARGIN
}

impl CollisionWorld {
    /// The bounding box of a body on the ground.
    fn box_of(&self, handle: ColliderHandle) -> [[f32; 2]; 2] {
        let area = self.colliders[handle].compute_aabb();
        [area.mins, area.maxs].map(|corner| [corner.x, corner.y])
    }
}

fn overlap(a: [[f32; 2]; 2], b: [[f32; 2]; 2]) -> bool {
    (0..2).all(|axis| a[0][axis] <= b[1][axis] && b[0][axis] <= a[1][axis])
}
