//! PPO in one file (Schulman et al. 2017, arXiv:1707.06347) on candle: it learns to find objects from images of 32 × 32 pixels, is
//! evaluated on other worlds, and writes its network for `driftworld … --agent net:FILE`. `README.md` lists its cost.

use std::collections::HashMap;
use std::error::Error;
use std::sync::Arc;
use std::time::Instant;

use candle_core::{D, DType, Device, Tensor, Var};
use driftworld_env::{Action, Agent, Autoreset, Batch, BatchOptions, Environment, OnRailsAgent, WorldSource};
use driftworld_spec::{ActionSpace, Modality, TaskSpec, Variant, World};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Speed in m/s, turn rate in °/s, interaction.
const ACTIONS: [[f64; 3]; 5] = [
    [10.0, 0.0, 0.0],
    [10.0, 27.0, 0.0],
    [10.0, -27.0, 0.0],
    [3.0, 90.0, 0.0],
    [3.0, -90.0, 0.0],
];
/// Time steps for which an action is held.
const FRAME_SKIP: u32 = 5;
/// Side of an image in pixels, and size of an image in bytes.
const SIDE: usize = 32;
const IMAGE: usize = SIDE * SIDE * 3;
const NUM_ENVS: usize = 64;
/// Seed of the evaluation worlds; the training worlds use the run's own seed.
const TEST_SEED: u64 = 1_000_000;

/// Steps of each environment between updates.
const ROLLOUT: usize = 32;
const EPOCHS: usize = 2;
const MINIBATCH: usize = 512;
const LEARNING_RATE: f64 = 1e-3;
const DISCOUNT: f32 = 0.98;
/// λ of generalised advantage estimation.
const TRACE: f32 = 0.95;
const CLIP: f32 = 0.2;
const ENTROPY: f64 = 0.03;
const REWARD_SCALE: f64 = 0.01;
const MAX_GRADIENT: f64 = 0.5;

/// A world as the learner sees it, with this action space; each action is held for `FRAME_SKIP` time steps.
fn world(variant: &Variant, seed: u64, index: u64, actions: ActionSpace) -> Result<World> {
    let world = driftworld_generator::sample(variant, seed, index)?;
    Ok(world.edit(|world| {
        let agent = &mut world.agent_params;
        (agent.actions, agent.interact, agent.frame_skip) = (actions, false, FRAME_SKIP);
        (agent.observation_size, agent.observation_width) = (SIDE as u32, None);
        agent.modalities = vec![Modality::Rgb];
    })?)
}

/// Environments for a seed's worlds: environment `k` runs worlds `k`, `k + 64`, `k + 128` ….
fn environments(variant: &Variant, seed: u64) -> Result<Batch> {
    let variant = variant.clone();
    let source: WorldSource = Arc::new(move |episode| {
        let index = episode.index * NUM_ENVS as u64 + episode.env as u64;
        world(&variant, seed, index, ActionSpace::Discrete(ACTIONS.to_vec())).map_err(|error| error.to_string())
    });
    let options = BatchOptions {
        // The last image of an episode that ran out of time is needed.
        autoreset: Autoreset::SameStep,
        num_threads: 1,
        ..BatchOptions::default()
    };
    Ok(Batch::new(NUM_ENVS, source, options)?)
}

/// A layer: weights `(inputs, outputs)` and biases, with Adam's moments.
struct Layer {
    name: &'static str,
    parameters: [Var; 2],
    moments: [[Tensor; 2]; 2],
}

