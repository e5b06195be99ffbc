//! Lists the [`Goal`]s in a world: those that pay, then those that end the episode in success. `plan.rs`
//! finds the subgoals that come first.

use driftworld_spec::{ActionModel, ActionSpace, EndCondition, Object, Stimulus, World};

use super::super::tiers::{reacts_to, wanted};
use crate::sim::SimRef;

/// Something the agent wants to achieve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Goal<'a> {
    /// Touch an object or come near it.
    Touch(u32),
    /// Interact with an object that only pays.
    Use(u32),
    /// Open a door, set off a switch or pick up a thing.
    Activate(u32),
    /// Put a thing down near an object with a tag.
    Bring { thing: u32, tag: &'a str },
}

impl Goal<'_> {
    /// The object to act on.
    pub(super) fn object(self) -> u32 {
        match self {
            Self::Touch(object) | Self::Use(object) | Self::Activate(object) | Self::Bring { thing: object, .. } => {
                object
            }
        }
    }
}

/// All goals in three lists by priority: those that pay, those that end the episode in success, and the delivery of the thing
/// picked up last. That delivery comes second if the agent's hands are full.
pub(super) fn goals(sim: SimRef) -> [Vec<Goal>; 3] {
    let paying: Vec<Goal> = wanted(sim)
        .into_iter()
        .map(|index| goal_at(sim, index as u32))
        .collect();
    let carried = sim.state.carried();
    let has_free_hand = carried.len() < sim.world.agent_params.carry_limit as usize;
    let is_carried = |goal: &Goal| matches!(goal, Goal::Bring { thing, .. } if carried.contains(thing));
    let (mut held, mut others): (Vec<Goal>, Vec<Goal>) = endings(sim).into_iter().partition(is_carried);
    // The thing picked up last is put down first.
    let rank = |goal: &Goal| carried.iter().position(|thing| *thing == goal.object());
    let last = held.iter().copied().max_by_key(rank);
    held.retain(|goal| Some(*goal) == last);
    let is_touched =
        |index: &u32| ends_by_touch(sim, *index) && paying.binary_search_by_key(index, |goal| goal.object()).is_err();
    others.extend(
        (0..sim.objects().len() as u32)
            .filter(is_touched)
            .map(|index| goal_at(sim, index)),
    );
    if held.is_empty() || has_free_hand {
        [paying, others, held]
    } else {
        [paying, held, others]
    }
}

/// Whether an object is present and touching it is a success.
fn ends_by_touch(sim: SimRef, index: u32) -> bool {
    let object = &sim.world.objects[index as usize];
    let mut conditions = sim.world.rules.success.iter();
    sim.objects()[index as usize].present && conditions.any(|condition| condition.is_touch_of(object))
}

/// The goal that makes an object pay or counts as touching it.
pub(super) fn goal_at(sim: SimRef, index: u32) -> Goal<'static> {
    let (object, own) = (&sim.world.objects[index as usize], &sim.objects()[index as usize]);
    if activating_stimuli(object, own.open).any(|list| list.iter().any(|stimulus| reacts_to(object, *stimulus))) {
        return Goal::Activate(index);
    }
    let by_hand = reacts_to(object, Stimulus::AgentInteract) && can_interact(sim.world);
    if by_hand { Goal::Use(index) } else { Goal::Touch(index) }
}

