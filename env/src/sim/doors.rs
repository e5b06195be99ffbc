//! Opens and closes doors in response to events and to their own clocks.

use driftworld_spec::{Door, MotionModel, World};

use super::collision_world::slot;
use super::groups::{GHOST, SOLID};
use super::state::SimState;
use super::ticks::ticks_of;
use super::views::Views;

/// Minimum overlap in metres at which a body counts as standing in a door.
const INSIDE: f64 = 1e-6;

/// Opens a door. Opening an open door restarts its closing timer.
pub(super) fn open(world: &World, state: &mut SimState, views: &mut Views, index: usize) {
    let object = &world.objects[index];
    let after = object.door.as_ref().and_then(|door| door.closes_after);
    let closes_at = after.map(|seconds| state.ticks + ticks_of(seconds, world.agent_params.time_step));
    if let Some(door) = state.doors.iter_mut().find(|door| door.object == index) {
        door.closes_at = closes_at;
    }
    state.objects[index].open = true;
    views.sync_object(index, object, &state.objects[index]);
}

/// Makes an open door close at the end of this time step, or as soon as nothing stands in it.
pub(super) fn close_soon(state: &mut SimState, index: usize) {
    // Due since the last time step, so it already waits to close, unlike a door whose timer expires now.
    let due = state.ticks.saturating_sub(1);
    if let Some(door) = state.doors.iter_mut().find(|door| door.object == index) {
        door.closes_at = Some(door.closes_at.map_or(due, |tick| tick.min(due)));
    }
}

/// Whether an open door was due to close in an earlier time step, and waits until nothing stands in it.
pub(super) fn waits_to_close(state: &SimState, index: usize) -> bool {
    let closes_at = state.door_of(index).and_then(|door| door.closes_at);
    state.objects[index].open && closes_at.is_some_and(|tick| tick < state.ticks)
}

/// Advances doors at the end of a time step: first their clocks, then closes doors that are due and free.
pub(super) fn advance_doors(world: &World, state: &mut SimState, views: &mut Views) {
    for number in 0..state.doors.len() {
        let index = state.doors[number].object;
        let Some(door) = world.objects[index]
            .door
            .as_ref()
            .filter(|_| state.objects[index].present)
        else {
            continue;
        };
        if let Some(should_be_open) = clock(door, state.ticks, world.agent_params.time_step) {
            match (should_be_open, state.objects[index].open) {
                (true, _) => open(world, state, views, index),
                (false, true) => close_soon(state, index),
                (false, false) => {}
            }
        }
        let is_due = state.doors[number].closes_at.is_some_and(|tick| tick <= state.ticks);
        if is_due && state.objects[index].open && !is_obstructed(world, state, views, index) {
            state.doors[number].closes_at = None;
            state.objects[index].open = false;
            views.sync_object(index, &world.objects[index], &state.objects[index]);
        }
    }
}

/// Whether a door's clock opens or closes it in this time step; `None` if neither.
fn clock(door: &Door, ticks: u64, time_step: f64) -> Option<bool> {
    let half = door.period? / 2.0;
    let halves = |ticks: u64| (ticks as f64 * time_step / half + 1e-6).floor() as u64;
    let now = halves(ticks);
    (now != halves(ticks.saturating_sub(1))).then_some(door.open == now.is_multiple_of(2))
}

/// Whether the agent or a movable body stands in a door.
fn is_obstructed(world: &World, state: &SimState, views: &mut Views, index: usize) -> bool {
    if !world.objects[index].solid {
        return false;
    }
    let bodies = &mut views.bodies;
    let Some(handle) = bodies.handles[index] else {
        return false;
    };
    let own = slot(handle);
    let agent = state.agent.position.map(f64::from);
    if bodies.low[own].gap(agent).distance < bodies.radius - INSIDE {
        return true;
    }
    let mut overlap = std::mem::take(&mut bodies.scratch.doorway);
    let moves = |other: usize| {
        let object = &world.objects[other];
        let by_itself = object.motion_model != MotionModel::Stationary;
        object.door.is_none() && (by_itself || object.pushable.is_some() || object.portable.is_some())
    };
    let corners = &bodies.whole[own].corners;
    let side = |axis: usize, sign: f64| {
        let far = corners
            .iter()
            .map(|corner| corner[axis] * sign)
            .fold(f64::NEG_INFINITY, f64::max);
        ((far + bodies.whole[own].rounding) * sign) as f32
    };
    let area = [-1.0, 1.0].map(|sign| [side(0, sign), side(1, sign)]);
    let is_obstructed = bodies.around(SOLID | GHOST, Some(handle), area).any(|other| {
        let number = slot(other);
        let moves = bodies.body_data[number]
            .object
            .is_some_and(|object| moves(object as usize));
        moves && {
            bodies.whole[own].widen_into(&bodies.whole[number], &mut overlap);
            overlap.gap([0.0; 2]).distance < -INSIDE
        }
    });
    bodies.scratch.doorway = overlap;
    is_obstructed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clock_toggles_its_door_every_half_period() {
        for (is_open, time_step) in [(false, 0.1), (true, 0.1), (false, 0.3)] {
            let door = Door {
                period: Some(2.0),
                open: is_open,
                ..Door::default()
            };
            let mut now = is_open;
            for tick in 1..1000_u64 {
                now = clock(&door, tick, time_step).unwrap_or(now);
                let halves = (tick as f64 * time_step + 1e-6).floor() as u64;
                assert_eq!(now, is_open == halves.is_multiple_of(2), "tick {tick}");
            }
        }
        assert_eq!(clock(&Door::default(), 7, 0.1), None);
    }
}
