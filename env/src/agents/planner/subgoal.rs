//! [`Subgoal`] walks to an object or zone, and acts there: touches, uses, waits or puts something down. `plan.rs` chooses it.

use driftworld_spec::{Stimulus, Zone};

use super::floor::{Floor, Room};
use super::goals::{activating_stimulus, can_interact};
use super::ground_shape::GroundShape;
use super::ways::{Delivery, Ways, is_to_collect};
use crate::agents::steering::{angle_to, is_narrow, seconds, step_back, step_to};
use crate::agents::tiers::by_worth;
use crate::ground;
use crate::polygon::distance;
use crate::sim::{SimRef, put_down_place, reacting_object};

/// Maximum angle in degrees between the agent's heading and an object that it faces.
const MAX_HEADING_ERROR: f32 = 8.0;

/// Maximum speed in m/s of an agent that counts as blocked.
const MAX_BLOCKED_SPEED: f32 = 0.3;

/// Distance to a wanted thing, in metres, within which an agent with full hands puts something down.
const PUT_DOWN_RANGE: f32 = 1.8;

/// Minimum distance in metres of things put down from things still to be picked up.
const MIN_SPACING: f32 = 1.0;

/// What to do at an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::agents) enum Act {
    /// Touch it.
    Touch,
    /// Interact with it.
    Use,
    /// Walk up to it.
    Near,
    /// Open it, set it off or pick it up.
    Activate,
    /// Stand in front of it until it opens by itself.
    Wait,
    /// Put this thing down near it.
    Bring {
        /// Its index.
        thing: u32,
    },
    /// Enter a zone; `object` is then the zone's index.
    Enter,
}

/// The next act, and where to perform it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Subgoal {
    pub(super) object: u32,
    pub(super) room: Room,
    pub(super) act: Act,
}

impl Subgoal {
    /// The next action, as speed, turn rate and interaction.
    ///
    /// `place` is the position of the target for which the path was found; it follows the target only roughly.
    pub(super) fn act(self, sim: SimRef, floor: &Floor, ways: &mut Ways, place: &mut [f64; 2]) -> [f64; 3] {
        match self.act {
            Act::Bring { thing } => self.bring(sim, floor, ways, thing),
            Act::Enter => self.enter(sim, floor, ways),
            Act::Touch | Act::Use | Act::Near | Act::Activate | Act::Wait => self.approach(sim, floor, ways, place),
        }
    }

    fn approach(self, sim: SimRef, floor: &Floor, ways: &mut Ways, place: &mut [f64; 2]) -> [f64; 3] {
        let stimulus = match self.act {
            Act::Use => Some(Stimulus::AgentInteract),
            Act::Activate => activating_stimulus(sim, self.object),
            _ => None,
        };
        let gap_to_object = distance(sim.agent().position, sim.objects()[self.object as usize].position);
        if self.act == Act::Activate && needs_a_free_hand(sim, self.object) && gap_to_object < PUT_DOWN_RANGE {
            return put_down(sim, self.object);
        }
        let by_hand = stimulus == Some(Stimulus::AgentInteract) && can_interact(sim.world);
        if by_hand && (self.is_at_hand(sim) || self.is_behind_another(sim)) {
            return [0.0, 0.0, 1.0];
        }
        // Only the start of a contact counts: back off before touching again.
        let counts = self.act == Act::Touch || stimulus == Some(Stimulus::AgentCollide);
        if counts && sim.state.touches(self.object as usize) {
            return step_back(sim);
        }
        let here = sim.agent().position;
        let shape = GroundShape::of(sim, self.object as usize);
        if floor.is_open_to(here, &shape) {
            ways.avoids_costs = true;
        } else {
            ways.lead_to(sim, floor, self.object, self.room, place);
            if let Some(point) = ways.next(floor, here) {
                return walk(sim, point, 0.3);
            }
        }
        let at = shape.at;
        let gap = shape.distance(here) - floor.body;
        if self.act == Act::Wait && gap < 0.4 || by_hand && gap < 0.15 && !is_facing(sim, at) {
            return [0.0, turn(sim, at), 0.0];
        }
        walk(sim, at, if by_hand { 0.1 } else { 0.5 })
    }

