//! Living a scenario: experience after experience, each logged. Designing one is in `design.rs`, scoring it is `metrics`'.
//!
//! A [`Plan`] is a scenario with everything that it names, a [`Journal`] the log that it is lived into, [`run`] lives it.

mod columns;
mod episode;
mod gap;
mod in_order;
mod journal;
mod log_names;
mod plan;
mod summary;
mod undrawable;

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicBool, Ordering};

use driftworld_env::{Agent, Catalogue, Environment};
use driftworld_generator::Sampler;
use driftworld_metrics::Timestamp;
use driftworld_spec::{BlockKind, Variant};

pub use columns::{COLUMNS, ENDING};
pub use episode::{Experience, MOST_STEPS};
pub use journal::Journal;
pub use log_names::same_log_name;
pub use plan::{Due, FoundWorld, Plan, Sources, log_name};
pub use summary::{LeftOut, Progress, RegimeSummary, Summary};
pub use undrawable::{Failed, Trial, Tried, Undrawable, try_worlds};

use crate::CurriculumError;
use episode::Briefing;

/// What a run is handed, since it does not look at the clock.
pub struct Surroundings<'a> {
    /// The time now.
    pub now: &'a mut dyn FnMut() -> Timestamp,
    /// Told after each experience; may end the run there. What was lived until then is in the log.
    pub watch: &'a mut dyn FnMut(&Progress) -> ControlFlow<()>,
    /// Set from elsewhere, ends the run at the next step: experiences under way leave no row.
    pub stop: &'a AtomicBool,
    /// Where worlds take their assets from.
    pub catalogue: Catalogue,
    /// How many experiences are lived at the same time, where they do not depend on each other. Changes no byte of the log.
    pub jobs: NonZeroUsize,
}

/// Lives a scenario from the first experience that is not in the log to its last, and logs each as soon as it is over.
///
/// A run that is stopped ends at the next step, and its summary says that it is not finished.
///
/// An experience whose world cannot be drawn ends the run, or is left out, as the plan says ([`Undrawable`]); a log that ended there goes
/// on with a plan that leaves it out.
///
/// The order of experiences, their worlds and the numbers that the agent begins them with depend on the scenario alone:
/// a run that was interrupted and taken up again writes what an undisturbed one does. [`Agent::learn`] is called in learning
/// blocks only. An agent that learns lives learning blocks one experience after the other; whoever takes up a log with such an
/// agent hands over one that has learned what is in the log. Evaluation blocks, and all blocks of an agent that does not
/// learn, are lived by its [`Agent::frozen`] copies, several at a time.
///
/// # Errors
/// [`CurriculumError`] that says at which block, regime and experience; what was lived before is in the log.
pub fn run(
    plan: &Plan,
    agent: &mut dyn Agent,
    journal: &mut Journal,
    around: &mut Surroundings,
) -> Result<Summary, CurriculumError> {
    let total = plan.num_experiences();
    let (jobs, catalogue, stop) = (around.jobs.get(), around.catalogue.clone(), around.stop);
    let mut life = Life { plan, journal, around };
    let desk = || Desk::new(plan, catalogue.clone(), stop);
    let mut own = desk();
    let mut next = life.journal.num_experiences();
    while next < total {
        let learns = agent.learns();
        let end = if learns { plan.end_of_kind(next) } else { total };
        let still = !learns || plan.regimes[plan.regime_of(next)].kind == BlockKind::Evaluation;
        let copies: Option<Vec<_>> = (still && jobs > 1)
            .then(|| {
                let copy = |_| Some((agent.frozen()?, desk()));
                (0..jobs).map(copy).collect()
            })
            .flatten();
        let flow = match copies {
            Some(copies) => {
                let work =
                    |(agent, desk): &mut (Box<dyn Agent + Send>, Desk), number| desk.live(agent.as_mut(), number);
                in_order::in_order(next..end, copies, work, |number, lived| life.take(number, &lived?))?
            }
            None => life.one_by_one(next..end, agent, &mut own)?,
        };
        if flow.is_break() {
            break;
        }
        next = end;
    }
    Ok(life.journal.summary().clone())
}

