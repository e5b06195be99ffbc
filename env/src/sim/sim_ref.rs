//! [`SimRef`]: a read-only view of a running world, for queries and for policies that know the map.

use driftworld_spec::World;

use super::state::{AgentState, ObjectState, SimState};
use super::views::Views;
use crate::scene::Scene;

/// A read-only view of a running world.
#[derive(Clone, Copy)]
pub(crate) struct SimRef<'a> {
    /// The initial world, plus objects that were spawned later.
    pub(crate) world: &'a World,
    pub(crate) state: &'a SimState,
    pub(crate) views: &'a Views,
}

impl<'a> SimRef<'a> {
    /// The agent's current state.
    pub(crate) fn agent(self) -> AgentState {
        self.state.agent
    }

    /// The objects' current states, in the world's order.
    pub(crate) fn objects(self) -> &'a [ObjectState] {
        &self.state.objects
    }

    /// The current scene.
    pub(crate) fn scene(self) -> &'a Scene {
        &self.views.scene
    }

    /// Finds the objects within reach of an interaction now, in order of index.
    pub(crate) fn reached_by_hand(self, found: &mut Vec<u32>) {
        let agent = self.agent();
        self.views.bodies.in_reach(agent.position, agent.forward(), found);
    }

    /// Whether an agent that follows this path touches an object or comes within `metres` of a touch. If it starts nearer than
    /// that, only coming even nearer counts.
    pub(crate) fn would_touch(self, object: u32, path: &[[f64; 2]], metres: f64) -> bool {
        self.views.bodies.would_touch(object, path, metres)
    }

    /// The radius of an object's body in metres.
    pub(crate) fn body_radius(self, index: usize) -> f32 {
        let item = &self.views.scene.items[index];
        item.body.collider.radius() * item.scale
    }
}
