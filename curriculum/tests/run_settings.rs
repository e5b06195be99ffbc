//! Runs scenarios with a stopped clock, so that logs can be compared byte for byte.

use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use driftworld_curriculum::{CurriculumError, FoundWorld, Journal, Plan, Progress, RunContext, Sources, Summary, run};
use driftworld_env::{Agent, Catalogue};
use driftworld_metrics::Timestamp;
use driftworld_spec::{Scenario, World};

/// Settings for running a scenario in a test.
pub(crate) struct RunSettings {
    /// Stops after this many experiences.
    pub(crate) max_experiences: u64,
    pub(crate) jobs: usize,
    /// Whether the run continues an existing log.
    pub(crate) resume: bool,
    /// Number of evaluations per block that are run twice.
    pub(crate) repeated: usize,
    /// Stops the run at the next step.
    pub(crate) stop: Arc<AtomicBool>,
}

impl Default for RunSettings {
    fn default() -> Self {
        Self {
            max_experiences: u64::MAX,
            jobs: 1,
            resume: false,
            repeated: 0,
            stop: Arc::default(),
        }
    }
}

impl RunSettings {
    /// Calls `act` with the context of a run.
    pub(crate) fn context<T>(&self, act: &mut dyn FnMut(&mut RunContext) -> T) -> T {
        act(&mut RunContext {
            now: &mut now,
            watch: &mut |progress: &Progress| {
                if progress.done < self.max_experiences {
                    ControlFlow::Continue(())
                } else {
                    ControlFlow::Break(())
                }
            },
            stop: &self.stop,
            catalogue: Catalogue::default(),
            jobs: NonZeroUsize::new(self.jobs).expect("at least one job"),
            repeated_evaluations: self.repeated,
        })
    }

    /// Runs a plan with an agent and writes the log.
    pub(crate) fn run(&self, plan: &Plan, agent: &mut dyn Agent, log: &Path) -> Result<Summary, CurriculumError> {
        let mut journal = if self.resume {
            Journal::resume(log, plan, "test")?
        } else {
            Journal::create(log, plan, "test")?
        };
        let summary = self.context(&mut |context| run(plan, agent, &mut journal, context))?;
        journal.finish()?;
        Ok(summary)
    }
}

/// The time of the stopped clock.
pub(crate) fn now() -> Timestamp {
    Timestamp::from_unix_micros(1_600_000_000_000_000).expect("the year is 2020")
}

/// The plan of a scenario that has world files and no tasks.
pub(crate) fn plan_of_worlds(scenario: &Scenario, world: impl Fn(&str) -> World) -> Plan {
    let mut sources = Sources {
        task: &mut |_| Err("no tasks here".to_owned()),
        world: &mut |path| {
            Ok(FoundWorld {
                world: world(path),
                note: None,
            })
        },
    };
    Plan::new(scenario, &mut sources).expect("the plan is valid")
}