    /// Whether this object would react to an interaction now.
    fn is_at_hand(self, sim: SimRef) -> bool {
        let reached = reached(sim);
        match self.act {
            Act::Use => reached.contains(&self.object),
            _ => reacting_object(sim, &reached) == Some(self.object),
        }
    }

    /// Whether a different thing would react, although the agent faces the wanted one and is as close as it can get. The agent
    /// then picks up that thing and puts it down elsewhere.
    fn is_behind_another(self, sim: SimRef) -> bool {
        let object = &sim.world.objects[self.object as usize];
        if self.act != Act::Activate || object.portable.is_none() {
            return false;
        }
        let reached = reached(sim);
        let at = sim.objects()[self.object as usize].position;
        let gap = distance(sim.agent().position, at) - sim.world.agent_params.agent_width as f32 / 2.0;
        let is_thing = |index: u32| sim.world.objects[index as usize].portable.is_some();
        let is_near = reached.contains(&self.object) && gap < 0.3 && is_facing(sim, at);
        is_near && reacting_object(sim, &reached).is_some_and(is_thing)
    }

    /// Walks to the nearest zone in this room that is worth as much as the wanted one, and into it.
    fn enter(self, sim: SimRef, floor: &Floor, ways: &mut Ways) -> [f64; 3] {
        let zones = sim.world.environment_params.zones.iter();
        let wanted = &sim.world.environment_params.zones[self.object as usize];
        let equal = zones.filter(|zone| zone.is_wanted() && by_worth(zone, wanted).is_eq());
        ways.lead_into(floor, equal.clone(), self.object, self.room);
        let here = sim.agent().position;
        if let Some(point) = ways.next(floor, here) {
            return walk(sim, point, 0.1);
        }
        if equal.clone().any(|zone| zone.contains(here.map(f64::from))) {
            return [0.0; 3];
        }
        // The centre of the cell is in a zone, but the agent is not.
        let centre = floor.cell_near(here).map(|cell| floor.grid.centre(cell).map(f64::from));
        let is_apart = |zone: &Zone| !centre.is_some_and(|centre| zone.contains(centre));
        let middles = equal.filter_map(|zone| {
            let at = ground::middle(zone)?.map(|metres| metres as f32);
            Some((is_apart(zone), distance(here, at), at))
        });
        let nearest = middles.min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        nearest.map_or([0.0; 3], |(.., at)| walk(sim, at, 0.1))
    }

    fn bring(self, sim: SimRef, floor: &Floor, ways: &mut Ways, thing: u32) -> [f64; 3] {
        let to = sim.objects()[self.object as usize].position;
        let within = self.within(sim, thing);
        // The thing picked up last is put down first.
        let last = sim.state.carried().last().copied().unwrap_or(thing);
        let tag = |index: u32| &sim.world.objects[index as usize].tag;
        let is_deliverable = tag(last) == tag(thing);
        let radius = sim.body_radius(last as usize);
        let ahead = sim.world.agent_params.agent_width as f32 / 2.0 + radius + 0.1;
        let least = GroundShape::of(sim, self.object as usize).reach() + radius + 0.1;
        let most = (within - 0.1).max(least.min(within)) + ahead;
        let least = (least + ahead).min(most - 0.05);
        let delivery = Delivery {
            to: self.object,
            at: to,
            room: self.room,
            radius,
            ahead,
            from: [least, most],
            within,
            carried: sim.state.carried().len(),
        };
        ways.lead_to_delivery(sim, floor, delivery);
        let next = ways.next(floor, sim.agent().position);
        if let Some((_, place)) = put_down_place(sim)
            && reacting_object(sim, &reached(sim)).is_none()
            && (!is_deliverable
                || distance(place, to) < within - 0.02 && (next.is_none() || !is_crowded(sim, delivery, place)))
        {
            return [0.0, 0.0, 1.0];
        }
        if let Some(point) = next {
            return walk(sim, point, 0.2);
        }
        if !is_facing(sim, to) {
            return [0.0, turn(sim, to), 0.0];
        }
        // The centre of the cell is near enough, but the agent is not.
        let speed = (distance(sim.agent().position, to) - f32::midpoint(least, most)) / seconds(sim);
        let most = sim.world.agent_params.max_linear_speed as f32;
        [f64::from(speed.clamp(-most, most)), turn(sim, to), 0.0]
    }

