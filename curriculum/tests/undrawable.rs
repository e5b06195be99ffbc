//! Worlds that cannot be drawn: they stop a run or are skipped, consistently for any number of jobs, and are detected before
//! the run.

use std::path::Path;
use std::sync::Arc;

use driftworld_curriculum::{
    Choice, CurriculumError, Design, Drifting, Journal, Plan, REPEATED_EVALUATIONS, Sources, Summary, Tried,
    Undrawable, design, try_worlds,
};
use driftworld_env::RandomAgent;
use driftworld_generator::sample;
use driftworld_metrics::{Options, read_log, score, validate_log};
use driftworld_spec::{DriftSchedule, DriftSwitch, Scenario, TaskSpec};

use crate::files_below::files_below;
use crate::run_settings::RunSettings;

/// Rocks that cannot be placed in some worlds, and a number with a forbidden middle range.
fn task() -> Arc<TaskSpec> {
    let text = r#"{ "version": 2, "name": "quarry", "require": ["x <= 4 or x >= 6"],
        "parameters": { "x": { "role": "variant", "type": "number", "affects": ["T"], "range": [0, 10], "default": 0 } },
        "world": { "max_steps": 3, "environment_params": { "map_size": [40, 40] } },
        "groups": [{ "name": "rocks", "count": 4, "object": { "class": "rock" }, "separation": 5,
            "keep_out": { "walls": 0, "agent": 0 }, "placement": { "box": { "low": [10, 10], "high": [18, 18] } } }],
        "variants": { "low": {}, "high": { "x": 10 } } }"#;
    TaskSpec::from_json("quarry.json", text).unwrap_or_else(|error| panic!("{error}"))
}

fn scenario(drifting: bool) -> Scenario {
    let options = Design {
        learn: 21,
        evaluate: 4,
        seed: 3,
        drifting: drifting.then_some(Drifting {
            schedule: DriftSchedule::Linear,
            switch: DriftSwitch::AtPoint,
        }),
        ..Design::default()
    };
    design(&[Choice::new("quarry", "low"), Choice::new("quarry", "high")], &options).expect("the design is valid")
}

fn plan(scenario: &Scenario, undrawable: Undrawable) -> Result<Plan, CurriculumError> {
    let task = task();
    let mut sources = Sources {
        task: &mut |_| Ok(Arc::clone(&task)),
        world: &mut |path| Err(format!("{path}: not there")),
    };
    Plan::with_undrawable(scenario, &mut sources, undrawable)
}

/// Runs at most `more` further experiences.
fn run_scenario(plan: &Plan, log: &Path, jobs: usize, more: u64) -> Result<Summary, CurriculumError> {
    let done = Journal::resume(log, plan, "test")?.num_experiences();
    let settings = RunSettings {
        max_experiences: done.saturating_add(more),
        jobs,
        resume: true,
        repeated: REPEATED_EVALUATIONS,
        ..RunSettings::default()
    };
    settings.run(plan, &mut RandomAgent::new(0), log)
}

/// The numbers of the experiences that cannot be run, found by drawing each world separately.
fn undrawable(plan: &Plan) -> Vec<u64> {
    (0..plan.num_experiences())
        .filter(|number| plan.world(*number).is_err())
        .collect()
}

#[test]
fn run_skips_undrawable_worlds_and_its_log_is_valid() {
    for drifting in [false, true] {
        let scenario = scenario(drifting);
        let plan = plan(&scenario, Undrawable::Skipped).expect("nothing is refused");
        let missing = undrawable(&plan);
        let total = plan.num_experiences();
        assert!(
            !missing.is_empty() && (missing.len() as u64) < total,
            "{missing:?} of {total}"
        );
        let folder = tempfile::tempdir().expect("a temporary folder can be created");
        let log = folder.path().join("log");
        let summary = run_scenario(&plan, &log, 1, u64::MAX).expect("the run succeeds");
        assert!(summary.finished);
        assert_eq!(
            (summary.skipped, summary.experiences),
            (missing.len() as u64, total - missing.len() as u64)
        );
        let left_out: Vec<u64> = summary.left_out.iter().map(|one| one.experience).collect();
        assert_eq!(left_out, missing);
        let num_skipped: u32 = summary.regimes.iter().map(|regime| regime.skipped).sum();
        assert_eq!(u64::from(num_skipped), summary.skipped);

        let rows = read_log(&log).expect("the log can be read").rows;
        assert_eq!(rows.len() as u64, total, "a row for every experience");
        for (number, row) in (0..).zip(rows.iter()) {
            assert_eq!(row.exp_num(), number);
            let is_missing = missing.contains(&number);
            assert_eq!(row.metric("reward").expect("it is a column").is_nan(), is_missing);
            assert_eq!(row.task_params().contains_key("skipped"), is_missing);
        }
        let report = validate_log(&log);
        assert!(report.problems.is_empty(), "{:?}", report.problems);
        score(&read_log(&log).expect("it can be read"), &[], &Options::default()).expect("the log can be scored");
        // Resuming the finished log changes nothing.
        assert_eq!(
            run_scenario(&plan, &log, 1, u64::MAX).expect("the log is complete"),
            summary
        );
    }
}

