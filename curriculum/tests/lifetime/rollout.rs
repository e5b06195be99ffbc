//! Rollouts that run experiences outside this crate: logged identically, and relearned if the agent was not saved.

use std::ops::ControlFlow;
use std::path::Path;

use driftworld_curriculum::{CurriculumError, ENDED_BY, Experience, Journal, Plan, Progress, Rollout, run_rollout};
use driftworld_env::RandomAgent;
use driftworld_metrics::Record;
use driftworld_spec::{BlockKind, World};

use crate::run_settings::now;

use super::{log_text, plan, rows, run_scenario, scratch, varied};

/// Returns the experiences of another log.
struct Replay {
    records: std::vec::IntoIter<Record>,
    /// The run ends after this number of experiences.
    max_experiences: u64,
    blocks: Vec<bool>,
}

impl Rollout for Replay {
    type Error = CurriculumError;

    fn begin_block(&mut self, learning: bool, _: &[u64]) -> Result<(), CurriculumError> {
        self.blocks.push(learning);
        Ok(())
    }

    fn experience(&mut self, number: u64, _world: World) -> Result<Option<Experience>, CurriculumError> {
        let record = self.records.find(|record| record.exp_num == number);
        Ok(record.map(|record| Experience {
            reward: record.metrics["reward"],
            success: record.metrics["success"] == 1.0,
            steps: record.metrics["episode_step_count"] as u32,
            seconds: record.metrics["time_to_completion"],
            truncated: record.metrics["truncated"] == 1.0,
            ended_by: record.texts.get(ENDED_BY).and_then(|word| word.parse().ok()),
        }))
    }

    fn logged(&mut self, progress: &Progress, reward: Option<f64>) -> Result<ControlFlow<()>, CurriculumError> {
        assert!(reward.is_some());
        Ok(if progress.done < self.max_experiences {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        })
    }
}

#[test]
fn experiences_run_elsewhere_are_logged_identically() {
    let (folder, scenario) = (scratch(), varied());
    let (here, there) = (folder.path().join("here"), folder.path().join("there"));
    let expected =
        run_scenario(&scenario, &mut RandomAgent::new(0), &here, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
    let plan = plan(&scenario).unwrap_or_else(|error| panic!("{error}"));
    // Interrupted once, and resumed.
    for (max_experiences, begin) in [
        (8, Journal::create as fn(&Path, &Plan, &str) -> _),
        (99, Journal::resume),
    ] {
        let mut journal = begin(&there, &plan, "test").unwrap_or_else(|error| panic!("{error}"));
        let records = rows(&here).into_iter();
        let mut replay = Replay {
            records,
            max_experiences,
            blocks: Vec::new(),
        };
        let learned = journal.num_experiences();
        let summary = run_rollout(&plan, &mut replay, &mut journal, learned, &mut now);
        let summary = summary.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(summary.finished, max_experiences == 99);
        if max_experiences == 99 {
            assert_eq!(summary, expected);
        }
        journal.finish().unwrap_or_else(|error| panic!("{error}"));
    }
    assert_eq!(log_text(&there), log_text(&here));
}

/// Records the numbers of the requested experiences, and ends the run at number 9.
#[derive(Default)]
struct Counting(Vec<u64>);
impl Rollout for Counting {
    type Error = CurriculumError;
    fn experience(&mut self, number: u64, _world: World) -> Result<Option<Experience>, CurriculumError> {
        self.0.push(number);
        Ok((number < 9).then(Experience::default))
    }
    fn logged(&mut self, _: &Progress, _: Option<f64>) -> Result<ControlFlow<()>, CurriculumError> {
        Ok(ControlFlow::Continue(()))
    }
}

#[test]
fn unsaved_learning_is_repeated() {
    let (folder, scenario) = (scratch(), varied());
    let log = folder.path().join("log");
    run_scenario(&scenario, &mut RandomAgent::new(0), &log, 9).unwrap_or_else(|error| panic!("{error}"));
    let before = log_text(&log);
    let plan = plan(&scenario).unwrap_or_else(|error| panic!("{error}"));
    for learned in [0, 4, 9] {
        let mut journal = Journal::resume(&log, &plan, "test").unwrap_or_else(|error| panic!("{error}"));
        let mut counting = Counting::default();
        run_rollout(&plan, &mut counting, &mut journal, learned, &mut now).unwrap_or_else(|error| panic!("{error}"));
        let is_learning = |number: &u64| {
            plan.experience_spec(*number)
                .is_ok_and(|spec| spec.kind == BlockKind::Learning)
        };
        let expected: Vec<u64> = (learned..9).filter(is_learning).chain([9]).collect();
        assert_eq!(counting.0, expected);
        assert_eq!(journal.num_experiences(), 9);
        journal.finish().unwrap_or_else(|error| panic!("{error}"));
    }
    assert_eq!(log_text(&log), before);
}
