//! A run that is stopped ends at the next step: the experience in progress leaves no row, and the log can be resumed.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use driftworld_curriculum::{Plan, REPEATED_EVALUATIONS, Summary};
use driftworld_env::{Action, Agent, Environment, RandomAgent};
use driftworld_spec::{Block, BlockKind, Regime, Scenario, World};

use crate::files_below::files_below;
use crate::run_settings::{RunSettings, plan_of_worlds};

/// 12 experiences of 30 steps each.
const STEPS: u64 = 12 * 30;

fn plan() -> Plan {
    let regime = |count| Regime {
        world: Some("yard.json".to_owned()),
        ..Regime::new("find", "red", count)
    };
    let block = |kind, count| Block::new(kind, vec![regime(count)]);
    let scenario = Scenario::new(
        "stopped",
        vec![block(BlockKind::Evaluation, 5), block(BlockKind::Learning, 7)],
    );
    let world = World::from_json("yard.json", r#"{ "max_steps": 30 }"#).expect("the world is valid");
    plan_of_worlds(&scenario, |_| world.clone())
}

/// Acts at random, and sets a flag before a given step; steps are counted across all its copies.
#[derive(Clone)]
struct Stopper {
    random: RandomAgent,
    steps: Arc<AtomicU64>,
    before: u64,
    stop: Arc<AtomicBool>,
}

impl Agent for Stopper {
    fn act(&mut self, environment: &Environment) -> Action {
        assert!(
            self.steps.load(Ordering::SeqCst) <= self.before + 64,
            "an agent keeps acting after the stop"
        );
        if self.steps.fetch_add(1, Ordering::SeqCst) == self.before {
            self.stop.store(true, Ordering::SeqCst);
        }
        self.random.act(environment)
    }

    fn begin(&mut self, seed: u64) {
        self.random.begin(seed);
    }

    fn learns(&self) -> bool {
        false
    }

    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        Some(Box::new(self.clone()))
    }
}

/// Continues a log, and stops before a given step of the agent; never with `u64::MAX`.
fn run_scenario(log: &Path, jobs: usize, before: u64) -> (Summary, u64) {
    let (plan, stop) = (plan(), Arc::new(AtomicBool::new(false)));
    let mut agent = Stopper {
        random: RandomAgent::new(0),
        steps: Arc::default(),
        before: before.min(u64::MAX - 64),
        stop: Arc::clone(&stop),
    };
    let settings = RunSettings {
        jobs,
        resume: true,
        repeated: REPEATED_EVALUATIONS,
        stop,
        ..RunSettings::default()
    };
    let summary = settings.run(&plan, &mut agent, log).expect("the run succeeds");
    let steps = agent.steps.load(Ordering::SeqCst);
    (summary, steps)
}

#[test]
fn run_stopped_at_any_step_resumes_to_the_same_log() {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let whole = folder.path().join("whole");
    let (summary, steps) = run_scenario(&whole, 1, u64::MAX);
    assert!(summary.finished && summary.experiences == 12);
    assert_eq!(steps, STEPS);
    let expected = files_below(&whole);
    for (jobs, before) in (0..STEPS).step_by(23).map(|before| (1 + before as usize % 3, before)) {
        let log = folder.path().join(format!("{before}"));
        let (summary, num_steps) = run_scenario(&log, jobs, before);
        // Each thread may be in the middle of a step.
        assert!(
            num_steps <= before + jobs as u64,
            "{jobs} jobs, stopped before step {before}: {num_steps} steps"
        );
        assert!(!summary.finished, "{jobs} jobs, stopped before step {before}");
        if jobs == 1 {
            assert_eq!(
                summary.experiences,
                before / 30,
                "stopped before step {before}: the experience in progress is not counted"
            );
        }
        let (summary, _) = run_scenario(&log, jobs, u64::MAX);
        assert!(summary.finished);
        assert_eq!(files_below(&log), expected, "{jobs} jobs, stopped before step {before}");
    }
}
