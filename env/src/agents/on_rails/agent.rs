//! Implements [`Agent`] for [`OnRailsAgent`].

use super::OnRailsAgent;
use crate::agents::Agent;
use crate::sim::{Action, Environment};

impl Agent for OnRailsAgent {
    fn act(&mut self, environment: &Environment) -> Action {
        let sim = environment.sim();
        let step = self.steer(sim);
        self.planner.shield().in_space(step, sim)
    }

    // Keeps the route: it checks its cached grid before using it.
    fn begin(&mut self, _seed: u64) {
        let route = std::mem::take(&mut self.route);
        let mut planner = std::mem::take(&mut self.planner);
        planner.begin();
        *self = Self {
            route,
            planner,
            ..Self::default()
        };
    }

    fn learns(&self) -> bool {
        false
    }

    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        Some(Box::new(self.clone()))
    }
}