    fn within(self, sim: SimRef, thing: u32) -> f32 {
        let world = sim.world;
        let tags = [thing, self.object].map(|index| world.objects[index as usize].tag.as_deref());
        let deliveries = world.rules.success.iter().filter_map(|condition| match condition {
            driftworld_spec::EndCondition::Delivered(delivery) => Some(delivery),
            _ => None,
        });
        let is_deliverable =
            |delivery: &&driftworld_spec::Delivery| tags == [Some(delivery.tag.as_str()), Some(delivery.to.as_str())];
        deliveries
            .filter(is_deliverable)
            .map(|delivery| delivery.within as f32)
            .fold(f32::INFINITY, f32::min)
            .min(1000.0)
    }
}

/// Whether a thing put down here would react in place of one still to be picked up.
fn is_crowded(sim: SimRef, delivery: Delivery, place: [f32; 2]) -> bool {
    let near = |index: &u32| distance(sim.objects()[*index as usize].position, place) < MIN_SPACING;
    (0..sim.objects().len() as u32)
        .filter(near)
        .any(|index| is_to_collect(sim, delivery, index))
}

/// Puts something down, after turning until there is room in front and the wanted thing is out of reach.
fn put_down(sim: SimRef, wanted: u32) -> [f64; 3] {
    let reached = reached(sim);
    let is_free =
        reacting_object(sim, &reached).is_none() && put_down_place(sim).is_some() && !reached.contains(&wanted);
    if is_free {
        return [0.0, 0.0, 1.0];
    }
    [0.0, sim.world.agent_params.max_angular_speed, 0.0]
}

/// Whether the agent faces a point, as precisely as its turns allow.
fn is_facing(sim: SimRef, point: [f32; 2]) -> bool {
    let step = sim.world.agent_params.max_angular_speed as f32 * seconds(sim);
    angle_to(sim, point).abs() <= MAX_HEADING_ERROR.max(0.55 * step)
}

/// Whether picking up an object requires putting something down first.
fn needs_a_free_hand(sim: SimRef, object: u32) -> bool {
    let object = &sim.world.objects[object as usize];
    let is_thing = object.portable.is_some() && object.door.is_none() && object.switch.is_none();
    is_thing && sim.state.carried().len() >= sim.world.agent_params.carry_limit as usize
}

/// Whether a solid portable thing blocks the agent, which could pick it up.
pub(super) fn is_blocked_by_a_thing(sim: SimRef) -> bool {
    let world = sim.world;
    let has_free_hand = sim.state.carried().len() < world.agent_params.carry_limit as usize;
    let [east, north] = sim.agent().velocity;
    if !has_free_hand || !can_interact(world) || (east * east + north * north).sqrt() > MAX_BLOCKED_SPEED {
        return false;
    }
    let is_thing = |index: u32| {
        let object = &world.objects[index as usize];
        object.portable.is_some() && object.door.is_none() && object.switch.is_none() && object.solid
    };
    reacting_object(sim, &reached(sim)).is_some_and(is_thing)
}

/// The objects within reach of an interaction now.
fn reached(sim: SimRef) -> Vec<u32> {
    let mut reached = Vec::new();
    sim.reached_by_hand(&mut reached);
    reached
}

/// The turn rate that would face a point after one step.
fn turn(sim: SimRef, point: [f32; 2]) -> f64 {
    f64::from(angle_to(sim, point) / seconds(sim))
}

/// A step towards a point and `past` metres beyond it, slower in turns.
fn walk(sim: SimRef, point: [f32; 2], past: f32) -> [f64; 3] {
    if is_narrow(sim) {
        // Does not cut corners beside something that costs.
        return step_to(sim, point, past.min(0.05), 5.0);
    }
    step_to(sim, point, past, 25.0)
}