/// What became of an experience.
enum Outcome {
    /// It was lived; with the variant that it was an experience of where its regime drifts.
    Lived {
        experience: Experience,
        between: Option<Box<Variant>>,
    },
    /// It was left out, since its world cannot be drawn.
    LeftOut { reason: String },
    /// The run was stopped meanwhile.
    CutOff,
}

/// Where experiences are lived, one at a time.
struct Desk<'a> {
    plan: &'a Plan,
    catalogue: Catalogue,
    stop: &'a AtomicBool,
    /// The regime that the last experience belonged to, and its sampler.
    sampler: Option<(usize, Option<Sampler>)>,
    environment: Option<Environment>,
}

impl<'a> Desk<'a> {
    fn new(plan: &'a Plan, catalogue: Catalogue, stop: &'a AtomicBool) -> Self {
        Self {
            plan,
            catalogue,
            stop,
            sampler: None,
            environment: None,
        }
    }

    fn live(&mut self, agent: &mut dyn Agent, number: u64) -> Result<Outcome, CurriculumError> {
        if self.stop.load(Ordering::Relaxed) {
            return Ok(Outcome::CutOff);
        }
        let index = self.plan.regime_of(number);
        let planned = &self.plan.regimes[index];
        let sampler = match &mut self.sampler {
            Some((regime, sampler)) if *regime == index => sampler,
            old => &mut old.insert((index, planned.sampler())).1,
        };
        let assignment = match planned.draw(number, sampler.as_ref()) {
            Ok(assignment) => assignment,
            Err(source) if self.plan.undrawable() == Undrawable::Skipped => {
                let reason = source.to_string();
                return Ok(Outcome::LeftOut { reason });
            }
            Err(source) => return Err(planned.wrong(number, source)),
        };
        let failed = |source| CurriculumError::Episode {
            block: planned.block,
            regime: planned.regime,
            experience: number,
            source,
        };
        let environment = match &mut self.environment {
            Some(environment) => {
                environment.reset(assignment.world).map_err(failed)?;
                environment
            }
            none => none.insert(Environment::with_catalogue(assignment.world, self.catalogue.clone()).map_err(failed)?),
        };
        let briefing = Briefing {
            seed: planned.chance(number),
            label: planned.label(number),
            learn: planned.kind == BlockKind::Learning,
            stop: self.stop,
        };
        let lived = episode::live(agent, environment, &briefing).map_err(failed)?;
        Ok(lived.map_or(Outcome::CutOff, |experience| Outcome::Lived {
            experience,
            between: assignment.between.map(Box::new),
        }))
    }
}

/// A lifetime under way.
struct Life<'a, 'b> {
    plan: &'a Plan,
    journal: &'a mut Journal,
    around: &'a mut Surroundings<'b>,
}

impl Life<'_, '_> {
    fn one_by_one(
        &mut self,
        numbers: std::ops::Range<u64>,
        agent: &mut dyn Agent,
        desk: &mut Desk,
    ) -> Result<ControlFlow<()>, CurriculumError> {
        for number in numbers {
            let lived = desk.live(agent, number)?;
            if self.take(number, &lived)?.is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        Ok(ControlFlow::Continue(()))
    }

    /// Logs an experience, counts it and tells whoever watches.
    fn take(&mut self, number: u64, outcome: &Outcome) -> Result<ControlFlow<()>, CurriculumError> {
        let mut now = || (self.around.now)();
        let progress = match outcome {
            Outcome::CutOff => return Ok(ControlFlow::Break(())),
            Outcome::Lived { experience, between } => {
                self.journal
                    .take(self.plan, number, experience, between.as_deref(), now())?
            }
            Outcome::LeftOut { reason } => self.journal.leave_out(self.plan, number, reason, now())?,
        };
        Ok((self.around.watch)(&progress))
    }
}
