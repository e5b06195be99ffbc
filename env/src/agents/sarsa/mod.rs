//! [`SarsaAgent`]: a small built-in learner that shows learning, transfer and forgetting within seconds.

mod eye;
mod linear;

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::Agent;
use super::steering::in_space;
use crate::sim::{Action, Environment, Step};
use eye::Eye;
use linear::{Features, LinearSarsa};

/// The actions: fractions of the maximum speed and turn rate, and whether it interacts.
const ACTIONS: [[f64; 3]; 5] = [
    [1.0, 0.0, 1.0],
    [1.0, -0.5, 1.0],
    [1.0, 0.5, 1.0],
    [0.0, -1.0, 0.0],
    [0.0, 1.0, 0.0],
];

/// Seconds of simulated time per action, rounded to whole steps.
const ACTION_SECONDS: f64 = 0.2;
/// Discount per action.
const DISCOUNT: f32 = 0.93;
/// Trace decay λ.
const LAMBDA: f32 = 0.8;
/// Probability of a random action, in evaluations as well: a greedy agent without memory turns in circles.
const EPSILON: f64 = 0.1;
/// Factor on rewards, so that touching a cube of the built-in tasks, worth 100 points, counts as 1.
const UNIT: f32 = 0.01;

/// Learns the values of five actions with linear Sarsa(λ): straight ahead, ahead to either side, turning on the spot.
///
/// It sees the agent's camera view at 42 × 42 pixels. Its 169 features are the share of each cell of a 7 × 3 grid that each of
/// eight colours covers, and a constant. It knows no map, state or label, and remembers nothing within an episode. It finds
/// coloured things and shows how learning one task affects others, but it cannot plan or open doors.
///
/// Actions are ε-greedy (ε 0.1, in evaluations as well: [`SarsaAgent::POLICY`]) and held for 0.2 s. All its random numbers come
/// from the seed of the episode, so a lifetime is reproducible bit for bit.
///
/// # Source
/// Sutton and Barto, *Reinforcement Learning*, 2nd edition, section 12.7, with accumulating traces.
///
/// # Example
/// ```
/// use driftworld_env::{Agent, Environment, SarsaAgent};
/// use driftworld_spec::World;
/// let mut agent = SarsaAgent::new();
/// let mut environment = Environment::new(World::default());
/// agent.begin(7);
/// for _ in 0..10 {
///     let action = agent.act(&environment);
///     let step = environment.step(action)?;
///     agent.learn(&environment, &step);
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct SarsaAgent {
    learner: LinearSarsa<{ ACTIONS.len() }>,
    eye: Eye,
    rng: ChaCha8Rng,
    /// The last action, with the features before it.
    last: Option<(Features, usize)>,
    /// Steps for which the action is still held.
    held: u32,
    /// Reward since the last action.
    reward: f32,
    is_frozen: bool,
}

impl Default for SarsaAgent {
    fn default() -> Self {
        Self::new()
    }
}

impl SarsaAgent {
    /// The policy's name, while learning and in evaluations.
    pub const POLICY: &str = "epsilon-greedy, epsilon 0.1";

    /// An agent that has learned nothing.
    pub fn new() -> Self {
        Self {
            learner: LinearSarsa::new(),
            eye: Eye::default(),
            rng: ChaCha8Rng::seed_from_u64(0),
            last: None,
            held: 0,
            reward: 0.0,
            is_frozen: false,
        }
    }

    /// Observes, learns from the result of the last action, and chooses the next one.
    fn decide(&mut self, environment: &Environment) -> (Features, usize) {
        let features = self.eye.look(environment);
        let values = self.learner.values(&features);
        let action = if self.rng.random::<f64>() < EPSILON {
            self.rng.random_range(0..ACTIONS.len() as u32) as usize
        } else {
            best(&values)
        };
        if !self.is_frozen {
            self.learn_from_last(DISCOUNT * values[action]);
            self.learner.record(&features, action, DISCOUNT * LAMBDA);
        }
        (features, action)
    }

    /// Learns from the reward since the last action and the discounted value of the next one.
    fn learn_from_last(&mut self, next_value: f32) {
        let reward = std::mem::take(&mut self.reward);
        if let Some((features, action)) = &self.last {
            let error = reward + next_value - self.learner.values(features)[*action];
            self.learner.learn(features, error);
        }
    }
}

/// The action with the highest value; ties go to the first.
fn best(values: &[f32]) -> usize {
    let better = |best: usize, action: usize| if values[action] > values[best] { action } else { best };
    (0..values.len()).fold(0, better)
}

impl Agent for SarsaAgent {
    fn act(&mut self, environment: &Environment) -> Action {
        let agent = &environment.world().agent_params;
        if self.held == 0 {
            self.last = Some(self.decide(environment));
            let step_seconds = agent.time_step * f64::from(agent.frame_skip.max(1));
            self.held = (ACTION_SECONDS / step_seconds).round().max(1.0) as u32;
        }
        self.held -= 1;
        let [speed, turn, interact] = self.last.as_ref().map_or([0.0; 3], |(_, action)| ACTIONS[*action]);
        let numbers = [speed * agent.max_linear_speed, turn * agent.max_angular_speed, interact];
        in_space(numbers, environment.sim())
    }

    fn begin(&mut self, seed: u64) {
        self.rng = ChaCha8Rng::seed_from_u64(seed);
        self.learner.begin();
        (self.last, self.held, self.reward) = (None, 0, 0.0);
    }

    /// When an episode is truncated, the value of its last state is unknown, so nothing is learned from the last action.
    fn learn(&mut self, _environment: &Environment, step: &Step) {
        if self.is_frozen {
            return;
        }
        self.reward += step.reward as f32 * UNIT;
        if step.terminated {
            self.learn_from_last(0.0);
        }
    }

    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        Some(Box::new(Self {
            learner: self.learner.clone(),
            is_frozen: true,
            ..Self::new()
        }))
    }
}
