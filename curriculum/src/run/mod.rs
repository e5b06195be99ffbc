//! Runs a scenario experience by experience and logs each one.
//!
//! A [`Plan`] is a scenario with everything that it names, a [`Journal`] writes its log, [`run`] runs it.

mod budget;
mod columns;
mod episode;
mod finishing;
mod gap;
mod in_order;
mod journal;
mod log_names;
mod plan;
mod planned;
mod recordings;
mod rollout;
mod shuffle;
mod simulated;
mod summary;
mod undrawable;
mod worlds;

use std::collections::{BTreeMap, BTreeSet};
use std::num::NonZeroUsize;
use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicBool, Ordering};

use driftworld_env::{Agent, Catalogue, Environment, Recorder, Recording};
use driftworld_metrics::Timestamp;
use driftworld_spec::{BlockKind, World};

pub use columns::{COLUMNS, ENDED_BY, ENDING};
pub use episode::{Experience, MOST_STEPS};
pub use finishing::{Finished, try_expert};
pub(crate) use journal::FinishedExperience;
pub use journal::Journal;
pub use log_names::{log_name, same_log_name};
pub use plan::{ExperienceSpec, FoundWorld, Plan, Sources};
pub use planned::Repeats;
pub use recordings::{MAX_RECORDINGS_BYTES, RECORDINGS_FILE, Recordings, RecordingsFile};
pub use rollout::{Rollout, run_rollout};
pub(crate) use simulated::ExperienceData;
pub use summary::{LeftOut, Progress, RegimeSummary, Summary};
pub use undrawable::{Failed, Trial, Tried, Undrawable, try_worlds};

use crate::CurriculumError;
use episode::EpisodeContext;
use worlds::Worlds;

/// The caller's context for a run, which does not read the clock itself.
pub struct RunContext<'a> {
    /// Returns the current time.
    pub now: &'a mut dyn FnMut() -> Timestamp,
    /// Called after each experience; may end the run there. The log keeps everything up to that point.
    pub watch: &'a mut dyn FnMut(&Progress) -> ControlFlow<()>,
    /// Ends the run at the next step once it is set from elsewhere: experiences in progress leave no row.
    pub stop: &'a AtomicBool,
    /// The source of the worlds' assets.
    pub catalogue: Catalogue,
    /// How many independent experiences run in parallel. Changes no byte of the log.
    pub jobs: NonZeroUsize,
    /// How many evaluations of each block, chosen by the scenario's seeds, are repeated at its end, to check that a learning
    /// agent is frozen there; [`REPEATED_EVALUATIONS`] is a good default, 0 disables the check. Changes no byte of the log.
    pub repeated_evaluations: usize,
}

/// Default number of evaluations per block that are repeated.
pub const REPEATED_EVALUATIONS: usize = 4;

/// Runs a scenario from the first experience that is not in the log to its last, and logs each as soon as it is finished.
///
/// A run that is stopped ends at the next step, and its summary says that it is not finished.
///
/// An experience whose world cannot be drawn ends the run, or is skipped, depending on the plan ([`Undrawable`]); a log that
/// ended there can be resumed with a plan that skips it.
///
/// The order of experiences, their worlds and the agent's initial random numbers depend on the scenario alone: a run that was
/// interrupted and resumed writes the same log as an uninterrupted one. [`Agent::learn`] is called in learning blocks only. A
/// learning agent runs learning blocks one experience after the other; to resume a log with such an agent, the caller passes
/// one that has learned what is in the log ([`relearn`]). Evaluation blocks, and all blocks of an agent that does not learn,
/// are run by its [`Agent::frozen`] copies, several in parallel; by the agent itself if it has no copies. For a learning agent,
/// some evaluations of each block are repeated at its end, and must have the same actions, states and rewards.
///
/// # Errors
/// [`CurriculumError`] with block, regime and experience; all earlier experiences are in the log.
/// [`CurriculumError::NotFrozen`] for an agent that evaluations change.
pub fn run(
    plan: &Plan,
    agent: &mut dyn Agent,
    journal: &mut Journal,
    context: &mut RunContext,
) -> Result<Summary, CurriculumError> {
    let total = plan.num_experiences();
    let (jobs, catalogue, stop) = (context.jobs.get(), context.catalogue.clone(), context.stop);
    let repeats = Repeats {
        count: context.repeated_evaluations,
        first: false,
    };
    let recorder = journal.records().then(Recorder::default);
    let worker = || Worker::new(plan, catalogue.clone(), stop, recorder.clone());
    let mut own = worker();
    let (mut worlds, mut block) = (Worlds::new(plan), None);
    let mut next = journal.num_experiences();
    while next < total {
        let learns = agent.learns();
        let planned = &plan.regimes[plan.regime_of(next)];
        let has_budgets = plan.regimes.iter().any(|planned| planned.steps.is_some());
        let end = if learns || has_budgets {
            plan.end_of_kind(next)
        } else {
            total
        };
        // Which experiences a budget allows depends on those before them.
        let is_independent = planned.kind == BlockKind::Evaluation || !(learns || has_budgets);
        let repeats = if learns { repeats } else { Repeats::default() };
        let copies: Option<Vec<_>> = is_independent
            .then(|| {
                let copy = |_| Some((agent.frozen()?, worker()));
                (0..jobs).map(copy).collect()
            })
            .flatten();
        let flow = if let Some(copies) = copies {
            run_in_parallel(plan, &with_repeats(plan, next..end, repeats), copies, journal, context)?
        } else {
            let mut one_by_one = OneByOne {
                agent,
                worker: &mut own,
                watch: context.watch,
                repeats,
            };
            let state = (&mut worlds, &mut block);
            rollout::run_range(plan, next..end, state, &mut one_by_one, journal, context.now)?
        };
        if flow.is_break() {
            break;
        }
        next = journal.num_experiences().max(end);
    }
    Ok(journal.summary().clone())
}

