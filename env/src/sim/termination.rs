//! Checks whether an episode ends: by conditions of success and failure, and by zones.

use driftworld_spec::{Delivery, EndCondition, Object, Stimulus, World, ZoneEnd};

use super::event::{Effect, EndedBy, Event, Step};
use super::state::{ObjectState, SimState};

/// Records whether the step ended the episode by the world's rules, and how. `had_targets` is whether there ever was a target;
/// `zone` is the result with which a zone ends the episode, if one does.
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
            .any(|event| is_touch(event) && event.tag.as_deref() == Some(tag.as_str())),
        EndCondition::ReturnAtLeast(bound) => earned >= *bound,
        EndCondition::ReturnAtMost(bound) => earned <= *bound,
        EndCondition::Opened(tag) => state.doors.iter().any(|door| {
            let (object, own) = (&world.objects[door.object], &state.objects[door.object]);
            own.present && own.open && object.tag.as_ref() == Some(tag)
        }),
        EndCondition::Carried(tag) => {
            let mut carried = state.carried.iter().map(|index| &world.objects[*index as usize]);
            carried.any(|object| object.tag.as_ref() == Some(tag))
        }
        EndCondition::Delivered(delivery) => is_delivered(world, state, delivery),
        EndCondition::OutOfEnergy => world.agent_params.energy.is_some() && state.energy <= 0.0,
    };
    let first = |conditions: &[EndCondition]| conditions.iter().find(|one| holds(one)).map(reason);
    let by_zone = |end: ZoneEnd| (zone == Some(end)).then_some(EndedBy::Zone);
    let success = first(&world.rules.success).or_else(|| by_zone(ZoneEnd::Success));
    let failure = || first(&world.rules.failure).or_else(|| by_zone(ZoneEnd::Failure));
    step.ended_by = success.or_else(failure);
    (step.success, step.terminated) = (success.is_some(), step.ended_by.is_some());
}

/// The cause of an end by this condition.
fn reason(condition: &EndCondition) -> EndedBy {
    match condition {
        EndCondition::AllCollected => EndedBy::AllCollected,
        EndCondition::Touch(_) => EndedBy::Touch,
        EndCondition::Opened(_) => EndedBy::Opened,
        EndCondition::Carried(_) => EndedBy::Carried,
        EndCondition::Delivered(_) => EndedBy::Delivered,
        EndCondition::ReturnAtLeast(_) | EndCondition::ReturnAtMost(_) => EndedBy::Return,
        EndCondition::OutOfEnergy => EndedBy::Energy,
    }
}

/// Whether the agent touched or used the event's object.
fn is_touch(event: &Event) -> bool {
    event.stimulus != Stimulus::AgentInRange && event.effect != Some(Effect::PutDown)
}

/// The current states of the objects with a tag.
fn of_tag<'a>(world: &'a World, state: &'a SimState, tag: &'a str) -> impl Iterator<Item = &'a ObjectState> {
    let objects = world.objects.iter().zip(&state.objects);
    objects
        .filter(move |(object, _)| object.tag.as_deref() == Some(tag))
        .map(|(_, own)| own)
}

/// Whether everything to be delivered is in place.
fn is_delivered(world: &World, state: &SimState, delivery: &Delivery) -> bool {
    let mut count = 0;
    let lies_there = |own: &ObjectState| {
        let near = |other: &ObjectState| {
            let offset = [0, 1].map(|axis| f64::from(own.position[axis]) - f64::from(other.position[axis]));
            other.present && offset[0] * offset[0] + offset[1] * offset[1] <= delivery.within * delivery.within
        };
        own.present && of_tag(world, state, &delivery.to).any(near)
    };
    let mut remaining = of_tag(world, state, &delivery.tag).filter(|own| own.present || own.carried);
    let all_delivered = remaining.all(|own| {
        count += 1;
        lies_there(own)
    });
    all_delivered && count > 0
}

/// Whether an object is a present target that still pays.
pub(super) fn pays_now(object: &Object, state: &ObjectState) -> bool {
    object.is_target() && state.present && state.reward > 0.0
}
