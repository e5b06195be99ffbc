//! Respawns destroyed objects at free positions near their start positions.

use driftworld_spec::World;

use super::budget::{self, Budget, SharedBudget};
use super::encounters::Encounters;
use super::sim_ref::SimRef;
use super::state::SimState;
use super::views::Views;
use super::walls;

/// Respawns the destroyed objects that are due.
pub(super) fn respawn(world: &World, state: &mut SimState, views: &mut Views, encounters: &mut Encounters) {
    let now = state.ticks;
    let mut returning = std::mem::take(&mut state.returning);
    let num_waiting = returning.len();
    let count = budget::RETURNS + budget::PER_RETURN * num_waiting as u64;
    let mut budget = SharedBudget::new(count, num_waiting, now);
    let queries_per_position = if num_waiting > 0 {
        1 + num_wall_corners(world)
    } else {
        0
    };
    let mut number = 0;
    returning.retain(|&(index, due)| {
        number += 1;
        let is_back =
            due <= now && try_respawn(world, state, views, index, queries_per_position, budget.at(number - 1));
        if is_back {
            encounters.returned.push(index);
        }
        !is_back
    });
    state.returning = returning;
    #[cfg(test)]
    (encounters.num_queries += count - budget.left());
}

/// Number of corners of the world's walls.
fn num_wall_corners(world: &World) -> usize {
    world.obstacles().map(<[_]>::len).sum()
}

/// Puts an object back at a free position; false if none is found in this time step. Each position that is tried takes
/// `queries_per_position` queries.
fn try_respawn(
    world: &World,
    state: &mut SimState,
    views: &mut Views,
    index: usize,
    queries_per_position: usize,
    budget: &mut Budget,
) -> bool {
    /// Maximum number of positions to try per time step.
    const MAX_TRIES: u32 = 16;
    let object = &world.objects[index];
    let Some(respawn) = &object.respawn else { return true };
    views.bodies.place_agent(state.agent.position);
    let radius = SimRef { world, state, views }.body_radius(index);
    let start = object.coordinates.map(|metres| metres as f32);
    for _ in 0..MAX_TRIES {
        if !budget.take(queries_per_position) {
            return false;
        }
        // Every object that respawns has its own random numbers, created with the state or when the object was spawned.
        let Some(rng) = state.rng_of(index) else { return true };
        let [out, around] = rng.draw_position().map(|unit| unit as f32);
        let distance = respawn.radius as f32 * out.sqrt();
        let angle = std::f32::consts::TAU * around;
        let position = [
            start[0] + distance * libm::cosf(angle),
            start[1] + distance * libm::sinf(angle),
        ];
        let in_wall = walls::obstacle(world, position.map(f64::from), f64::from(radius)).is_some();
        if !in_wall && views.bodies.is_free(position, radius, budget) {
            rng.record_return();
            let own = &mut state.objects[index];
            (own.position, own.heading_deg) = (position, object.heading as f32);
            (own.present, own.reward, own.in_range) = (true, object.reward, false);
            views.sync_object(index, object, own);
            if let Some(body) = state.pushed_of(index) {
                body.stop();
            }
            return true;
        }
    }
    false
}