#[test]
fn log_does_not_depend_on_how_it_is_run() {
    let scenario = scenario(true);
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let skipping = plan(&scenario, Undrawable::Skipped).expect("nothing is refused");
    let [whole, jobs, pieces, stopped] = ["whole", "jobs", "pieces", "stopped"].map(|name| folder.path().join(name));
    run_scenario(&skipping, &whole, 1, u64::MAX).expect("the run succeeds");
    run_scenario(&skipping, &jobs, 3, u64::MAX).expect("the run succeeds");
    while !run_scenario(&skipping, &pieces, 1, 4)
        .expect("the run succeeds")
        .finished
    {}
    assert!(files_below(&whole) == files_below(&jobs), "run by three workers");
    assert!(files_below(&whole) == files_below(&pieces), "run in pieces");
    // A run that refuses such worlds stops there, reports where, and continues once it may skip them.
    if let Ok(refusing) = plan(&scenario, Undrawable::Refused) {
        let error = run_scenario(&refusing, &stopped, 1, u64::MAX).expect_err("some worlds cannot be drawn");
        let CurriculumError::World { experience, .. } = &error else {
            panic!("{error}")
        };
        assert_eq!(Some(experience), undrawable(&skipping).first(), "{error}");
        let again = run_scenario(&refusing, &stopped, 1, u64::MAX).expect_err("it stops there again");
        assert_eq!(again.to_string(), error.to_string());
    }
    run_scenario(&skipping, &stopped, 1, u64::MAX).expect("the run succeeds");
    assert!(files_below(&whole) == files_below(&stopped), "stopped and resumed");
}

#[test]
fn worlds_are_tried_before_the_run() {
    let variant = task().variant("low").expect("it is declared");
    let trial = try_worlds(&variant, 5, 40);
    let failed: Vec<u64> = (0..40).filter(|index| sample(&variant, 5, *index).is_err()).collect();
    assert!(!failed.is_empty());
    assert_eq!(
        (trial.worlds, trial.placement, trial.requirement),
        (40, failed.len() as u64, 0)
    );
    assert_eq!(trial.failed.iter().map(|one| one.index).collect::<Vec<_>>(), failed);

    let plan = plan(&scenario(true), Undrawable::Skipped).expect("nothing is refused");
    let mut tried = Tried::default();
    // Tries two worlds of each regime, and every variant of the drift, in which values between 4 and 6 are forbidden.
    let trials = plan.try_worlds(2, &mut tried);
    let drift = trials
        .iter()
        .find(|trial| trial.variant == "quarry#low..high")
        .expect("the scenario has a drift");
    assert_eq!(drift.requirement, 3, "{drift:?}");
    let progresses: Vec<f64> = drift
        .failed
        .iter()
        .filter(|one| one.code == "generator/between")
        .map(|one| one.progress)
        .collect();
    assert!(
        progresses.iter().all(|progress| *progress > 0.4 && *progress < 0.6),
        "{progresses:?}"
    );
    assert!(plan.try_worlds(2, &mut tried).is_empty(), "all worlds have been tried");
    // With all worlds, every one that cannot be run is found; the second evaluation has the same worlds as the first.
    let all = plan.try_worlds(u32::MAX, &mut Tried::default());
    let found: Vec<u64> = all
        .iter()
        .flat_map(|trial| trial.failed.iter().filter_map(|one| one.experience))
        .collect();
    let missing = undrawable(&plan);
    assert!(found.iter().all(|number| missing.contains(number)));
    assert!(
        missing
            .iter()
            .filter(|number| **number < 29)
            .all(|number| found.contains(number))
    );
}
