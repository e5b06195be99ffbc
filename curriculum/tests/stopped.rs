//! A run that is stopped ends at the next step: the experience in progress leaves no row, and the log can be resumed.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use driftworld_curriculum::{Plan, REPEATED_EVALUATIONS, Summary};
use driftworld_env::{Action, Agent, Environment, RandomAgent};
use driftworld_spec::{Block, BlockKind, Regime, Scenario, World};

use crate::files_below::files_below;
use crate::living::{Living, plan_of_worlds};

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
    let world = World::from_json("yard.json", r#"{ "max_steps": 30 }"#).expect("it is a world");
    plan_of_worlds(&scenario, |_| world.clone())
}

/// Acts at random, and sets a flag before a given step; steps are counted over all its copies.
#[derive(Clone)]
struct Stopper {
    acts: RandomAgent,
    steps: Arc<AtomicU64>,
    before: u64,
    stop: Arc<AtomicBool>,
}

impl Agent for Stopper {
    fn act(&mut self, environment: &Environment) -> Action {
        assert!(
            self.steps.load(Ordering::SeqCst) <= self.before + 64,
            "somebody steps on and on"
        );
        if self.steps.fetch_add(1, Ordering::SeqCst) == self.before {
            self.stop.store(true, Ordering::SeqCst);
        }
        self.acts.act(environment)
    }

    fn begin(&mut self, seed: u64) {
        self.acts.begin(seed);
    }

    fn learns(&self) -> bool {
        false
    }

    fn frozen(&self) -> Option<Box<dyn Agent + Send>> {
        Some(Box::new(self.clone()))
    }
}

/// Continues a log, and stops before a given step of the agent; never with `u64::MAX`.
fn live(log: &Path, jobs: usize, before: u64) -> (Summary, u64) {
    let (plan, stop) = (plan(), Arc::new(AtomicBool::new(false)));
    let mut agent = Stopper {
        acts: RandomAgent::new(0),
        steps: Arc::default(),
        before: before.min(u64::MAX - 64),
        stop: Arc::clone(&stop),
    };
    let living = Living {
        jobs,
        resume: true,
        repeated: REPEATED_EVALUATIONS,
        stop,
        ..Living::default()
    };
    let summary = living.live(&plan, &mut agent, log).expect("it is lived");
    let steps = agent.steps.load(Ordering::SeqCst);
    (summary, steps)
}

#[test]
fn a_run_stops_at_any_step_and_goes_on_to_the_same_log() {
    let folder = tempfile::tempdir().expect("the machine has a folder for temporary files");
    let whole = folder.path().join("whole");
    let (summary, steps) = live(&whole, 1, u64::MAX);
    assert!(summary.finished && summary.experiences == 12);
    assert_eq!(steps, STEPS);
    let expected = files_below(&whole);
    for (jobs, before) in (0..STEPS).step_by(23).map(|before| (1 + before as usize % 3, before)) {
        let log = folder.path().join(format!("{before}"));
        let (summary, taken) = live(&log, jobs, before);
        // Each thread may be in the middle of a step.
        assert!(
            taken <= before + jobs as u64,
            "{jobs} jobs, stopped before step {before}: {taken} steps"
        );
        assert!(!summary.finished, "{jobs} jobs, stopped before step {before}");
        if jobs == 1 {
            assert_eq!(
                summary.experiences,
                before / 30,
                "what was cut off before step {before} is not counted"
            );
        }
        let (summary, _) = live(&log, jobs, u64::MAX);
        assert!(summary.finished);
        assert_eq!(files_below(&log), expected, "{jobs} jobs, stopped before step {before}");
    }
}