impl Layer {
    /// Normal weights with variance gain² / inputs, and zero biases.
    fn new(name: &'static str, inputs: usize, outputs: usize, gain: f64, rng: &mut ChaCha8Rng) -> Result<Self> {
        let mut normal = || {
            // The Box–Muller transform.
            let [a, b]: [f64; 2] = [1.0 - rng.random::<f64>(), rng.random()];
            (-2.0 * a.ln()).sqrt() * (std::f64::consts::TAU * b).cos() * gain / (inputs as f64).sqrt()
        };
        let weights: Vec<f32> = (0..inputs * outputs).map(|_| normal() as f32).collect();
        let weights = Var::from_vec(weights, (inputs, outputs), &Device::Cpu)?;
        let biases = Var::zeros(outputs, DType::F32, &Device::Cpu)?;
        let moments = |var: &Var| -> Result<[Tensor; 2]> { Ok([var.zeros_like()?, var.zeros_like()?]) };
        Ok(Self {
            name,
            moments: [moments(&weights)?, moments(&biases)?],
            parameters: [weights, biases],
        })
    }

    fn apply(&self, input: &Tensor) -> Result<Tensor> {
        let [weights, biases] = &self.parameters;
        Ok(input.matmul(weights)?.broadcast_add(biases)?)
    }
}

/// The network of `driftworld.learners`: patches of 4 × 4 pixels, then 2 × 2 of those, a hidden layer, policy and value.
struct Network {
    layers: [Layer; 5],
    steps: i32,
}

impl Network {
    fn new(rng: &mut ChaCha8Rng) -> Result<Self> {
        let gain = 2_f64.sqrt();
        Ok(Self {
            layers: [
                Layer::new("trunk.small", 48, 32, gain, rng)?,
                Layer::new("trunk.large", 128, 64, gain, rng)?,
                Layer::new("trunk.image", 16 * 64, 128, gain, rng)?,
                Layer::new("policy", 128, ACTIONS.len(), 0.01, rng)?,
                Layer::new("value", 128, 1, 1.0, rng)?,
            ],
            steps: 0,
        })
    }

    /// Log-probabilities `(n, actions)` and values `(n,)` of images in patches.
    fn forward(&self, images: &[u8]) -> Result<(Tensor, Tensor)> {
        let [small, large, image, policy, value] = &self.layers;
        let count = images.len() / IMAGE;
        let pixels: Vec<f32> = images.iter().map(|byte| f32::from(*byte) * (1.0 / 255.0)).collect();
        let pixels = Tensor::from_vec(pixels, (count * 64, 48), &Device::Cpu)?;
        let small = small.apply(&pixels)?.relu()?.reshape((count * 16, 128))?;
        let large = large.apply(&small)?.relu()?.reshape((count, 16 * 64))?;
        let hidden = image.apply(&large)?.relu()?;
        let scores = policy.apply(&hidden)?;
        let scores = scores.broadcast_sub(&scores.max_keepdim(D::Minus1)?.detach())?;
        let sums = scores.exp()?.sum_keepdim(D::Minus1)?.log()?;
        Ok((scores.broadcast_sub(&sums)?, value.apply(&hidden)?.squeeze(1)?))
    }

    /// Like `forward`, but returns plain numbers.
    fn look(&self, images: &[u8]) -> Result<(Vec<f32>, Vec<f32>)> {
        let (log_policy, values) = self.forward(images)?;
        Ok((log_policy.flatten_all()?.to_vec1()?, values.to_vec1()?))
    }

    /// An Adam step, with the gradient's norm clipped.
    fn step(&mut self, loss: &Tensor, rate: f64) -> Result<()> {
        let gradients = loss.backward()?;
        let of = |var: &Var| gradients.get(var).ok_or("the loss depends on all parameters");
        let mut length = 0.0;
        for var in self.layers.iter().flat_map(|layer| &layer.parameters) {
            length += f64::from(of(var)?.sqr()?.sum_all()?.to_scalar::<f32>()?);
        }
        let scale = (MAX_GRADIENT / (length.sqrt() + 1e-6)).min(1.0);
        self.steps += 1;
        let [first, second] = [0.9_f64, 0.999].map(|decay| 1.0 - decay.powi(self.steps));
        for layer in &mut self.layers {
            for (var, [mean, square]) in layer.parameters.iter().zip(&mut layer.moments) {
                // Detached: otherwise the moments would keep the graph of every gradient alive.
                let gradient = (of(var)? * scale)?.detach();
                *mean = ((&*mean * 0.9)? + (&gradient * 0.1)?)?;
                *square = ((&*square * 0.999)? + (gradient.sqr()? * 0.001)?)?;
                let deviation = ((&*square / second)?.sqrt()? + 1e-5)?;
                let change = ((&*mean * (rate / first))? / deviation)?;
                var.set(&(var.as_tensor() - change)?.detach())?;
            }
        }
        Ok(())
    }

