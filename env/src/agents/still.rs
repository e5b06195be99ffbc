//! [`StillAgent`] stands still. It is a baseline that a random agent may fall below.

use driftworld_spec::{ActionModel, ActionSpace};

use super::{Agent, in_space};
use crate::sim::{Action, Environment};

/// Stands still and does nothing. With an action table it takes the nearest row. A world on rails moves it anyway.
#[derive(Clone, Copy, Debug, Default)]
pub struct StillAgent;

impl Agent for StillAgent {
    fn act(&mut self, environment: &Environment) -> Action {
        let params = &environment.world().agent_params;
        if params.action_model != ActionModel::ByWaypoint || params.num_actions().is_some() {
            return in_space([0.0; 3], environment.sim());
        }
        // The waypoint is the agent's own position.
        let [x, y] = environment.sim().agent().position.map(f64::from);
        if params.actions == ActionSpace::Normalized {
            let [width, depth] = environment.world().environment_params.arena_size();
            return Action::Continuous([x / width * 2.0, y / depth * 2.0, 0.0]);
        }
        Action::Continuous([x, y, 0.0])
    }

    fn learns(&self) -> bool {
        false
    }

    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        Some(Box::new(*self))
    }
}

#[cfg(test)]
mod tests {
    use driftworld_spec::{AgentParams, World};

    use super::*;

    #[test]
    fn agent_stays_in_place_in_every_action_space() {
        for (action_model, actions) in [
            (ActionModel::ByVelocity, ActionSpace::Continuous),
            (ActionModel::ByVelocity, ActionSpace::Normalized),
            (ActionModel::ByWaypoint, ActionSpace::Continuous),
            (ActionModel::ByWaypoint, ActionSpace::Normalized),
        ] {
            let world = World::default().edit(|world| {
                world.agent_params = AgentParams {
                    action_model,
                    actions: actions.clone(),
                    coordinates: [3.0, -4.0],
                    ..AgentParams::default()
                };
            });
            let mut environment = Environment::new(world.expect("the world is valid"));
            let start = environment.sim().agent();
            for _ in 0..20 {
                let action = StillAgent.act(&environment);
                environment.step(action).expect("the action is in the action space");
            }
            let end = environment.sim().agent();
            assert_eq!(
                (start.position, start.heading_deg),
                (end.position, end.heading_deg),
                "{action_model:?}"
            );
        }
    }
}
