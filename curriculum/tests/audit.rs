//! Audits of valid protocols, and of one that an agent can exploit by remembering layouts.

use std::sync::Arc;

use driftworld_curriculum::{
    AuditOptions, AuditRow, Choice, CurriculumError, Design, Drifting, Plan, Sources, audit, design,
};
use driftworld_spec::{Scenario, ScenarioForm, TaskSpec};

fn task() -> Arc<TaskSpec> {
    let text = r#"{ "version": 2, "name": "yard", "parameters": {
            "pay": { "role": "variant", "type": "number", "affects": ["R"], "range": [0, 10], "default": 1 } },
        "world": { "max_steps": 3 },
        "groups": [{ "name": "cubes", "count": 1, "object": { "class": "cube" },
            "placement": { "box": { "low": [10, 10], "high": [18, 18] } } }],
        "variants": { "one": {}, "two": { "pay": 2 }, "three": { "pay": 3 } } }"#;
    TaskSpec::from_json("yard.json", text).unwrap_or_else(|error| panic!("{error}"))
}

fn audit_rows(options: &Design) -> Vec<AuditRow> {
    let variants = ["one", "two", "three"].map(|variant| Choice::new("yard", variant));
    let scenario = design(&variants, options).expect("the design is valid");
    let task = task();
    let mut plan = |scenario: &Scenario| -> Result<Plan, CurriculumError> {
        let mut sources = Sources {
            task: &mut |_| Ok(Arc::clone(&task)),
            world: &mut |path| Err(format!("{path}: not there")),
        };
        Plan::new(scenario, &mut sources)
    };
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let short = AuditOptions {
        lifetimes: 10,
        repeats: 8,
    };
    let rows = audit(&scenario, &mut plan, folder.path(), short).unwrap_or_else(|error| panic!("{error}"));
    let num_left = std::fs::read_dir(folder.path()).expect("the folder exists").count();
    assert_eq!(num_left, 0, "the logs are removed");
    rows
}

fn sized(options: Design) -> Design {
    Design {
        learn: 60,
        evaluate: 20,
        ..options
    }
}

#[track_caller]
fn check(options: Design, expected: [Option<bool>; 5]) {
    let rows = audit_rows(&sized(options));
    let found: Vec<Option<bool>> = rows.iter().map(|row| row.passed).collect();
    assert_eq!(found, expected, "{rows:#?}");
}

#[test]
fn designs_pass_the_audit() {
    let all_passed = [Some(true); 5];
    check(Design::default(), all_passed);
    if std::env::var_os("DRIFTWORLD_FULL").is_none() {
        return;
    }
    let dispersed = Design {
        form: Some(ScenarioForm::Dispersed),
        blocks: Some(7),
        pre_deployment: 30,
        ..Design::default()
    };
    check(dispersed, all_passed);
}

#[test]
fn only_an_agent_with_memory_exploits_shared_layouts() {
    let paired = Design {
        paired_learning: true,
        ..Design::default()
    };
    check(paired, [Some(true), Some(true), Some(false), Some(true), Some(true)]);
}

#[test]
fn scenario_without_evaluations_is_audited_only_in_part() {
    let without_evaluation = Design {
        evaluation: driftworld_curriculum::Evaluate::After(Vec::new()),
        ..Design::default()
    };
    check(without_evaluation, [None, None, Some(true), Some(true), None]);
}

#[test]
fn drift_audit_shows_forgetting() {
    let drifting = Design {
        drifting: Some(Drifting::default()),
        ..Design::default()
    };
    let rows = audit_rows(&sized(drifting));
    assert_eq!(rows[4].passed, Some(true), "{rows:#?}");
    // There is no single-task expert for a drift.
    for row in &rows[2..4] {
        assert!(
            row.found.starts_with("a drift is learned under a name of its own"),
            "{row:?}"
        );
    }
}
