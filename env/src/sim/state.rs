//! All that changes while a world runs, in one value: what a snapshot copies, and what a document of progress writes
//! down. Systems change it; what is derived from it is in `views.rs`.

use driftworld_spec::{LastEvent, Object, World};

use super::doors::DoorState;
use super::mover::Mover;
use super::pushed::Pushed;
use super::rng::{Identities, ObjectRng, Seed};
use super::sequence::Sequence;

/// Where the agent is and how it moves.
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
    /// The direction in which the agent looks: length 1.
    pub fn forward(&self) -> [f32; 2] {
        let heading = self.heading_deg.to_radians();
        [libm::sinf(heading), libm::cosf(heading)]
    }
}

/// One object while its world runs.
#[derive(Clone, Debug, PartialEq)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "facts that have nothing to do with each other"
)]
pub struct ObjectState {
    /// Position in metres; the last one of an object that is gone.
    pub position: [f32; 2],
    /// Heading in degrees, clockwise from +y.
    pub heading_deg: f32,
    /// What a triggering pays now; 0 once it has paid what pays once.
    pub reward: f64,
    /// Whether it is still there.
    pub present: bool,
    /// Whether it has paid, or was destroyed: places in a sequence count on it.
    pub collected: bool,
    /// Whether it is a door that is open: a body that stops nobody.
    pub open: bool,
    /// Whether the agent carries it: it is not there then, and its position is the agent's.
    pub carried: bool,
    pub(super) in_range: bool,
}

impl ObjectState {
    /// An object at its start.
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

/// A heading brought to 0..360 degrees, 360 excluded, which rounding can lead to.
pub(super) fn wrapped(heading_deg: f32) -> f32 {
    let heading_deg = heading_deg.rem_euclid(360.0);
    if heading_deg < 360.0 { heading_deg } else { 0.0 }
}

/// Where a world stands in its course: the only place that says where things are, whether they are there and what they
/// pay.
#[derive(Clone, Default)]
pub(crate) struct SimState {
    pub(super) agent: AgentState,
    pub(super) objects: Vec<ObjectState>,
    pub(super) steps: u32,
    /// Time steps since the start.
    pub(super) ticks: u64,
    /// The sum of rewards since the start.
    pub(super) earned: f64,
    /// The same without what shaping paid: what conditions on the return count.
    pub(super) unshaped: f64,
    /// What the last step paid.
    pub(super) last_reward: f64,
    pub(super) last_event: Option<LastEvent>,
    pub(super) ended: bool,
    /// What bandit arms and returning objects draw, in rising order of their objects.
    pub(super) rngs: Vec<ObjectRng>,
    /// Objects in contact at the end of the last step, in rising order.
    pub(super) contacts: Vec<u32>,
    /// The objects that move by themselves, in rising order.
    pub(super) movers: Vec<Mover>,
    /// The objects that are pushed, in rising order.
    pub(super) pushed: Vec<Pushed>,
    /// Destroyed objects that come back, in rising order, with the time step in which they do.
    pub(super) returning: Vec<(usize, u64)>,
    /// Whose turn it is, where objects have one.
    pub(super) sequence: Sequence,
    /// For each of the views' zones, whether the agent has entered it and is in it.
    pub(super) inside: Vec<bool>,
    /// The objects that are doors, in rising order.
    pub(super) doors: Vec<DoorState>,
    /// The objects that the agent carries, in the order in which it picked them up.
    pub(super) carried: Vec<u32>,
    /// Whether any object is a door, a switch or a thing that is carried.
    pub(crate) has_things: bool,
    /// Seconds of a time step.
    time_step: f64,
    /// The agent's energy; 0 in a world without.
    pub(super) energy: f64,
}

impl SimState {
    /// The start of a world. Nothing is touched or near yet: where the agent starts counts as news in the first step.
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
            // Room for all that is picked up, so that no step takes memory.
            state.carried.reserve_exact(start.carry_limit as usize);
        }
        state
    }

    /// Adds an object at its start, but for its place in the sequence.
    pub(super) fn add_object(&mut self, object: &Object, seed: &Seed, identities: &mut Identities) {
        let index = self.objects.len();
        // Most objects of most worlds draw nothing, and then nobody asks who they are.
        let identity = if object.takes_chances() {
            identities.take(object)
        } else {
            0
        };
        self.objects.push(ObjectState::new(object));
        self.movers.extend(Mover::new(index, object, seed, identity));
        self.rngs.extend(ObjectRng::new(index, object, seed, identity));
        self.pushed.extend(Pushed::new(index, object));
        let door = object.door.as_ref();
        self.doors
            .extend(door.map(|door| DoorState::new(index, door, self.time_step)));
        self.has_things |= object.is_used();
    }

    /// What a door has beside being open or not.
    pub(super) fn door_of(&self, object: usize) -> Option<&DoorState> {
        let found = self.doors.binary_search_by_key(&object, |door| door.object).ok()?;
        self.doors.get(found)
    }

    /// What the agent carries, in the order in which it picked it up.
    pub(crate) fn carried(&self) -> &[u32] {
        &self.carried
    }

    /// Whether a door was unlocked by its key.
    pub(crate) fn is_unlocked(&self, object: usize) -> bool {
        self.door_of(object).is_some_and(|door| door.unlocked)
    }

    /// For each door whether it was unlocked by its key.
    pub(crate) fn unlocked(&self) -> impl Iterator<Item = bool> {
        self.doors.iter().map(|door| door.unlocked)
    }

    /// The motion of an object that is pushed.
    pub(super) fn pushed_of(&mut self, object: usize) -> Option<&mut Pushed> {
        let found = self.pushed.binary_search_by_key(&object, |body| body.object).ok()?;
        self.pushed.get_mut(found)
    }

    /// What an object draws, if it draws for pulls or returns.
    pub(super) fn rng_of(&mut self, object: usize) -> Option<&mut ObjectRng> {
        let found = self.rngs.binary_search_by_key(&object, |rng| rng.object).ok()?;
        self.rngs.get_mut(found)
    }

    /// Whether the agent was in contact with an object at the end of the last step.
    pub(crate) fn touches(&self, index: usize) -> bool {
        self.contacts.binary_search(&(index as u32)).is_ok()
    }

    /// Whether all objects with a lower place in the sequence have been collected.
    pub(crate) fn is_due(&self, order: Option<u32>) -> bool {
        self.sequence.is_due(order)
    }

    /// Takes note of what has been collected since the last call.
    pub(super) fn advance_sequence(&mut self) {
        let objects = &self.objects;
        self.sequence.advance(|index| objects[index].collected);
    }

    /// The way from the agent to an object along x and y, in metres.
    pub(super) fn way_to(&self, index: usize) -> [f32; 2] {
        let (to, from) = (self.objects[index].position, self.agent.position);
        [to[0] - from[0], to[1] - from[1]]
    }

    /// The index of the nearest object, centre to centre on the ground, for which a condition holds.
    pub(super) fn nearest(&self, world: &World, holds: impl Fn(&Object, &ObjectState) -> bool) -> Option<usize> {
        let objects = world.objects.iter().zip(&self.objects).enumerate();
        let distance = |index: usize| {
            let [x, y] = self.way_to(index);
            x * x + y * y
        };
        objects
            .filter(|(_, (object, state))| holds(object, state))
            .map(|(index, _)| (index, distance(index)))
            .min_by(|(_, a), (_, b)| a.total_cmp(b))
            .map(|(index, _)| index)
    }
}