    /// Writes the network in the format of the Python learners' `export`.
    fn export(&self, path: &str) -> Result<()> {
        let mut tensors = Vec::new();
        for layer in &self.layers {
            let [weights, biases] = &layer.parameters;
            tensors.push((format!("{}.weight", layer.name), weights.t()?.contiguous()?));
            tensors.push((format!("{}.bias", layer.name), biases.as_tensor().clone()));
        }
        let texts = [
            ("format", "pt".to_owned()),
            ("architecture", "patch".to_owned()),
            ("size", SIDE.to_string()),
            ("actions", format!("{ACTIONS:?}")),
            ("frame_skip", FRAME_SKIP.to_string()),
            ("policy", "sampled".to_owned()),
        ];
        let metadata = HashMap::from(texts.map(|(key, text)| (key.to_owned(), text)));
        std::fs::write(path, safetensors::serialize(tensors, Some(metadata))?)?;
        Ok(())
    }
}

/// Images `(side, side, 3)` with pixels in the network's order: 2 × 2 patches of 4 × 4 pixels, one after the other.
fn patched(images: &[u8]) -> Vec<u8> {
    let mut ordered = Vec::with_capacity(images.len());
    for image in images.chunks_exact(IMAGE) {
        for patch in 0..64 {
            let (square, corner) = (patch / 4, patch % 4);
            let (row, column) = (square / 4 * 2 + corner / 2, square % 4 * 2 + corner % 2);
            for line in 0..4 {
                let first = ((row * 4 + line) * SIDE + column * 4) * 3;
                ordered.extend_from_slice(&image[first..first + 12]);
            }
        }
    }
    ordered
}

/// An action for each environment, drawn from its policy.
fn draw(log_policy: &[f32], rng: &mut ChaCha8Rng) -> Vec<usize> {
    let row = |logs: &[f32]| {
        let drawn: f32 = rng.random();
        let mut sum = 0.0;
        let passed = logs.iter().take_while(|log| {
            sum += log.exp();
            sum < drawn
        });
        passed.count().min(ACTIONS.len() - 1)
    };
    log_policy.chunks_exact(ACTIONS.len()).map(row).collect()
}

/// The experience of all environments since the last update, step by step.
#[derive(Default)]
struct Rollout {
    images: Vec<u8>,
    actions: Vec<usize>,
    log_policy: Vec<f32>,
    values: Vec<f32>,
    rewards: Vec<f32>,
    /// At the end of an episode: the value of its last image if it ran out of time, 0 if it terminated.
    last_values: Vec<Option<f32>>,
}

impl Rollout {
    /// Generalised advantages (Schulman et al. 2016, arXiv:1506.02438, eq. 16); `next`: the current images' values.
    fn advantages(&self, next: &[f32]) -> Vec<f32> {
        let mut advantages = vec![0.0; self.values.len()];
        for env in 0..NUM_ENVS {
            let (mut following, mut later) = (next[env], 0.0);
            for k in (env..self.values.len()).step_by(NUM_ENVS).rev() {
                if let Some(value) = self.last_values[k] {
                    (following, later) = (value, 0.0);
                }
                let surprise = self.rewards[k] + DISCOUNT * following - self.values[k];
                later = surprise + DISCOUNT * TRACE * later;
                (advantages[k], following) = (later, self.values[k]);
            }
        }
        advantages
    }

