//! A running world, borrowed to be read: what policies that know the map, and questions about this moment, are handed.

use driftworld_spec::World;

use super::state::{AgentState, ObjectState, SimState};
use super::views::Views;
use crate::scene::Scene;

/// A running world, to be read.
#[derive(Clone, Copy)]
pub(crate) struct SimRef<'a> {
    /// The world at its start, and with it what was spawned later.
    pub(crate) world: &'a World,
    pub(crate) state: &'a SimState,
    pub(crate) views: &'a Views,
}

impl<'a> SimRef<'a> {
    /// Where the agent is.
    pub(crate) fn agent(self) -> AgentState {
        self.state.agent
    }

    /// The objects as they are now, in the world's order.
    pub(crate) fn objects(self) -> &'a [ObjectState] {
        &self.state.objects
    }

    /// What there is to see now.
    pub(crate) fn scene(self) -> &'a Scene {
        &self.views.scene
    }

    /// Finds the objects that an interaction would reach now, by index in rising order.
    pub(crate) fn reached_by_hand(self, found: &mut Vec<u32>) {
        let agent = self.agent();
        self.views.bodies.in_reach(agent.position, agent.forward(), found);
    }

    /// Whether an agent that goes straight from place to place touches an object, or comes nearer to a touch than so many metres,
    /// without going away from it.
    pub(crate) fn would_touch(self, object: u32, path: &[[f64; 2]], metres: f64) -> bool {
        self.views.bodies.would_touch(object, path, metres)
    }

    /// The radius of an object's body in metres.
    pub(crate) fn body_radius(self, index: usize) -> f32 {
        let item = &self.views.scene.items[index];
        item.body.collider.radius() * item.scale
    }
}
