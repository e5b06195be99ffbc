//! Writes the logs of simulated agents: a row for every experience of a plan, as in a real run, without sampling any world.

use std::ops::ControlFlow;
use std::path::Path;

use driftworld_metrics::{Log, Timestamp, read_log};
use driftworld_spec::World;

use crate::run::{ExperienceData, FinishedExperience};
use crate::{
    CurriculumError, Experience, Journal, Plan, Progress, REPEATED_EVALUATIONS, Repeats, Rollout, run_rollout,
};

/// A simulated agent: returns the reward of its next experience.
pub(super) type Simulated<'a> = dyn FnMut(&ExperienceData) -> f64 + 'a;

/// Runs an agent and reads its log; the files stay in the folder.
pub(super) fn simulate(plan: &Plan, agent: &mut Simulated<'_>, folder: &Path) -> Result<Log, CurriculumError> {
    let mut journal = Journal::simulated(folder, plan)?;
    for number in 0..plan.num_experiences() {
        let finished = FinishedExperience {
            experience: of_one_step(agent(&plan.experience_data(number))),
            ..FinishedExperience::default()
        };
        journal.append(
            plan,
            number,
            finished,
            Timestamp::from_unix_micros(number.cast_signed())?,
        )?;
    }
    journal.finish()?;
    Ok(read_log(folder)?)
}

/// Runs an agent like any other, including the check that it is frozen in evaluations. Returns the number of evaluation
/// experiences run.
pub(super) fn run(plan: &Plan, agent: &mut Simulated<'_>, folder: &Path) -> Result<u64, CurriculumError> {
    let mut journal = Journal::simulated(folder, plan)?;
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
        let data = self.plan.experience_data(number);
        self.num_evaluated += u64::from(!data.learning);
        Ok(Some(of_one_step((self.agent)(&data))))
    }

    fn logged(&mut self, _: &Progress, _: Option<f64>) -> Result<ControlFlow<()>, CurriculumError> {
        Ok(ControlFlow::Continue(()))
    }
}

/// An experience of one step with this reward.
fn of_one_step(reward: f64) -> Experience {
    Experience {
        reward,
        steps: 1,
        ..Experience::default()
    }
}