    fn image(&self, step: usize) -> &[u8] {
        &self.images[step * IMAGE..(step + 1) * IMAGE]
    }

    /// The PPO loss of a minibatch: the clipped surrogate (eq. 7), half the squared error of values, and entropy.
    fn loss(&self, network: &Network, advantages: &[f32], part: &[usize]) -> Result<Tensor> {
        let column = |of: &dyn Fn(usize) -> f32| Tensor::from_iter(part.iter().map(|k| of(*k)), &Device::Cpu);
        let images: Vec<u8> = part.iter().flat_map(|k| self.image(*k)).copied().collect();
        let (log_policy, values) = network.forward(&images)?;
        let actions = Tensor::from_iter(part.iter().map(|k| self.actions[*k] as u32), &Device::Cpu)?;
        let before = column(&|k| self.log_policy[k * ACTIONS.len() + self.actions[k]])?;
        let target = column(&|k| advantages[k] + self.values[k])?;
        let mean = part.iter().map(|k| advantages[*k]).sum::<f32>() / part.len() as f32;
        let spread = part.iter().map(|k| (advantages[*k] - mean).powi(2)).sum::<f32>() / (part.len() - 1) as f32;
        let advantage = column(&|k| (advantages[k] - mean) / (spread.sqrt() + 1e-8))?;
        let after = log_policy.gather(&actions.unsqueeze(1)?, 1)?.squeeze(1)?;
        let ratio = (after - before)?.exp()?;
        let clipped = (ratio.clamp(1.0 - CLIP, 1.0 + CLIP)? * &advantage)?;
        let gain = (ratio * advantage)?.minimum(&clipped)?.mean_all()?;
        let entropy = (log_policy.exp()? * log_policy)?.sum(1)?.mean_all()?.neg()?;
        let error = ((values - target)?.sqr()?.mean_all()? * 0.5)?;
        Ok(((error - gain)? - (entropy * ENTROPY)?)?)
    }
}

/// Learns from at least this many decisions, in whole rollouts.
fn learn(network: &mut Network, variant: &Variant, seed: u64, decisions: usize, rng: &mut ChaCha8Rng) -> Result<()> {
    let mut envs = environments(variant, seed)?;
    let (began, num_updates) = (Instant::now(), decisions.div_ceil(ROLLOUT * NUM_ENVS));
    let (mut returns, mut ended) = ([0.0; NUM_ENVS], Vec::new());
    for update in 0..num_updates {
        let mut rollout = Rollout::default();
        for _ in 0..ROLLOUT {
            let images = patched(&envs.outputs().images.rgb);
            let (log_policy, values) = network.look(&images)?;
            let actions = draw(&log_policy, rng);
            envs.step(&actions.iter().map(|row| Action::Discrete(*row)).collect::<Vec<_>>())?;
            let now = envs.outputs();
            let last = envs.final_outputs().ok_or("same-step resets keep last images")?;
            for env in 0..NUM_ENVS {
                returns[env] += now.rewards[env];
                rollout.rewards.push((now.rewards[env] * REWARD_SCALE) as f32);
                let image = &last.images.rgb[env * IMAGE..(env + 1) * IMAGE];
                let last_value = match (now.terminated[env], now.truncated[env]) {
                    (true, _) => Some(0.0),
                    (_, true) => Some(network.look(&patched(image))?.1[0]),
                    _ => None,
                };
                if last_value.is_some() {
                    ended.push(std::mem::take(&mut returns[env]));
                }
                rollout.last_values.push(last_value);
            }
            rollout.images.extend(images);
            rollout.actions.extend(actions);
            rollout.log_policy.extend(log_policy);
            rollout.values.extend(values);
        }
        let next = network.look(&patched(&envs.outputs().images.rgb))?.1;
        let advantages = rollout.advantages(&next);
        let rate = LEARNING_RATE * (1.0 - update as f64 / num_updates as f64).max(0.1);
        for _ in 0..EPOCHS {
            let mut order: Vec<usize> = (0..advantages.len()).collect();
            for k in (1..order.len()).rev() {
                order.swap(k, rng.random_range(0..=k as u64) as usize);
            }
            for part in order.chunks(MINIBATCH) {
                network.step(&rollout.loss(network, &advantages, part)?, rate)?;
            }
        }
        if update % 10 == 9 && !ended.is_empty() {
            let done = (update + 1) * ROLLOUT * NUM_ENVS;
            let (seconds, reward) = (began.elapsed().as_secs_f64(), mean(&ended));
            println!(
                "{done:>7} decisions, {seconds:>4.0} s: reward {reward:7.1}, {} episodes",
                ended.len()
            );
            ended.clear();
        }
    }
    Ok(())
}

