//! [`SimState`]: everything that changes while a world runs, in one value, for snapshots and saved worlds.

use driftworld_spec::{LastEvent, Object, World};

use super::door_state::DoorState;
use super::mover::Mover;
use super::pushed::Pushed;
use super::rng::{Identities, ObjectRng, Seed};
use super::sequence::Sequence;

/// The agent's pose and velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct AgentState {
    /// Position in metres.
    pub position: [f32; 2],
    /// Heading in degrees, 0..360, clockwise from +y.
    pub heading_deg: f32,
    /// Velocity over the last step in metres per second.
    pub velocity: [f32; 2],
}

impl AgentState {
    /// Unit vector of the agent's heading.
    pub fn forward(&self) -> [f32; 2] {
        let heading = self.heading_deg.to_radians();
        [libm::sinf(heading), libm::cosf(heading)]
    }
}

/// The state of one object in a running world.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::struct_excessive_bools, reason = "the flags are independent of each other")]
pub struct ObjectState {
    /// Position in metres; for an absent object, its last position.
    pub position: [f32; 2],
    /// Heading in degrees, clockwise from +y.
    pub heading_deg: f32,
    /// Current reward of a stimulus; 0 after a reward that is paid only once.
    pub reward: f64,
    /// Whether it is present.
    pub present: bool,
    /// Whether it has paid or was destroyed, which advances sequences.
    pub collected: bool,
    /// Whether it is an open door, which does not block anything.
    pub open: bool,
    /// Whether the agent carries it. If so, it is absent, and its position is the agent's.
    pub carried: bool,
    pub(super) in_range: bool,
}

impl ObjectState {
    /// An object's initial state.
    pub(super) fn new(object: &Object) -> Self {
        Self {
            position: object.coordinates.map(|metres| metres as f32),
            heading_deg: object.heading as f32,
            reward: object.reward,
            present: true,
            collected: false,
            open: object.door.as_ref().is_some_and(|door| door.open),
            carried: false,
            in_range: false,
        }
    }
}

/// Wraps a heading to 0..360 degrees, excluding 360, which rounding can produce.
pub(super) fn wrapped(heading_deg: f32) -> f32 {
    let heading_deg = heading_deg.rem_euclid(360.0);
    if heading_deg < 360.0 { heading_deg } else { 0.0 }
}

/// The state of a running world: the single source for the positions, the presence and the rewards of objects.
#[derive(Clone, Default)]
pub(crate) struct SimState {
    pub(super) agent: AgentState,
    pub(super) objects: Vec<ObjectState>,
    pub(super) steps: u32,
    /// Time steps since the start.
    pub(super) ticks: u64,
    /// The sum of rewards since the start.
    pub(super) earned: f64,
    /// The sum of rewards without shaping, for conditions on the return.
    pub(super) unshaped: f64,
    /// The reward of the last step.
    pub(super) last_reward: f64,
    pub(super) last_event: Option<LastEvent>,
    pub(super) ended: bool,
    /// Random numbers of bandit arms and respawning objects, ordered by object.
    pub(super) rngs: Vec<ObjectRng>,
    /// Objects in contact at the end of the last step, in ascending order.
    pub(super) contacts: Vec<u32>,
    /// The objects that move by themselves, in ascending order.
    pub(super) movers: Vec<Mover>,
    /// The objects that react to the agent from a distance, in ascending order.
    pub(super) ranged: Vec<u32>,
    /// The pushable objects, in ascending order.
    pub(super) pushed: Vec<Pushed>,
    /// Destroyed objects that will respawn, in ascending order, with the time step in which they are due.
    pub(super) returning: Vec<(usize, u64)>,
    /// The sequence; empty if no object has an order number.
    pub(super) sequence: Sequence,
    /// For each of the views' zones, whether the agent has entered it and is still inside.
    pub(super) inside: Vec<bool>,
    /// The objects that are doors, in ascending order.
    pub(super) doors: Vec<DoorState>,
    /// The objects that the agent carries, in the order in which it picked them up.
    pub(super) carried: Vec<u32>,
    /// Whether any object is a door, a switch or portable.
    pub(crate) has_things: bool,
    /// Duration of a time step in seconds.
    time_step: f64,
    /// The agent's energy; 0 in a world without energy.
    pub(super) energy: f64,
}

