//! Turns encounters into stimuli, and applies their effects: rewards, destruction and reactions.

use std::sync::Arc;

use driftworld_spec::{Stimulus, Trigger, World};

use super::action::Intent;
use super::contact::RELEASE;
use super::doors::advance_doors;
use super::encounters::Encounters;
use super::energy::give_energy;
use super::event::{Effect, Event, Step};
use super::footprint::squared_distance;
use super::rng::ObjectRng;
use super::sim_ref::SimRef;
use super::state::SimState;
use super::things::{apply_effect, effect_of, follow, put_down, put_down_place, reacting_object, reacts_to_stimulus};
use super::ticks::ticks_of;
use super::views::Views;

/// Lists reused by each time step.
#[derive(Default)]
pub(super) struct Stimuli {
    reached: Vec<u32>,
    triggered: Vec<(u32, Stimulus)>,
}

/// The context for applying stimuli: the initial world, and the objects' tags.
#[derive(Clone, Copy)]
pub(super) struct Objects<'a> {
    pub(super) world: &'a World,
    pub(super) tags: &'a [Option<Arc<str>>],
}

/// Finds the stimuli of the time step's encounters, and applies them.
pub(super) fn apply_stimuli(
    objects: Objects,
    state: &mut SimState,
    views: &mut Views,
    intent: Intent,
    encounters: &mut Encounters,
    stimuli: &mut Stimuli,
    step: &mut Step,
) {
    let world = objects.world;
    let Stimuli { reached, triggered } = stimuli;
    triggered.clear();
    triggered.reserve(32);
    encounters.moved.sort_unstable_by_key(|(index, _)| *index);
    encounters.returned.sort_unstable();
    update_contacts(world, state, views, encounters, triggered);
    if intent.interact {
        views
            .bodies
            .in_reach(state.agent.position, state.agent.forward(), reached);
        triggered.extend(reached.iter().map(|index| (*index, Stimulus::AgentInteract)));
    }
    // An interaction affects one object: the one in front or, if there is none, the carried one.
    let mut put_down_now = None;
    let hand_target = (intent.interact && state.has_things)
        .then(|| {
            let sim = SimRef { world, state, views };
            let reacting = reacting_object(sim, reached);
            put_down_now = reacting.is_none().then(|| put_down_place(sim)).flatten();
            reacting
        })
        .flatten();
    for number in 0..state.ranged.len() {
        let index = state.ranged[number] as usize;
        let object = &world.objects[index];
        let reach = object.range_stimulus_distance;
        let sim = SimRef { world, state, views };
        let was_in_range = state.objects[index].in_range;
        let is_level = object.range_trigger == Trigger::Level;
        let enters = (!was_in_range || is_level) && enters_range(sim, index, encounters);
        if enters {
            triggered.push((index as u32, Stimulus::AgentInRange));
        }
        let is_in_range = (was_in_range || enters) && is_within(sim, index, reach + RELEASE);
        state.objects[index].in_range = is_in_range;
    }
    triggered.sort_unstable();
    triggered.dedup();
    let num_returning = state.returning.len();
    for &(index, stimulus) in triggered.iter() {
        if let Some(event) = trigger(objects, state, views, (index as usize, hand_target), stimulus) {
            step.reward += event.reward;
            step.events.push(event);
        }
    }
    if state.has_things {
        // A key may have been consumed by a door in this very time step.
        if let Some((index, place)) = put_down_now.filter(|(index, _)| state.carried.contains(index)) {
            put_down(world, state, views, index, place);
            let sim = SimRef { world, state, views };
            // Being near the object after putting it down is not an event.
            state.objects[index as usize].in_range = is_in_range(sim, index as usize);
            step.events.push(Event {
                object: index as usize,
                tag: objects.tags[index as usize].clone(),
                stimulus: Stimulus::AgentInteract,
                reward: 0.0,
                destroyed: false,
                effect: Some(Effect::PutDown),
            });
        }
        follow(state);
        advance_doors(world, state, views);
    }
    if state.returning.len() > num_returning {
        state.returning.sort_unstable_by_key(|(index, _)| *index);
    }
    let states = &state.objects;
    state.contacts.retain(|contact| states[*contact as usize].present);
}

/// Marks everything that is touched or near now as already met, without events.
pub(super) fn init_contacts(world: &World, state: &mut SimState, views: &mut Views) {
    state.contacts.clear();
    views
        .bodies
        .record_touched_now(state.agent.position, &mut state.contacts);
    state.contacts.sort_unstable();
    for index in 0..state.objects.len() {
        state.objects[index].in_range = is_in_range(SimRef { world, state, views }, index);
    }
}

/// Updates contacts that begin or end.
fn update_contacts(
    world: &World,
    state: &mut SimState,
    views: &mut Views,
    encounters: &mut Encounters,
    triggered: &mut Vec<(u32, Stimulus)>,
) {
    let here = state.agent.position;
    let Encounters {
        met_objects,
        lasting,
        moved,
        ..
    } = encounters;
    views.bodies.record_touched_now(here, met_objects);
    met_objects.sort_unstable();
    met_objects.dedup();
    let contacts = &mut state.contacts;
    contacts.reserve(met_objects.len().max(16));
    let known = contacts.len();
    for index in met_objects.drain(..) {
        if contacts[..known].binary_search(&index).is_err() {
            triggered.push((index, Stimulus::AgentCollide));
            contacts.push(index);
        } else if world.objects[index as usize].contact_trigger == Trigger::Level {
            triggered.push((index, Stimulus::AgentCollide));
        }
    }
    contacts.sort_unstable();
    let stays = |index: &u32| {
        // A newly touched object that moved in this time step counts as in contact after the agent's motion.
        let is_new = triggered.binary_search_by_key(index, |(other, _)| *other).is_ok();
        let has_moved = || {
            moved
                .binary_search_by_key(&(*index as usize), |(other, _)| *other)
                .is_ok()
        };
        is_new && has_moved() || lasting.binary_search(index).is_ok() || views.bodies.is_still_touched(*index, here)
    };
    contacts.retain(stays);
}

