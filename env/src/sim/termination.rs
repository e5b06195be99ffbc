//! What the world's rules make of where things stand: the potential of its shaping, and what ends an episode. What
//! objects pay is in `interactions.rs`.

use driftworld_spec::{EndCondition, Object, Stimulus, World, ZoneEnd};

use super::event::Step;
use super::state::{ObjectState, SimState};

/// The potential that the world's shaping gives to this moment; 0 without shaping and where nothing draws the agent.
pub(super) fn potential(world: &World, state: &SimState) -> f64 {
    let Some(shaping) = &world.rules.shaping else {
        return 0.0;
    };
    let nearest = match &shaping.toward {
        Some(tag) => state.nearest(world, |object, own| own.present && object.tag.as_ref() == Some(tag)),
        None => state.nearest(world, |object, own| pays_now(object, own) && state.is_due(object.order)),
    };
    nearest.map_or(0.0, |index| {
        let [x, y] = state.way_to(index).map(f64::from);
        -shaping.scale * (x * x + y * y).sqrt()
    })
}

/// Notes whether the step so far ended the episode by itself, and how. `had_targets`: whether there ever was a target; `zone`: how a
/// zone ends it.
pub(super) fn check_termination(
    world: &World,
    state: &SimState,
    had_targets: bool,
    zone: Option<ZoneEnd>,
    step: &mut Step,
) {
    let earned = state.unshaped + step.reward;
    let holds = |condition: &EndCondition| match condition {
        EndCondition::AllCollected => {
            let mut objects = world.objects.iter().zip(&state.objects);
            had_targets && !objects.any(|(object, own)| pays_now(object, own))
        }
        EndCondition::Touch(tag) => step
            .events
            .iter()
            .any(|event| event.stimulus != Stimulus::AgentInRange && event.tag.as_deref() == Some(tag.as_str())),
        EndCondition::ReturnAtLeast(bound) => earned >= *bound,
        EndCondition::ReturnAtMost(bound) => earned <= *bound,
    };
    let success = world.rules.success.iter().any(holds) || zone == Some(ZoneEnd::Success);
    let failed = !success && (zone.is_some() || world.rules.failure.iter().any(holds));
    (step.success, step.terminated) = (success, success || failed);
}

/// Whether an object is a target that is there and still pays.
pub(super) fn pays_now(object: &Object, state: &ObjectState) -> bool {
    object.is_target() && state.present && state.reward > 0.0
}
