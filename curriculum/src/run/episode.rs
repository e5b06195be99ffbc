//! One experience: an agent in a world from the first step to the last. Which world and what becomes of the numbers is said elsewhere.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::atomic::{AtomicBool, Ordering};

use driftworld_env::{Action, Agent, EndedBy, EnvError, Environment, Label, Recorder, Step};

/// Steps after which an experience in a world without a limit is over.
pub const MOST_STEPS: u32 = 100_000;

/// The experience that an agent is about to have.
pub(super) struct EpisodeContext<'a> {
    /// The number that it draws its own chance from.
    pub(super) seed: u64,
    pub(super) label: Option<&'a Label>,
    pub(super) learn: bool,
    /// Looked at before each step: once it is set, the experience is cut off.
    pub(super) stop: &'a AtomicBool,
}

/// One experience that is over.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Experience {
    /// What all its steps paid.
    pub reward: f64,
    /// Whether the world's success condition ended it.
    pub success: bool,
    /// Its steps.
    pub steps: u32,
    /// The seconds of the world's time that it took: steps times time step times `frame_skip`, at most the world's limit of seconds.
    pub seconds: f64,
    /// Cut off by a limit of steps, not ended by what happened.
    pub truncated: bool,
    /// What ended it, as the environment says; `None` where nobody said.
    pub ended_by: Option<EndedBy>,
}

impl Experience {
    /// How it ended: `success` where the world's success condition ended it, `step_limit` where a limit of steps cut it off, else
    /// `failure`: another condition of the world ended it.
    pub fn ending(&self) -> &'static str {
        match self {
            Self { success: true, .. } => "success",
            Self { truncated: true, .. } => "step_limit",
            _ => "failure",
        }
    }
}

/// A hash of an action, and of where it led to.
fn print_of(action: Action, environment: &Environment) -> u64 {
    let mut hash = DefaultHasher::new();
    match action {
        Action::Continuous(numbers) => numbers.map(f64::to_bits).hash(&mut hash),
        Action::Discrete(row) => row.hash(&mut hash),
    }
    let (agent, paid) = (environment.agent(), environment.episode_return());
    let [x, y] = agent.position;
    ([x, y, agent.heading_deg].map(f32::to_bits), paid.to_bits()).hash(&mut hash);
    hash.finish()
}

/// Lives one experience in an environment that stands at its beginning; `trace`, where one is wanted, gets a hash of each step.
///
/// It ends as the environment says, so that the last of a block ends like any other: by what happened, or cut off by
/// the limit of steps, never because the block does. One that was stopped on its way returns nothing.
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
    // A world without a limit of steps and without an end would never be over.
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
            trace.push(print_of(action, environment));
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
    // A limit of seconds cuts the last step short.
    let most = if world.max_seconds > 0.0 {
        world.max_seconds
    } else {
        f64::INFINITY
    };
    Ok(Some(Experience {
        reward: environment.episode_return(),
        success: last.success,
        steps,
        seconds: (f64::from(steps) * step_seconds).min(most),
        truncated: last.truncated,
        ended_by: last.ended_by,
    }))
}