/// Whether the agent is in an object's range anywhere along their paths in this time step.
fn enters_range(sim: SimRef, index: usize, encounters: &Encounters) -> bool {
    if encounters.returned.binary_search(&index).is_ok() || is_in_range(sim, index) {
        return is_in_range(sim, index);
    }
    let to = sim.objects()[index].position.map(f64::from);
    let bodies = &sim.views.bodies;
    let moved = &encounters.moved;
    let nearest = if let Ok(found) = moved.binary_search_by_key(&index, |(other, _)| *other) {
        // In the agent's frame, the object moves from its old to its new relative position.
        let from = moved[found].1.map(f64::from);
        let (path_start, ends) = (bodies.path_start(), sim.agent().position);
        let then = [0, 1].map(|axis| from[axis] - f64::from(path_start[axis]));
        let now = [0, 1].map(|axis| to[axis] - f64::from(ends[axis]));
        squared_distance([0.0; 2], then, now)
    } else {
        let path = bodies.path().windows(2);
        path.map(|ends| squared_distance(to, ends[0], ends[1]))
            .fold(f64::INFINITY, f64::min)
    };
    is_covered(sim, index, nearest, sim.world.objects[index].range_stimulus_distance)
}

/// Applies one stimulus to one object. `None` if the object is gone. `hand_target` is the object that an interaction affects.
fn trigger(
    objects: Objects,
    state: &mut SimState,
    views: &mut Views,
    (index, hand_target): (usize, Option<u32>),
    stimulus: Stimulus,
) -> Option<Event> {
    let (world, object) = (objects.world, &objects.world.objects[index]);
    if !state.objects[index].present {
        return None;
    }
    let once = object.reward_once_stimulus.contains(&stimulus);
    let would_pay = once || object.reward_stimulus.contains(&stimulus);
    // Out of turn, an object neither pays nor disappears; otherwise the sequence could not be finished.
    let due = state.is_due(object.order);
    let destroyed = due && object.destroy_stimulus.contains(&stimulus);
    let concerns_hand = stimulus != Stimulus::AgentInteract || hand_target == Some(index as u32);
    let effect = (object.is_used() && !destroyed && concerns_hand)
        .then(|| effect_of(world, state, index, stimulus))
        .flatten();
    // An object that should react to a stimulus pays for it only if it does react; closing a door does not pay.
    let is_moved = effect.is_some_and(|effect| effect != Effect::Closed);
    let would_pay = would_pay && (is_moved || destroyed || !due || !reacts_to_stimulus(object, stimulus));
    let probability = object.reward_probability;
    // An object that always pays draws no random number.
    let pull = |rng: &mut ObjectRng| rng.pull(probability);
    let pays = would_pay && due && state.rng_of(index).is_none_or(pull);
    let own = &mut state.objects[index];
    let reward = if pays {
        own.reward
    } else if would_pay && !due {
        world.rules.order_penalty
    } else {
        0.0
    };
    let gives_energy = destroyed || pays && !(once && own.collected);
    // Reacting also advances a sequence, even if the object pays nothing.
    own.collected |= pays || destroyed || (is_moved && object.order.is_some());
    own.present = !destroyed;
    if pays && once {
        own.reward = 0.0;
    }
    if destroyed || (pays && once) {
        views.sync_object(index, object, own);
    }
    if gives_energy {
        give_energy(world, state, object.energy);
    }
    state.advance_sequence();
    if let Some(effect) = effect {
        apply_effect(world, state, views, index, effect);
    }
    if let (true, Some(respawn)) = (destroyed, &object.respawn) {
        let ticks = ticks_of(respawn.delay, world.agent_params.time_step);
        state.returning.push((index, state.ticks + ticks));
    }
    Some(Event {
        object: index,
        tag: objects.tags[index].clone(),
        stimulus,
        reward,
        destroyed,
        effect,
    })
}

/// Whether the agent is in an object's range, measured between the centres in 3D, each at half of its body's height.
fn is_in_range(sim: SimRef, index: usize) -> bool {
    is_within(sim, index, sim.world.objects[index].range_stimulus_distance)
}

fn is_within(sim: SimRef, index: usize, reach: f64) -> bool {
    let [x, y] = sim.state.offset_to(index).map(f64::from);
    is_covered(sim, index, x * x + y * y, reach)
}

/// Whether an object is within `reach` at a distance on the ground, given as its square.
fn is_covered(sim: SimRef, index: usize, squared: f64, reach: f64) -> bool {
    if reach <= 0.0 || !sim.objects()[index].present {
        return false;
    }
    let item = &sim.scene().items[index];
    let height = f64::from(item.body.height * item.scale);
    let dz = (height - sim.world.agent_params.agent_height) / 2.0;
    squared + dz * dz < reach * reach
}
