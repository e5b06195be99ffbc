//! An agent that acts by a trained network of `driftworld.learners`. Its forward pass is in `forward.rs`, its file in `file.rs`.

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

/// A network, and how it acts: all that its file says.
#[derive(Debug)]
struct Trained {
    network: PatchNetwork,
    /// Speed in m/s, turn rate in °/s, and whether to interact if above 0.5: a row for each output of the policy.
    actions: Vec<[f64; 3]>,
    /// Time steps for which an action is held; as long as one step of the world if not said.
    frame_skip: Option<u32>,
    /// Whether it takes the likeliest action, or draws one from the policy.
    is_greedy: bool,
}

/// Acts by a network that `export` of a learner in Python has written: it draws what its camera shows, small, on the processor,
/// and holds each action as long as it was held in training.
///
/// It sees what an environment with the modality RGB and the network's size shows, to the bit. A sampled policy draws from the
/// seed of the episode. In worlds with a table of actions it takes the row that comes nearest.
pub struct NetworkAgent {
    trained: Arc<Trained>,
    renderer: CpuRenderer,
    image: Vec<u8>,
    rng: ChaCha8Rng,
    action: [f64; 3],
    /// Steps for which it is still held.
    held: u32,
}

impl NetworkAgent {
    /// Reads a network in the format safetensors; `name` is what messages call it, usually its path.
    ///
    /// # Errors
    /// [`EnvError::BadNetwork`] with the place of what is wrong.
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

    /// Draws what its camera shows.
    fn look(&mut self, environment: &Environment) {
        let side = self.trained.network.side as u32;
        self.image.resize((side * side * 3) as usize, 0);
        let mut target = Target {
            width: side,
            height: side,
            supersampling: environment.world().agent_params.supersampling,
            rgb: Some(&mut self.image),
            ..Target::default()
        };
        let camera = environment.camera();
        let drawn = self.renderer.draw(environment.scene(), &camera, &mut target);
        drawn.expect("a network's image is small enough for any supersampling");
        environment.draw_carried(&mut self.renderer, &mut target);
    }

    /// The row of the table of actions for what it sees.
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
            let of_world = environment.world().agent_params.frame_skip.max(1);
            self.held = self.trained.frame_skip.unwrap_or(1).div_ceil(of_world);
        } else {
            // Who interacts does so in the first time step.
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
