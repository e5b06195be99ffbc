//! Reactions of doors, switches and portable objects to stimuli.

use driftworld_spec::{Object, Stimulus, SwitchAction, World};

use super::collision_world::{CollisionWorld, EDGE, slot};
use super::doors::{close_soon, open, waits_to_close};
use super::event::Effect;
use super::footprint::Point;
use super::groups::{SOLID, WALL};
use super::sim_ref::SimRef;
use super::state::SimState;
use super::views::Views;

/// Gap in metres between the agent's body and an object that it puts down. The object is within reach, but not touched.
const PUT_DOWN_GAP: f32 = 0.1;

/// Whether an object can react to a stimulus by opening, closing, switching doors, or being picked up.
pub(super) fn reacts_to_stimulus(object: &Object, stimulus: Stimulus) -> bool {
    let door = object.door.as_ref();
    let door = door.is_some_and(|door| door.opens_on.contains(&stimulus) || door.closes_on.contains(&stimulus));
    door || is_set_off(object, stimulus) || is_picked_up(object, stimulus)
}

fn is_set_off(object: &Object, stimulus: Stimulus) -> bool {
    let switch = object.switch.as_ref();
    switch.is_some_and(|switch| switch.on.contains(&stimulus))
}

fn is_picked_up(object: &Object, stimulus: Stimulus) -> bool {
    let portable = object.portable.as_ref();
    portable.is_some_and(|portable| portable.on.contains(&stimulus))
}

/// An object's current reaction to a stimulus; `None` if there is none.
pub(crate) fn effect_of(world: &World, state: &SimState, index: usize, stimulus: Stimulus) -> Option<Effect> {
    let (object, own) = (&world.objects[index], &state.objects[index]);
    if !own.present || !state.is_due(object.order) {
        return None;
    }
    if let Some(door) = &object.door {
        // A door that is waiting to close reacts like a closed one.
        let counts_as_closed = !own.open || waits_to_close(state, index);
        if counts_as_closed && door.opens_on.contains(&stimulus) && !is_locked(world, state, index) {
            return Some(Effect::Opened);
        }
        if !counts_as_closed && door.closes_on.contains(&stimulus) {
            return Some(Effect::Closed);
        }
    }
    if is_set_off(object, stimulus) {
        return Some(Effect::Switched);
    }
    let has_room = state.carried.len() < world.agent_params.carry_limit as usize;
    (has_room && is_picked_up(object, stimulus)).then_some(Effect::PickedUp)
}

/// Whether a door is locked, given what the agent carries.
fn is_locked(world: &World, state: &SimState, index: usize) -> bool {
    let key = world.objects[index].door.as_ref().and_then(|door| door.key.as_ref());
    key.is_some_and(|key| !state.is_unlocked(index) && carried_with_tag(world, state, key).is_none())
}

/// The index, in the list of carried objects, of the first one with a tag.
fn carried_with_tag(world: &World, state: &SimState, tag: &str) -> Option<usize> {
    let tag_of = |index: u32| world.objects[index as usize].tag.as_deref();
    state.carried.iter().position(|index| tag_of(*index) == Some(tag))
}

/// The object in reach that reacts to an interaction: the one whose body is nearest to the foremost point of the agent's body;
/// ties go to the first.
pub(crate) fn reacting_object(sim: SimRef, reached: &[u32]) -> Option<u32> {
    let agent = sim.agent();
    let (radius, [east, north]) = (sim.world.agent_params.agent_width / 2.0, agent.forward());
    let front = [
        f64::from(agent.position[0]) + radius * f64::from(east),
        f64::from(agent.position[1]) + radius * f64::from(north),
    ];
    let reacts = |index: &&u32| effect_of(sim.world, sim.state, **index as usize, Stimulus::AgentInteract).is_some();
    let distance = |index: u32| sim.views.bodies.distance_of(index, front).unwrap_or(f64::INFINITY);
    let candidates = reached.iter().filter(reacts).map(|index| (*index, distance(*index)));
    candidates
        .min_by(|(_, a), (_, b)| a.total_cmp(b))
        .map(|(index, _)| index)
}

