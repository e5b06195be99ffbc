//! Rewards by the shaping's potential. `step.rs` adds them to those per step and per second, and to the rewards of objects
//! (`interactions.rs`) and zones (`zones.rs`).

use driftworld_spec::World;

use super::state::SimState;
use super::termination::pays_now;

/// The shaping reward of a step, from the potentials before and after it; the end of an episode has potential 0.
pub(super) fn shaping(world: &World, state: &SimState, before: f64, terminated: bool) -> Option<f64> {
    let shaping = world.rules.shaping.as_ref()?;
    let after = if terminated { 0.0 } else { potential(world, state) };
    Some(shaping.discount * after - before)
}

/// The shaping potential of the current state; 0 without shaping or without an object to approach.
pub(super) fn potential(world: &World, state: &SimState) -> f64 {
    let Some(shaping) = &world.rules.shaping else {
        return 0.0;
    };
    let nearest = match &shaping.toward {
        Some(tag) => state.nearest(world, |object, own| own.present && object.tag.as_ref() == Some(tag)),
        None => state.nearest(world, |object, own| pays_now(object, own) && state.is_due(object.order)),
    };
    nearest.map_or(0.0, |index| {
        let [x, y] = state.offset_to(index).map(f64::from);
        -shaping.scale * (x * x + y * y).sqrt()
    })
}