impl SimState {
    /// The state at the start of a world. Nothing is touched or near yet, so contacts at the agent's start count as new in the
    /// first step.
    pub(super) fn new(world: &World, seed: &Seed, identities: &mut Identities) -> Self {
        let start = &world.agent_params;
        let mut state = Self {
            agent: AgentState {
                position: start.coordinates.map(|metres| metres as f32),
                heading_deg: wrapped(start.heading as f32),
                velocity: [0.0; 2],
            },
            objects: Vec::with_capacity(world.objects.len()),
            sequence: Sequence::of(&world.objects),
            time_step: start.time_step,
            energy: start.energy.map_or(0.0, |energy| energy.start),
            ..Self::default()
        };
        for object in &world.objects {
            state.add_object(object, seed, identities);
        }
        if state.has_things {
            // Capacity for everything that may be picked up, so that steps do not allocate.
            state.carried.reserve_exact(start.carry_limit as usize);
        }
        state
    }

    /// Adds an object in its initial state, but not to the sequence.
    pub(super) fn add_object(&mut self, object: &Object, seed: &Seed, identities: &mut Identities) {
        let index = self.objects.len();
        // Most objects need no random numbers, so they need no identity.
        let identity = if object.takes_chances() {
            identities.take(object)
        } else {
            0
        };
        self.objects.push(ObjectState::new(object));
        self.ranged
            .extend((object.range_stimulus_distance > 0.0).then_some(index as u32));
        self.movers.extend(Mover::new(index, object, seed, identity));
        self.rngs.extend(ObjectRng::new(index, object, seed, identity));
        self.pushed.extend(Pushed::new(index, object));
        let door = object.door.as_ref();
        self.doors
            .extend(door.map(|door| DoorState::new(index, door, self.time_step)));
        self.has_things |= object.is_used();
    }

    /// A door's state besides being open or closed.
    pub(super) fn door_of(&self, object: usize) -> Option<&DoorState> {
        entry(&self.doors, object, |door| door.object)
    }

    /// The carried objects, in the order in which the agent picked them up.
    pub(crate) fn carried(&self) -> &[u32] {
        &self.carried
    }

    /// Whether a door was unlocked by its key.
    pub(crate) fn is_unlocked(&self, object: usize) -> bool {
        self.door_of(object).is_some_and(|door| door.unlocked)
    }

    /// Whether each door was unlocked by its key.
    pub(crate) fn unlocked(&self) -> impl Iterator<Item = bool> {
        self.doors.iter().map(|door| door.unlocked)
    }

    /// The motion of a pushable object.
    pub(super) fn pushed_of(&mut self, object: usize) -> Option<&mut Pushed> {
        let found = self.pushed.binary_search_by_key(&object, |body| body.object).ok()?;
        self.pushed.get_mut(found)
    }

    /// An object's random numbers, if it needs any for pulls or respawning.
    pub(super) fn rng_of(&mut self, object: usize) -> Option<&mut ObjectRng> {
        let found = self.rngs.binary_search_by_key(&object, |rng| rng.object).ok()?;
        self.rngs.get_mut(found)
    }

    /// Whether the agent was in contact with an object at the end of the last step.
    pub(crate) fn touches(&self, index: usize) -> bool {
        self.contacts.binary_search(&(index as u32)).is_ok()
    }

    /// Whether all objects with a lower order number have been collected.
    pub(crate) fn is_due(&self, order: Option<u32>) -> bool {
        self.sequence.is_due(order)
    }

    /// Updates the sequence after objects were collected.
    pub(super) fn advance_sequence(&mut self) {
        let objects = &self.objects;
        self.sequence.advance(|index| objects[index].collected);
    }

    /// The vector from the agent to an object along x and y, in metres.
    pub(super) fn offset_to(&self, index: usize) -> [f32; 2] {
        let (to, from) = (self.objects[index].position, self.agent.position);
        [to[0] - from[0], to[1] - from[1]]
    }

    /// The index of the nearest object, centre to centre on the ground, for which `holds` is true.
    pub(super) fn nearest(&self, world: &World, holds: impl Fn(&Object, &ObjectState) -> bool) -> Option<usize> {
        let objects = world.objects.iter().zip(&self.objects).enumerate();
        let distance = |index: usize| {
            let [x, y] = self.offset_to(index);
            x * x + y * y
        };
        objects
            .filter(|(_, (object, state))| holds(object, state))
            .map(|(index, _)| (index, distance(index)))
            .min_by(|(_, a), (_, b)| a.total_cmp(b))
            .map(|(index, _)| index)
    }
}

/// The entry of an object in a list that is sorted by object.
pub(super) fn entry<T>(list: &[T], object: usize, object_of: impl Fn(&T) -> usize) -> Option<&T> {
    let found = list.binary_search_by_key(&object, object_of).ok()?;
    list.get(found)
}