/// Goals that end the episode in success: doors to open, things to carry or deliver.
fn endings(sim: SimRef) -> Vec<Goal> {
    let (world, states) = (sim.world, sim.objects());
    let mut found = Vec::new();
    let with_tag = |tag: &str| {
        let is_one = move |index: &u32, tag: &str| world.objects[*index as usize].tag.as_deref() == Some(tag);
        let tag = tag.to_owned();
        (0..states.len() as u32).filter(move |index| is_one(index, &tag))
    };
    for condition in &world.rules.success {
        match condition {
            EndCondition::Opened(tag) => {
                let is_closed = |index: &u32| {
                    let own = &states[*index as usize];
                    world.objects[*index as usize].door.is_some() && own.present && !own.open
                };
                found.extend(with_tag(tag).filter(is_closed).map(Goal::Activate));
            }
            EndCondition::Carried(tag) => {
                let is_on_the_ground =
                    |index: &u32| world.objects[*index as usize].portable.is_some() && states[*index as usize].present;
                found.extend(with_tag(tag).filter(is_on_the_ground).map(Goal::Activate));
            }
            EndCondition::Delivered(delivery) => {
                let is_there = |index: u32| {
                    let at = |index: u32| states[index as usize].position.map(f64::from);
                    let near = |other: u32| {
                        let ([ax, ay], [bx, by]) = (at(index), at(other));
                        (ax - bx).powi(2) + (ay - by).powi(2) <= delivery.within * delivery.within
                    };
                    states[index as usize].present && with_tag(&delivery.to).any(near)
                };
                let is_left = |index: &u32| {
                    let (object, own) = (&world.objects[*index as usize], &states[*index as usize]);
                    object.portable.is_some() && (own.present || own.carried) && !is_there(*index)
                };
                found.extend(with_tag(&delivery.tag).filter(is_left).map(|thing| Goal::Bring {
                    thing,
                    tag: &delivery.to,
                }));
            }
            _ => {}
        }
    }
    due_goals(sim, found)
}

/// The goals whose turn it is in the sequence; if some must wait, also the goals that come before them.
fn due_goals<'a>(sim: SimRef<'a>, found: Vec<Goal<'a>>) -> Vec<Goal<'a>> {
    let (world, states) = (sim.world, sim.objects());
    let is_due = |object: &Object| sim.state.is_due(object.order);
    if found.iter().all(|goal| is_due(&world.objects[goal.object() as usize])) {
        return found;
    }
    let comes_first = |index: &u32| {
        let (object, own) = (&world.objects[*index as usize], &states[*index as usize]);
        object.order.is_some() && !own.collected && own.present && is_due(object) && object.is_used()
    };
    let first = (0..states.len() as u32).filter(comes_first).map(Goal::Activate);
    let due = found
        .iter()
        .copied()
        .filter(|goal| is_due(&world.objects[goal.object() as usize]));
    due.chain(first).collect()
}

/// Whether the agent can interact at all.
pub(in crate::agents) fn can_interact(world: &World) -> bool {
    let agent = &world.agent_params;
    let has_row = match &agent.actions {
        ActionSpace::Discrete(table) => {
            agent.action_model == ActionModel::OnRails || table.iter().any(|row| row[2] > 0.5)
        }
        _ => true,
    };
    agent.interact && agent.action_model != ActionModel::ByWaypoint && has_row
}

/// The stimulus in a list that the agent can cause at an object; an interaction if possible.
pub(super) fn usable_stimulus(world: &World, object: u32, stimuli: &[Stimulus]) -> Option<Stimulus> {
    let has_range = world.objects[object as usize].range_stimulus_distance > 0.0;
    let can = |stimulus: &Stimulus| match stimulus {
        Stimulus::AgentInteract => can_interact(world),
        Stimulus::AgentCollide => true,
        Stimulus::AgentInRange => has_range,
    };
    let known = [Stimulus::AgentInteract, Stimulus::AgentCollide, Stimulus::AgentInRange];
    known
        .into_iter()
        .find(|stimulus| stimuli.contains(stimulus) && can(stimulus))
}

/// The stimulus that opens a door, sets off a switch or picks up a thing, if the agent can cause it.
pub(super) fn activating_stimulus(sim: SimRef, index: u32) -> Option<Stimulus> {
    let (object, own) = (&sim.world.objects[index as usize], &sim.objects()[index as usize]);
    activating_stimuli(object, own.open).find_map(|list| usable_stimulus(sim.world, index, list))
}

/// The stimuli that open an object, set it off or pick it up.
fn activating_stimuli(object: &Object, is_open: bool) -> impl Iterator<Item = &Vec<Stimulus>> {
    let opens = object.door.as_ref().filter(|_| !is_open).map(|door| &door.opens_on);
    let lists = [
        opens,
        object.switch.as_ref().map(|switch| &switch.on),
        object.portable.as_ref().map(|portable| &portable.on),
    ];
    lists.into_iter().flatten()
}
