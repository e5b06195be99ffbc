//! What is worth doing in a world with doors and things: what pays, and then what ends the episode well. What must be done
//! before it is found in `plan.rs`.

use driftworld_spec::{EndCondition, Object, Stimulus};

use super::super::on_rails::{reacts_to, wanted};
use super::plan::{can_interact, usable};
use crate::sim::SimRef;

/// Something to be brought about.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Wish<'a> {
    /// Touching an object, or coming near it.
    Touch(u32),
    /// Interacting with an object that does nothing but pay.
    Use(u32),
    /// That a door opens, a switch is set off, a thing is picked up.
    Move(u32),
    /// That a thing lies near an object of a tag.
    Bring { thing: u32, tag: &'a str },
}

impl Wish<'_> {
    /// The object that it is about.
    pub(super) fn object(self) -> u32 {
        match self {
            Self::Touch(object) | Self::Use(object) | Self::Move(object) | Self::Bring { thing: object, .. } => object,
        }
    }
}

/// All wishes, those that come first before others: what pays; what ends the episode well; what is to be delivered and carried
/// by an agent that has a hand free for more.
pub(super) fn wishes(sim: SimRef) -> [Vec<Wish>; 3] {
    let paying: Vec<Wish> = wanted(sim).into_iter().map(|index| toward(sim, index as u32)).collect();
    let carried = sim.state.carried();
    let has_hand = carried.len() < sim.world.agent_params.carry_limit as usize;
    let is_carried = |wish: &Wish| matches!(wish, Wish::Bring { thing, .. } if carried.contains(thing));
    let (mut held, mut others): (Vec<Wish>, Vec<Wish>) = endings(sim).into_iter().partition(is_carried);
    // What was picked up last is put down first.
    let place = |wish: &Wish| carried.iter().position(|thing| *thing == wish.object());
    let last = held.iter().copied().max_by_key(place);
    held.retain(|wish| Some(*wish) == last);
    let is_touched = |index: &u32| ends_by_touch(sim, *index) && !paying.iter().any(|wish| wish.object() == *index);
    others.extend(
        (0..sim.objects().len() as u32)
            .filter(is_touched)
            .map(|index| toward(sim, index)),
    );
    if held.is_empty() || has_hand {
        [paying, others, held]
    } else {
        [paying, held, others]
    }
}

/// Whether an object is there whose touch is a success.
fn ends_by_touch(sim: SimRef, index: u32) -> bool {
    let object = &sim.world.objects[index as usize];
    let mut conditions = sim.world.rules.success.iter();
    sim.objects()[index as usize].present && conditions.any(|condition| condition.is_touch_of(object))
}

/// What makes an object pay, or counts as touching it.
pub(super) fn toward(sim: SimRef, index: u32) -> Wish<'static> {
    let (object, own) = (&sim.world.objects[index as usize], &sim.objects()[index as usize]);
    if moving(object, own.open).any(|list| list.iter().any(|stimulus| reacts_to(object, *stimulus))) {
        return Wish::Move(index);
    }
    let by_hand = reacts_to(object, Stimulus::AgentInteract) && can_interact(sim.world);
    if by_hand { Wish::Use(index) } else { Wish::Touch(index) }
}

/// What ends the episode well: doors that are to be open, things that are to be carried or delivered.
fn endings(sim: SimRef) -> Vec<Wish> {
    let (world, states) = (sim.world, sim.objects());
    let mut found = Vec::new();
    let of_tag = |tag: &str| {
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
                found.extend(of_tag(tag).filter(is_closed).map(Wish::Move));
            }
            EndCondition::Carried(tag) => {
                let lies =
                    |index: &u32| world.objects[*index as usize].portable.is_some() && states[*index as usize].present;
                found.extend(of_tag(tag).filter(lies).map(Wish::Move));
            }
            EndCondition::Delivered(delivery) => {
                let is_there = |index: u32| {
                    let at = |index: u32| states[index as usize].position.map(f64::from);
                    let near = |other: u32| {
                        let ([ax, ay], [bx, by]) = (at(index), at(other));
                        (ax - bx).powi(2) + (ay - by).powi(2) <= delivery.within * delivery.within
                    };
                    states[index as usize].present && of_tag(&delivery.to).any(near)
                };
                let is_left = |index: &u32| {
                    let (object, own) = (&world.objects[*index as usize], &states[*index as usize]);
                    object.portable.is_some() && (own.present || own.carried) && !is_there(*index)
                };
                found.extend(of_tag(&delivery.tag).filter(is_left).map(|thing| Wish::Bring {
                    thing,
                    tag: &delivery.to,
                }));
            }
            _ => {}
        }
    }
    before_their_turn(sim, found)
}

/// Wishes, or what has to have its turn in the sequence before them.
fn before_their_turn<'a>(sim: SimRef<'a>, found: Vec<Wish<'a>>) -> Vec<Wish<'a>> {
    let (world, states) = (sim.world, sim.objects());
    let is_due = |object: &Object| sim.state.is_due(object.order);
    if found.iter().all(|wish| is_due(&world.objects[wish.object() as usize])) {
        return found;
    }
    let comes_first = |index: &u32| {
        let (object, own) = (&world.objects[*index as usize], &states[*index as usize]);
        object.order.is_some() && !own.collected && own.present && is_due(object) && object.is_used()
    };
    let first = (0..states.len() as u32).filter(comes_first).map(Wish::Move);
    let due = found
        .iter()
        .copied()
        .filter(|wish| is_due(&world.objects[wish.object() as usize]));
    due.chain(first).collect()
}

/// The stimulus by which a door opens, a switch is set off or a thing is picked up, if the agent can bring it about.
pub(super) fn moving_stimulus(sim: SimRef, index: u32) -> Option<Stimulus> {
    let (object, own) = (&sim.world.objects[index as usize], &sim.objects()[index as usize]);
    moving(object, own.open).find_map(|list| usable(sim.world, index, list))
}

/// The lists of stimuli by which an object opens, is set off and is picked up.
fn moving(object: &Object, is_open: bool) -> impl Iterator<Item = &Vec<Stimulus>> {
    let opens = object.door.as_ref().filter(|_| !is_open).map(|door| &door.opens_on);
    let lists = [
        opens,
        object.switch.as_ref().map(|switch| &switch.on),
        object.portable.as_ref().map(|portable| &portable.on),
    ];
    lists.into_iter().flatten()
}
