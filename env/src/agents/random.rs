//! [`RandomAgent`] acts at random, as a baseline for learners.

use driftworld_spec::{ActionModel, ActionSpace};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::Agent;
use crate::sim::{Action, Environment, in_units};

/// Steps for which it holds an action, so that it covers some ground.
const HOLD: u32 = 8;

/// Samples a forward speed, a turn rate and whether to interact, and holds them for 8 steps. In a world with an action table it
/// samples rows.
#[derive(Clone, Debug)]
pub struct RandomAgent {
    rng: ChaCha8Rng,
    action: Action,
    held: u32,
}

impl RandomAgent {
    /// An agent whose actions depend only on this seed.
    pub fn new(seed: u64) -> Self {
        Self {
            rng: ChaCha8Rng::seed_from_u64(seed),
            action: Action::Continuous([0.0; 3]),
            held: 0,
        }
    }
}

impl Agent for RandomAgent {
    fn act(&mut self, environment: &Environment) -> Action {
        if self.held == 0 {
            let agent = &environment.world().agent_params;
            self.action = match agent.num_actions() {
                Some(rows) => Action::Discrete(self.rng.random_range(0..rows as u64) as usize),
                None if agent.actions == ActionSpace::Normalized || agent.action_model == ActionModel::ByWaypoint => {
                    let mut share = || self.rng.random::<f64>() * 2.0 - 1.0;
                    let shares = [share(), share(), share()];
                    Action::Continuous(match (agent.action_model, &agent.actions) {
                        (ActionModel::ByWaypoint, ActionSpace::Normalized) => shares,
                        (ActionModel::ByWaypoint, _) => in_units(shares, environment.world()),
                        // Forwards only, as below.
                        _ => [shares[0].abs(), shares[1], shares[2]],
                    })
                }
                None => {
                    let speed = self.rng.random::<f64>() * agent.max_linear_speed;
                    let turn = (self.rng.random::<f64>() * 2.0 - 1.0) * agent.max_angular_speed;
                    Action::Continuous([speed, turn, self.rng.random::<f64>()])
                }
            };
        }
        self.held = (self.held + 1) % HOLD;
        self.action
    }

    fn begin(&mut self, seed: u64) {
        *self = Self::new(seed);
    }

    fn learns(&self) -> bool {
        false
    }

    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        Some(Box::new(self.clone()))
    }
}
