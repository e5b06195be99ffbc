//! [`NetworkAgent`]: acts with a network trained by `driftworld.learners`.

mod file;
mod forward;
#[cfg(test)]
mod tests;

use std::sync::Arc;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::{Agent, in_space};
use crate::EnvError;
use crate::render::{CpuRenderer, Target};
use crate::sim::{Action, Environment};
use forward::PatchNetwork;

/// Contents of a network file: the network and its action settings.
#[derive(Debug)]
struct Trained {
    network: PatchNetwork,
    /// Speed in m/s, turn rate in °/s, and interaction if above 0.5: one row per output of the policy.
    actions: Vec<[f64; 3]>,
    /// Time steps for which an action is held; by default one step of the world.
    frame_skip: Option<u32>,
    /// Whether it takes the most probable action; otherwise it samples from the policy.
    is_greedy: bool,
}

/// Acts with a network that a Python learner's `export` wrote: renders a small image of its camera view on the CPU, and holds
/// each action for as long as it did in training.
///
/// Its image is bit-identical to the RGB observation of an environment with the network's image size. A stochastic policy uses
/// the episode's seed. In worlds with an action table it takes the nearest row.
pub struct NetworkAgent {
    trained: Arc<Trained>,
    renderer: CpuRenderer,
    image: Vec<u8>,
    rng: ChaCha8Rng,
    action: [f64; 3],
    /// Steps for which the action is still held.
    held: u32,
}

impl NetworkAgent {
    /// Parses a network in safetensors format. Error messages refer to it as `name`, usually its path.
    ///
    /// # Errors
    /// [`EnvError::BadNetwork`], with the location of the fault, if the file is not a valid network.
    pub fn parse(name: &str, bytes: &[u8]) -> Result<Self, EnvError> {
        file::read(name, bytes).map(|trained| Self::of(Arc::new(trained)))
    }

    fn of(trained: Arc<Trained>) -> Self {
        Self {
            trained,
            renderer: CpuRenderer::new(),
            image: Vec::new(),
            rng: ChaCha8Rng::seed_from_u64(0),
            action: [0.0; 3],
            held: 0,
        }
    }

    /// Renders the camera's view.
    fn look(&mut self, environment: &Environment) {
        let side = self.trained.network.side as u32;
        self.image.resize((side * side * 3) as usize, 0);
        let mut target = Target {
            supersampling: environment.world().agent_params.supersampling,
            ..Target::of_colors([side, side], &mut self.image)
        };
        let camera = environment.camera();
        let rendered = self.renderer.draw(environment.scene(), &camera, &mut target);
        rendered.expect("a network's image is small enough for any supersampling");
        environment.draw_carried(&mut self.renderer, &mut target);
    }

    /// Chooses the row of the action table for the current image.
    fn decide(&mut self) -> usize {
        let log_policy = self.trained.network.log_policy(&self.image);
        let last = log_policy.len() - 1;
        if self.trained.is_greedy {
            let better = |best: usize, row: usize| if log_policy[row] > log_policy[best] { row } else { best };
            return (0..=last).fold(0, better);
        }
        let drawn: f64 = self.rng.random();
        let mut sum = 0.0;
        let passed = log_policy.iter().take_while(|log| {
            sum += libm::exp(**log);
            sum < drawn
        });
        passed.count().min(last)
    }
}

impl Agent for NetworkAgent {
    fn act(&mut self, environment: &Environment) -> Action {
        if self.held == 0 {
            self.look(environment);
            let row = self.decide();
            self.action = self.trained.actions[row];
            let frame_skip = environment.world().agent_params.frame_skip.max(1);
            self.held = self.trained.frame_skip.unwrap_or(1).div_ceil(frame_skip);
        } else {
            // Interacts only in the first step of an action.
            self.action[2] = 0.0;
        }
        self.held -= 1;
        in_space(self.action, environment.sim())
    }

    fn begin(&mut self, seed: u64) {
        self.rng = ChaCha8Rng::seed_from_u64(seed);
        self.held = 0;
    }

    fn learns(&self) -> bool {
        false
    }

    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        Some(Box::new(Self::of(Arc::clone(&self.trained))))
    }
}