/// Lets a learning agent repeat the learning experiences among the first `done`, without logging, to restore the state that it
/// had after them. For agents that do not save what they learned. Does nothing for an agent that does not learn. `Break` if it
/// was stopped.
///
/// # Errors
/// [`CurriculumError`] with block, regime and experience.
pub fn relearn(
    plan: &Plan,
    agent: &mut dyn Agent,
    done: u64,
    context: &mut RunContext,
) -> Result<ControlFlow<()>, CurriculumError> {
    if !agent.learns() {
        return Ok(ControlFlow::Continue(()));
    }
    let mut worker = Worker::new(plan, context.catalogue.clone(), context.stop, None);
    let mut one_by_one = OneByOne {
        agent,
        worker: &mut worker,
        watch: context.watch,
        repeats: Repeats::default(),
    };
    rollout::relearn_range(plan, 0..done, (&mut Worlds::new(plan), &mut None), &mut one_by_one)
}

/// The experiences with a flag for repeats: some experiences of each evaluation block are repeated at its end.
fn with_repeats(plan: &Plan, numbers: Range<u64>, repeats: Repeats) -> Vec<(u64, bool)> {
    let mut items = Vec::new();
    let (mut block, mut repeated) = (None, Vec::new());
    for number in numbers {
        let planned = &plan.regimes[plan.regime_of(number)];
        if block.replace(planned.block) != Some(planned.block) {
            items.extend(repeated.drain(..).map(|number| (number, true)));
            repeated = plan.repeated(number, repeats);
        }
        items.push((number, false));
    }
    items.extend(repeated.drain(..).map(|number| (number, true)));
    items
}

/// Runs independent experiences in parallel, and logs them in order; repeats are not logged but must give the same result.
fn run_in_parallel(
    plan: &Plan,
    items: &[(u64, bool)],
    copies: Vec<(Box<dyn Agent + Send>, Worker<'_>)>,
    journal: &mut Journal,
    context: &mut RunContext,
) -> Result<ControlFlow<()>, CurriculumError> {
    let repeated: BTreeSet<u64> = items
        .iter()
        .filter_map(|(number, is_repeat)| is_repeat.then_some(*number))
        .collect();
    let work = |(agent, worker): &mut (Box<dyn Agent + Send>, Worker), item| {
        let outcome = worker.draw_and_run(agent.as_mut(), items[item as usize].0);
        (
            outcome,
            repeated.contains(&items[item as usize].0).then(|| worker.trace.clone()),
        )
    };
    let mut evaluated: BTreeMap<u64, (f64, Vec<u64>)> = BTreeMap::new();
    in_order::in_order(0..items.len() as u64, copies, work, |item, (outcome, trace)| {
        let (number, is_repeat) = items[item as usize];
        let progress = match outcome? {
            Outcome::CutOff => return Ok(ControlFlow::Break(())),
            Outcome::Over(finished) if is_repeat => {
                if let (Some((reward, first)), Some(trace)) = (evaluated.remove(&number), trace) {
                    let repeat = (finished.experience.reward, &trace[..]);
                    rollout::expect_frozen(plan, number, (reward, &first), repeat, journal)?;
                }
                return Ok(ControlFlow::Continue(()));
            }
            Outcome::LeftOut(_) if is_repeat => return Ok(ControlFlow::Continue(())),
            Outcome::Over(finished) => {
                evaluated.extend(trace.map(|trace| (number, (finished.experience.reward, trace))));
                journal.append(plan, number, *finished, (context.now)())?
            }
            Outcome::LeftOut(reason) => journal.leave_out(plan, number, &reason, (context.now)())?,
        };
        Ok((context.watch)(&progress))
    })
}

/// The outcome of an experience.
enum Outcome {
    /// It was run to its end.
    Over(Box<FinishedExperience>),
    /// It was skipped because its world cannot be drawn, with the reason.
    LeftOut(String),
    /// The run was stopped in the meantime.
    CutOff,
}

/// Runs experiences one at a time, in its own environment.
struct Worker<'a> {
    plan: &'a Plan,
    catalogue: Catalogue,
    stop: &'a AtomicBool,
    worlds: Worlds<'a>,
    environment: Option<Environment>,
    /// Records the actions, if requested.
    recorder: Option<Recorder>,
    /// A hash of each step of the last evaluation.
    trace: Vec<u64>,
}