/// The object that an interaction puts down if nothing reacts to the interaction, and where: the object picked up last,
/// directly in front of the agent. `None` if nothing is carried or there is no room.
pub(crate) fn put_down_place(sim: SimRef) -> Option<(u32, [f32; 2])> {
    let index = *sim.state.carried.last()?;
    let agent = sim.agent();
    let radius = sim.body_radius(index as usize);
    let ahead = sim.world.agent_params.agent_width as f32 / 2.0 + radius + PUT_DOWN_GAP;
    let [east, north] = agent.forward();
    let position = [agent.position[0] + east * ahead, agent.position[1] + north * ahead];
    // Documents allow no positions beyond this edge.
    let is_inside = position.iter().all(|metres| metres.abs() <= EDGE);
    let is_free = is_inside
        && sim
            .views
            .bodies
            .is_path_free(agent.position, position, f64::from(radius));
    is_free.then_some((index, position))
}

/// Applies an object's reaction.
pub(super) fn apply_effect(world: &World, state: &mut SimState, views: &mut Views, index: usize, effect: Effect) {
    let object = &world.objects[index];
    match effect {
        Effect::Opened => {
            unlock(world, state, index);
            open(world, state, views, index);
        }
        Effect::Closed => close_soon(state, index),
        Effect::Switched => {
            if let Some(switch) = &object.switch {
                for number in 0..state.doors.len() {
                    let door = state.doors[number].object;
                    if world.objects[door].tag.as_ref() == Some(&switch.target) && state.objects[door].present {
                        operate_door(world, state, views, door, switch.action);
                    }
                }
            }
        }
        Effect::PickedUp => {
            let own = &mut state.objects[index];
            (own.present, own.carried, own.in_range) = (false, true, false);
            views.sync_object(index, object, own);
            state.carried.push(index as u32);
        }
        // Putting down is the agent's action, not an object's reaction.
        Effect::PutDown => {}
    }
}

fn operate_door(world: &World, state: &mut SimState, views: &mut Views, door: usize, action: SwitchAction) {
    let counts_as_closed = !state.objects[door].open || waits_to_close(state, door);
    match action {
        SwitchAction::Open => open(world, state, views, door),
        SwitchAction::Toggle if counts_as_closed => open(world, state, views, door),
        SwitchAction::Close | SwitchAction::Toggle if !counts_as_closed => close_soon(state, door),
        SwitchAction::Close | SwitchAction::Toggle => {}
    }
}

/// Unlocks a door with its key, if it needs one, and removes the key if it is consumed.
fn unlock(world: &World, state: &mut SimState, index: usize) {
    let key = world.objects[index].door.as_ref().and_then(|door| door.key.as_deref());
    let (Some(key), Some(door)) = (key, state.doors.iter().position(|door| door.object == index)) else {
        return;
    };
    if state.doors[door].unlocked {
        return;
    }
    state.doors[door].unlocked = true;
    let Some(slot) = carried_with_tag(world, state, key) else {
        return;
    };
    let thing = state.carried[slot] as usize;
    if world.objects[thing]
        .portable
        .as_ref()
        .is_some_and(|portable| portable.consumed)
    {
        state.carried.remove(slot);
        (state.objects[thing].carried, state.objects[thing].collected) = (false, true);
    }
}

/// Puts down a carried object.
pub(super) fn put_down(world: &World, state: &mut SimState, views: &mut Views, index: u32, place: [f32; 2]) {
    state.carried.retain(|carried| *carried != index);
    let index = index as usize;
    let own = &mut state.objects[index];
    (own.position, own.present, own.carried) = (place, true, false);
    views.sync_object(index, &world.objects[index], own);
    if let Some(body) = state.pushed_of(index) {
        body.stop();
    }
}

/// Moves carried objects along with the agent.
pub(super) fn follow(state: &mut SimState) {
    for index in &state.carried {
        state.objects[*index as usize].position = state.agent.position;
    }
}

impl CollisionWorld {
    /// The distance between a point and an object's body up to the agent's height, in metres; `None` while it is absent.
    pub(super) fn distance_of(&self, object: u32, at: Point) -> Option<f64> {
        self.handles[object as usize].map(|handle| self.low[slot(handle)].gap(at).distance)
    }

    /// Whether a round body can move straight from one position to another without touching a wall or a solid object.
    pub(super) fn is_path_free(&self, from: [f32; 2], to: [f32; 2], radius: f64) -> bool {
        let reach = radius as f32 + 0.01;
        let area = [
            [0, 1].map(|axis| from[axis].min(to[axis]) - reach),
            [0, 1].map(|axis| from[axis].max(to[axis]) + reach),
        ];
        let (start, by) = (
            from.map(f64::from),
            [0, 1].map(|axis| f64::from(to[axis]) - f64::from(from[axis])),
        );
        let mut around = self.around(SOLID | WALL, None, area);
        !around.any(|handle| self.whole[slot(handle)].time_within(start, by, radius).is_some())
    }
}
