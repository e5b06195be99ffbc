//! A run that is stopped ends at the next step: the experience in progress leaves no row, and the log can be resumed.

use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

use driftworld_curriculum::{FoundWorld, Journal, Plan, RunContext, Sources, Summary, run};
use driftworld_env::{Action, Agent, Catalogue, Environment, RandomAgent};
use driftworld_metrics::Timestamp;
use driftworld_spec::{Block, BlockKind, Regime, Scenario, World};

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
    let mut sources = Sources {
        task: &mut |_| Err("no tasks here".to_owned()),
        world: &mut |_| {
            Ok(FoundWorld {
                world: world.clone(),
                note: None,
            })
        },
    };
    Plan::new(&scenario, &mut sources).expect("the plan is sound")
}

/// Acts at random, and sets a flag before a step, counted over all its copies.
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

/// Continues a log, and stops before a given step of the agent; `u64::MAX` for none.
fn live(log: &Path, jobs: usize, before: u64) -> (Summary, u64) {
    let (plan, stop) = (plan(), Arc::new(AtomicBool::new(false)));
    let mut agent = Stopper {
        acts: RandomAgent::new(0),
        steps: Arc::default(),
        before: before.min(u64::MAX - 64),
        stop: Arc::clone(&stop),
    };
    let mut journal = Journal::resume(log, &plan, "test").expect("the log can be written");
    let mut around = RunContext {
        now: &mut || Timestamp::from_unix_micros(1_600_000_000_000_000).expect("the year is 2020"),
        watch: &mut |_| ControlFlow::Continue(()),
        stop: &stop,
        catalogue: Catalogue::default(),
        jobs: NonZeroUsize::new(jobs).expect("somebody has to live it"),
        repeated_evaluations: driftworld_curriculum::REPEATED_EVALUATIONS,
    };
    let summary = run(&plan, &mut agent, &mut journal, &mut around).expect("it is lived");
    journal.finish().expect("the log is whole");
    let steps = agent.steps.load(Ordering::SeqCst);
    (summary, steps)
}

/// The contents of all files of a log.
fn bytes(log: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut found = BTreeMap::new();
    let mut folders = vec![log.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("the log can be listed").flatten() {
            let path = entry.path();
            match std::fs::read(&path) {
                Ok(bytes) => drop(found.insert(path.strip_prefix(log).expect("inside").display().to_string(), bytes)),
                Err(_) => folders.push(path),
            }
        }
    }
    found
}

#[test]
fn a_run_stops_at_any_step_and_goes_on_to_the_same_log() {
    let folder = tempfile::tempdir().expect("the machine has a folder for temporary files");
    let whole = folder.path().join("whole");
    let (summary, steps) = live(&whole, 1, u64::MAX);
    assert!(summary.finished && summary.experiences == 12);
    assert_eq!(steps, STEPS);
    let expected = bytes(&whole);
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
        assert_eq!(bytes(&log), expected, "{jobs} jobs, stopped before step {before}");
    }
}
