//! Runs one experience: an agent in a world, from the first step to the last.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::atomic::{AtomicBool, Ordering};

use driftworld_env::{Action, Agent, EndedBy, EnvError, Environment, Label, Recorder, Step};

/// Step limit of an experience in a world without one of its own.
pub const MOST_STEPS: u32 = 100_000;

/// Context of an experience, besides agent and environment.
pub(super) struct EpisodeContext<'a> {
    /// Seed of the agent's own randomness.
    pub(super) seed: u64,
    pub(super) label: Option<&'a Label>,
    pub(super) learn: bool,
    /// Checked before each step: once it is set, the experience is abandoned.
    pub(super) stop: &'a AtomicBool,
}

/// A finished experience.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Experience {
    /// The sum of its rewards.
    pub reward: f64,
    /// Whether the world's success condition ended it.
    pub success: bool,
    /// Its steps.
    pub steps: u32,
    /// Simulated seconds that it took: steps × time step × `frame_skip`, at most the world's time limit.
    pub seconds: f64,
    /// Whether a step or time limit cut it off, as opposed to an event in the world.
    pub truncated: bool,
    /// What ended it, according to the environment; `None` if unknown.
    pub ended_by: Option<EndedBy>,
}

impl Experience {
    /// How it ended: `success` by the world's success condition, `step_limit` by a step or time limit, `failure` by any other
    /// condition of the world.
    pub fn ending(&self) -> &'static str {
        match self {
            Self { success: true, .. } => "success",
            Self { truncated: true, .. } => "step_limit",
            _ => "failure",
        }
    }
}

/// A hash of an action and of the state that it led to.
fn fingerprint(action: Action, environment: &Environment) -> u64 {
    let mut hash = DefaultHasher::new();
    match action {
        Action::Continuous(numbers) => numbers.map(f64::to_bits).hash(&mut hash),
        Action::Discrete(row) => row.hash(&mut hash),
    }
    let (agent, reward) = (environment.agent(), environment.episode_return());
    let [x, y] = agent.position;
    ([x, y, agent.heading_deg].map(f32::to_bits), reward.to_bits()).hash(&mut hash);
    hash.finish()
}

/// Runs one experience in a freshly reset environment; `trace`, if given, gets a hash of each step.
///
/// Only the environment ends it, by an event or a limit. The last experience of a block ends like any other; the end of the
/// block does not cut it off. Returns `None` if it was stopped.
pub(super) fn run_episode(
    agent: &mut dyn Agent,
    environment: &mut Environment,
    mut recorder: Option<&mut Recorder>,
    mut trace: Option<&mut Vec<u64>>,
    context: &EpisodeContext,
) -> Result<Option<Experience>, EnvError> {
    if let Some(label) = context.label {
        agent.set_task_label(label);
    }
    agent.begin(context.seed);
    if let Some(trace) = &mut trace {
        trace.clear();
    }
    // A world without a step limit or end condition would never end.
    let limit = environment.world().step_limit().map_or(MOST_STEPS, |_| u32::MAX);
    let mut last = Step::default();
    while !environment.ended() && environment.num_steps() < limit {
        if context.stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let action = agent.act(environment);
        last = environment.step(action)?;
        if let Some(recorder) = &mut recorder {
            recorder.step(action);
        }
        if let Some(trace) = &mut trace {
            trace.push(fingerprint(action, environment));
        }
        if !last.terminated && environment.num_steps() >= limit {
            last.truncated = true;
            last.ended_by.get_or_insert(EndedBy::Steps);
        }
        if context.learn {
            agent.learn(environment, &last);
        }
    }
    let steps = environment.num_steps();
    let world = environment.world();
    let step_seconds = world.agent_params.time_step * f64::from(world.agent_params.frame_skip.max(1));
    // A time limit cuts the last step short.
    let time_limit = if world.max_seconds > 0.0 {
        world.max_seconds
    } else {
        f64::INFINITY
    };
    Ok(Some(Experience {
        reward: environment.episode_return(),
        success: last.success,
        steps,
        seconds: (f64::from(steps) * step_seconds).min(time_limit),
        truncated: last.truncated,
        ended_by: last.ended_by,
    }))
}
