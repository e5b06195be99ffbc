//! Moves the agent in a time step: it turns, pushes movable objects in its way, and slides along static ones.

use driftworld_spec::World;

use super::action::Intent;
use super::budget::{self, Budget};
use super::collision_world::{CollisionWorld, EDGE};
use super::encounters::Encounters;
use super::groups::{SOLID, WALL};
use super::pushing::push_bodies;
use super::slide::{Obstacles, SKIN};
use super::state::{SimState, entry, wrapped};
use super::views::Views;

/// Turns and moves the agent, and records the objects that it meets on the way.
pub(super) fn apply_action(
    world: &World,
    state: &mut SimState,
    views: &mut Views,
    intent: Intent,
    encounters: &mut Encounters,
) {
    let start = state.agent.position;
    state.agent.heading_deg = wrapped(state.agent.heading_deg + intent.turn_deg);
    let by = match intent.towards {
        Some((point, reach)) => {
            let way = [point[0] - start[0], point[1] - start[1]];
            let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
            let share = if length > reach { reach / length } else { 1.0 };
            way.map(|metres| metres * share)
        }
        None => state.agent.forward().map(|part| part * intent.ahead),
    };
    let by = push_bodies(world, state, views, by, encounters);
    let mut budget = Budget::new(budget::AGENTS);
    let position = slide(&mut views.bodies, start, by, &mut budget);
    #[cfg(test)]
    (encounters.num_queries += budget::AGENTS - budget.left());
    // Contacts with moving ghosts depend on both paths, so they are found after the ghosts have moved.
    let moves = |object: u32| entry(&state.movers, object as usize, |mover| mover.object).is_some();
    let skipped = |object: u32| !world.objects[object as usize].solid && moves(object);
    views
        .bodies
        .record_touched_on_path(&mut encounters.met_objects, skipped);
    let contacts = state.contacts.iter().copied();
    let still_touched = contacts.filter(|index| views.bodies.is_still_touched(*index, position));
    encounters.lasting.extend(still_touched);
    state.agent.position = position;
    let seconds = world.agent_params.time_step as f32;
    state.agent.velocity = [0, 1].map(|axis| (position[axis] - start[axis]) / seconds);
}

/// Moves the agent's body as far as solid objects allow, sliding along them; returns its new position.
///
/// It never passes through anything, however fast it moves. Stores the path for [`CollisionWorld::path`].
fn slide(bodies: &mut CollisionWorld, from: [f32; 2], by: [f32; 2], budget: &mut Budget) -> [f32; 2] {
    let start = from.map(f64::from);
    let way = by.map(f64::from);
    let length = (way[0] * way[0] + way[1] * way[1]).sqrt();
    bodies.scratch.path.clear();
    bodies.scratch.path.push(start);
    if length < 1e-6 {
        return from;
    }
    let to = [start[0] + way[0], start[1] + way[1]];
    let reach = bodies.radius + SKIN + 1e-3;
    bodies.gather(SOLID | WALL, None, [start, to], reach, &mut Budget::new(u64::MAX));
    let obstacles = Obstacles {
        footprints: &bodies.low,
        numbers: &bodies.scratch.numbers,
        num_corners: 0,
    };
    if obstacles.is_clear(start, way, bodies.radius) {
        bodies.scratch.path.push(to);
    } else {
        // It may be deflected in any direction, but moves no farther than intended.
        let whole = bodies.gather(SOLID | WALL, None, [start, start], length + 2.0 + reach, budget);
        let Some(num_corners) = whole else { return from };
        let mut scratch = std::mem::take(&mut bodies.scratch);
        let obstacles = Obstacles {
            footprints: &bodies.low,
            numbers: &scratch.numbers,
            num_corners,
        };
        let clear = obstacles.out_of_overlap(start, bodies.radius);
        if clear != start {
            scratch.path.push(clear);
        }
        obstacles.slide(
            clear,
            way,
            bodies.radius,
            budget,
            &mut scratch.touched,
            &mut scratch.path,
        );
        bodies.scratch = scratch;
    }
    let end = bodies.scratch.path.last().copied().unwrap_or(start);
    let mut place = end.map(|metres| metres as f32);
    if !place.iter().all(|metres| metres.is_finite()) {
        bodies.scratch.path.truncate(1);
        return from;
    }
    let inside = bodies.half.map(|half| half - (bodies.radius + SKIN) as f32);
    let is_within = (0..2).all(|axis| inside[axis] > 0.0 && from[axis].abs() <= inside[axis] + SKIN as f32);
    for axis in 0..2 {
        // Rounding must not move an agent inside the arena to the outside.
        if is_within {
            place[axis] = place[axis].clamp(-inside[axis], inside[axis]);
        }
        place[axis] = place[axis].clamp(-EDGE, EDGE);
    }
    if let Some(end) = bodies.scratch.path.last_mut() {
        *end = place.map(f64::from);
    }
    place
}
