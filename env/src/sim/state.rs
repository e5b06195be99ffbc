//! Writing a running world down as a world. The form that stays in memory is in `snapshot.rs`.

use driftworld_spec::World;

use super::environment::Environment;

impl Environment {
    /// The world as it is now: agent and objects where they stand, rewards that are left.
    pub fn state(&self) -> World {
        let mut world = (*self.world).clone();
        let agent = self.episode.agent;
        world.agent_params.coordinates = agent.position.map(f64::from);
        world.agent_params.heading = f64::from(agent.heading_deg);
        let states = self.episode.objects.iter().zip(&self.scene.items);
        for (object, (state, item)) in world.objects.iter_mut().zip(states) {
            object.coordinates = item.position.map(f64::from);
            object.heading = f64::from(item.heading_deg);
            object.reward = state.reward;
        }
        world
    }
}
