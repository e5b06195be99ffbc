//! All that changes while a world runs, in one value: what a snapshot copies. What changes it is in the files beside this one.

use driftworld_spec::{ActionModel, LastEvent, Object, World};

use super::mover::Mover;
use super::pushing::Pushed;
use super::sequence::Sequence;
use super::streams::{Identities, ObjectRng, Seed};
use crate::agents::OnRailsAgent;

/// Where the agent is and how it moves.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
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
pub struct ObjectState {
    /// What a triggering pays now; 0 once it has paid what pays once.
    pub reward: f64,
    /// Whether it is still there.
    pub present: bool,
    /// Whether it has paid, or was destroyed: places in a sequence count on it.
    pub collected: bool,
    pub(super) in_range: bool,
}

impl ObjectState {
    /// An object at its start.
    pub(super) fn new(object: &Object) -> Self {
        Self {
            reward: object.reward,
            present: true,
            collected: false,
            in_range: false,
        }
    }
}

/// A heading brought to 0..360 degrees, 360 excluded, which rounding can lead to.
pub(super) fn wrapped(heading_deg: f32) -> f32 {
    let heading_deg = heading_deg.rem_euclid(360.0);
    if heading_deg < 360.0 { heading_deg } else { 0.0 }
}

/// Where a world stands in its course.
#[derive(Clone)]
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
    /// The objects that move by themselves.
    pub(super) movers: Vec<Mover>,
    /// The objects that are pushed, in rising order.
    pub(super) pushed: Vec<Pushed>,
    /// Destroyed objects that come back, in rising order, with the time step in which they do.
    pub(super) returning: Vec<(usize, u64)>,
    pub(super) rails: Option<OnRailsAgent>,
    /// Whose turn it is, where objects have one.
    pub(super) sequence: Sequence,
}

impl SimState {
    /// The start of a world. What is touched or near is found later, when there are bodies.
    pub(super) fn new(world: &World, seed: &Seed, identities: &mut Identities) -> Self {
        let start = &world.agent_params;
        let mut episode = Self {
            agent: AgentState {
                position: start.coordinates.map(|metres| metres as f32),
                heading_deg: wrapped(start.heading as f32),
                velocity: [0.0; 2],
            },
            objects: world.objects.iter().map(ObjectState::new).collect(),
            steps: 0,
            ticks: 0,
            earned: 0.0,
            unshaped: 0.0,
            last_reward: 0.0,
            last_event: None,
            ended: false,
            rngs: Vec::new(),
            contacts: Vec::new(),
            movers: Vec::new(),
            pushed: Pushed::all(world),
            returning: Vec::new(),
            rails: (start.action_model == ActionModel::OnRails).then(OnRailsAgent::new),
            sequence: Sequence::of(&world.objects),
        };
        for (index, object) in world.objects.iter().enumerate() {
            episode.add_processes(index, object, seed, identities);
        }
        episode
    }

    /// Adds what moves an object and what it draws; `object` is as it was at its start.
    pub(super) fn add_processes(&mut self, index: usize, object: &Object, seed: &Seed, identities: &mut Identities) {
        // Most objects of most worlds draw nothing, and then nobody asks who they are.
        let identity = if object.takes_chances() {
            identities.take(object)
        } else {
            0
        };
        self.movers.extend(Mover::new(index, object, seed, identity));
        self.rngs.extend(ObjectRng::new(index, object, seed, identity));
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
}
