//! Logs of simulated agents: a row for every experience of a plan, as a run would write it, without drawing a world.

use std::ops::ControlFlow;
use std::path::Path;

use driftworld_metrics::{Log, LogWriter, LoggerInfo, Timestamp, read_log};
use driftworld_spec::World;

use crate::run::Meeting;
use crate::{
    COLUMNS, CurriculumError, Experience, Journal, Plan, Progress, REPEATED_EVALUATIONS, Repeats, Rollout, run_rollout,
};

/// An agent of which only the rewards are simulated: what it earns in its next experience.
pub(super) type Simulated<'a> = dyn FnMut(&Meeting) -> f64 + 'a;

/// The log of an agent's run; it stays in the folder.
pub(super) fn simulate(plan: &Plan, agent: &mut Simulated<'_>, folder: &Path) -> Result<Log, CurriculumError> {
    let columns = LoggerInfo::new(COLUMNS)?;
    let mut writer = LogWriter::create_unsynced(folder, &columns, &plan.scenario_info("simulated"))?;
    for number in 0..plan.num_experiences() {
        let reward = agent(&plan.meeting(number));
        let now = Timestamp::from_unix_micros(number.cast_signed())?;
        writer.write(&plan.simulated_record(number, reward, now))?;
    }
    writer.finish()?;
    Ok(read_log(folder)?)
}

/// Runs an agent as any other is run, with the check that it is frozen in evaluations. Says how many these were.
pub(super) fn run(plan: &Plan, agent: &mut Simulated<'_>, folder: &Path) -> Result<u64, CurriculumError> {
    let mut journal = Journal::create_unsynced(folder, plan, "simulated")?;
    let mut simulation = Simulation {
        plan,
        agent,
        num_evaluated: 0,
    };
    let start = Timestamp::from_unix_micros(0)?;
    run_rollout(plan, &mut simulation, &mut journal, 0, &mut || start)?;
    Ok(simulation.num_evaluated)
}

struct Simulation<'a> {
    plan: &'a Plan,
    agent: &'a mut Simulated<'a>,
    num_evaluated: u64,
}

impl Rollout for Simulation<'_> {
    type Error = CurriculumError;

    fn repeats(&self) -> Repeats {
        Repeats {
            count: REPEATED_EVALUATIONS,
            first: false,
        }
    }

    fn experience(&mut self, number: u64, _world: World) -> Result<Option<Experience>, CurriculumError> {
        let meeting = self.plan.meeting(number);
        self.num_evaluated += u64::from(!meeting.learning);
        Ok(Some(Experience {
            reward: (self.agent)(&meeting),
            steps: 1,
            ..Experience::default()
        }))
    }

    fn logged(&mut self, _: &Progress, _: Option<f64>) -> Result<ControlFlow<()>, CurriculumError> {
        Ok(ControlFlow::Continue(()))
    }
}