impl<'a> Worker<'a> {
    fn new(plan: &'a Plan, catalogue: Catalogue, stop: &'a AtomicBool, recorder: Option<Recorder>) -> Self {
        Self {
            plan,
            catalogue,
            stop,
            worlds: Worlds::new(plan),
            environment: None,
            recorder,
            trace: Vec::new(),
        }
    }

    /// The recording of the last experience that was run to its end.
    fn recording(&self, experience: &Experience) -> Option<Recording> {
        let (recorder, environment) = self.recorder.as_ref().zip(self.environment.as_ref())?;
        Some(recorder.recording(environment, experience.ended_by))
    }

    fn draw_and_run(&mut self, agent: &mut dyn Agent, number: u64) -> Result<Outcome, CurriculumError> {
        if self.stop.load(Ordering::Relaxed) {
            return Ok(Outcome::CutOff);
        }
        let (world, between) = match self.worlds.draw(number)? {
            Ok(drawn) => drawn,
            Err(reason) => return Ok(Outcome::LeftOut(reason)),
        };
        let Some(experience) = self.run(agent, number, world)? else {
            return Ok(Outcome::CutOff);
        };
        Ok(Outcome::Over(Box::new(FinishedExperience {
            experience,
            between,
            recording: self.recording(&experience),
        })))
    }

    /// Runs one experience in its world; `None` if it was stopped.
    fn run(&mut self, agent: &mut dyn Agent, number: u64, world: World) -> Result<Option<Experience>, CurriculumError> {
        if self.stop.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let planned = &self.plan.regimes[self.plan.regime_of(number)];
        let failed = |source| CurriculumError::Episode {
            block: planned.block,
            regime: planned.regime,
            experience: number,
            source,
        };
        if let Some(recorder) = &mut self.recorder {
            recorder.begin(world.clone());
        }
        let environment = match &mut self.environment {
            Some(environment) => {
                environment.reset(world);
                environment
            }
            none => none.insert(Environment::with_catalogue(world, self.catalogue.clone())),
        };
        let episode = EpisodeContext {
            seed: planned.agent_seed(number),
            label: planned.label(number),
            learn: planned.kind == BlockKind::Learning,
            stop: self.stop,
        };
        // Only evaluations are ever repeated.
        let trace = (!episode.learn).then_some(&mut self.trace);
        episode::run_episode(agent, environment, self.recorder.as_mut(), trace, &episode).map_err(failed)
    }
}

/// The rollout of an agent in this process, one experience after the other.
struct OneByOne<'a, 'b> {
    agent: &'a mut dyn Agent,
    worker: &'a mut Worker<'b>,
    watch: &'a mut dyn FnMut(&Progress) -> ControlFlow<()>,
    repeats: Repeats,
}

impl Rollout for OneByOne<'_, '_> {
    type Error = CurriculumError;

    fn repeats(&self) -> Repeats {
        self.repeats
    }

    fn trace(&self) -> Vec<u64> {
        self.worker.trace.clone()
    }

    fn experience(&mut self, number: u64, world: World) -> Result<Option<Experience>, CurriculumError> {
        self.worker.run(self.agent, number, world)
    }

    fn recording(&mut self, _number: u64, experience: &Experience) -> Result<Option<Recording>, CurriculumError> {
        Ok(self.worker.recording(experience))
    }

    fn logged(&mut self, progress: &Progress, _reward: Option<f64>) -> Result<ControlFlow<()>, CurriculumError> {
        Ok((self.watch)(progress))
    }
}