/// The mean reward in the first 64 evaluation worlds.
fn evaluate(network: &Network, variant: &Variant) -> Result<f64> {
    let mut envs = environments(variant, TEST_SEED)?;
    let mut rng = ChaCha8Rng::seed_from_u64(TEST_SEED);
    let (mut returns, mut is_over) = ([0.0; NUM_ENVS], [false; NUM_ENVS]);
    while is_over.contains(&false) {
        let actions = draw(&network.look(&patched(&envs.outputs().images.rgb))?.0, &mut rng);
        envs.step(&actions.iter().map(|row| Action::Discrete(*row)).collect::<Vec<_>>())?;
        let now = envs.outputs();
        for env in 0..NUM_ENVS {
            returns[env] += if is_over[env] { 0.0 } else { now.rewards[env] };
            is_over[env] |= now.terminated[env] || now.truncated[env];
        }
    }
    Ok(mean(&returns))
}

/// The planner's mean reward in the same worlds. It knows the map, moves and turns at any rate, and holds actions equally long.
fn ceiling(variant: &Variant) -> Result<f64> {
    let episode = |index| -> Result<f64> {
        let mut environment = Environment::new(world(variant, TEST_SEED, index, ActionSpace::Continuous)?);
        let mut agent = OnRailsAgent::new();
        agent.begin(0);
        while !environment.ended() {
            environment.step(agent.act(&environment))?;
        }
        Ok(environment.episode_return())
    };
    Ok(mean(&(0..NUM_ENVS as u64).map(episode).collect::<Result<Vec<_>>>()?))
}

fn mean(numbers: &[f64]) -> f64 {
    numbers.iter().sum::<f64>() / numbers.len() as f64
}

fn main() -> Result<()> {
    let (mut decisions, mut seed, mut name, mut path) = (250_000, 0, "red".to_owned(), None);
    let mut words = std::env::args().skip(1);
    while let Some(option) = words.next() {
        let value = words.next().ok_or(format!("{option}: found no value, expected one"))?;
        match option.as_str() {
            "--decisions" => decisions = value.parse()?,
            "--seed" => seed = value.parse()?,
            "--variant" => name = value,
            "--export" => path = Some(value),
            _ => return Err(format!("found {option}, expected --decisions, --seed, --variant or --export").into()),
        }
    }
    let task = TaskSpec::from_json("find_objects.json", include_str!("../../tasks/find_objects.json"))?;
    let variant = task.variant(&name)?;
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut network = Network::new(&mut rng)?;
    let (floor, ceiling) = (evaluate(&network, &variant)?, ceiling(&variant)?);
    println!("find_objects#{name}: random {floor:.1}, planner {ceiling:.1}");
    learn(&mut network, &variant, seed, decisions, &mut rng)?;
    let found = evaluate(&network, &variant)?;
    let share = 100.0 * (found - floor) / (ceiling - floor);
    println!("reward {found:.4}: {share:.0} % of the way from random to planner");
    path.map_or(Ok(()), |path| network.export(&path))
}
