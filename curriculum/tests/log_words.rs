//! Text columns and notes in our logs: how each experience ended, and the scenario's own description.

use std::path::Path;

use driftworld_curriculum::{CurriculumError, ENDED_BY, ENDING, Experience, REPEATED_EVALUATIONS};
use driftworld_env::ScriptedAgent;
use driftworld_metrics::{Complexity, Difficulty, read_log, validate_log};
use driftworld_spec::{Block, BlockKind, Regime, Scenario, ScenarioComplexity, ScenarioDifficulty, World};

use crate::run_settings::{RunSettings, plan_of_worlds};

/// Three worlds, each with a target ahead: it ends the episode as a success, as a failure, or not at all.
fn world(path: &str) -> World {
    let rules = match path {
        "success.json" => r#""rules": { "success": [{ "touch": "goal" }] },"#,
        "failure.json" => r#""rules": { "failure": [{ "touch": "goal" }] },"#,
        _ => "",
    };
    let text = format!(
        r#"{{ "max_steps": 60, {rules} "objects": [{{ "class": "cube", "tag": "goal", "coordinates": [0, 6], "reward": 1,
            "reward_stimulus": ["AgentCollide"] }}] }}"#
    );
    World::from_json(path, &text).unwrap_or_else(|error| panic!("{error}"))
}

fn scenario() -> Scenario {
    let regime = |name: &str| Regime {
        world: Some(format!("{name}.json")),
        ..Regime::new("end", name, 2)
    };
    let regimes = ["success", "failure", "nothing"].map(regime).to_vec();
    Scenario {
        complexity: Some(ScenarioComplexity::Low),
        difficulty: Some(ScenarioDifficulty::Medium),
        ..Scenario::new("ends", vec![Block::new(BlockKind::Evaluation, regimes)])
    }
}

fn run_scenario(log: &Path, max_experiences: u64, resume: bool) -> Result<(), CurriculumError> {
    // The built-in planner would avoid the failing target.
    let mut agent = ScriptedAgent::parse("touch", "touch goal 60\nrepeat\n").expect("the script is valid");
    let settings = RunSettings {
        max_experiences,
        resume,
        repeated: REPEATED_EVALUATIONS,
        ..RunSettings::default()
    };
    settings.run(&plan_of_worlds(&scenario(), world), &mut agent, log)?;
    Ok(())
}

/// The texts in a column; `None` if the log has no such column.
fn words(log: &Path, column: &str) -> Option<Vec<String>> {
    let text = std::fs::read_to_string(log.join("worker-default/0-test/data-log.tsv")).expect("the log has this file");
    let mut rows = text.lines().map(|line| line.split('\t').collect::<Vec<_>>());
    let index = rows.next()?.iter().position(|name| *name == column)?;
    Some(rows.map(|row| row[index].to_owned()).collect())
}

#[test]
fn log_records_how_each_experience_ended() {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let log = folder.path().join("log");
    run_scenario(&log, u64::MAX, false).unwrap_or_else(|error| panic!("{error}"));
    let found = words(&log, ENDING).expect("the column exists");
    assert_eq!(
        found,
        ["success", "success", "failure", "failure", "step_limit", "step_limit"]
    );
    let read = read_log(&log).unwrap_or_else(|error| panic!("{error}"));
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    assert!(read.rows.metric(ENDING).is_none(), "it is not a metric");
    let found = words(&log, ENDED_BY).expect("the column exists");
    let of = |ending: &str| if ending == "step_limit" { "steps" } else { "touch" };
    let endings = words(&log, ENDING).expect("the column exists");
    assert_eq!(found, endings.iter().map(|ending| of(ending)).collect::<Vec<_>>());
}

#[test]
fn log_records_the_scenarios_own_description() {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let log = folder.path().join("log");
    run_scenario(&log, u64::MAX, false).unwrap_or_else(|error| panic!("{error}"));
    let info = read_log(&log).unwrap_or_else(|error| panic!("{error}")).scenario_info;
    assert_eq!(
        (info.complexity, info.difficulty),
        (Some(Complexity::Low), Some(Difficulty::Medium))
    );
    let validation = validate_log(&log);
    let warnings: Vec<String> = validation.warnings.iter().map(ToString::to_string).collect();
    assert!(
        !warnings.iter().any(|warning| warning.contains("complexity")),
        "{warnings:?}"
    );
}

#[test]
fn log_without_an_ending_column_is_resumed_without_it() {
    let folder = tempfile::tempdir().expect("a temporary folder can be created");
    let (old, whole) = (folder.path().join("old"), folder.path().join("whole"));
    run_scenario(&old, 3, false).unwrap_or_else(|error| panic!("{error}"));
    run_scenario(&whole, u64::MAX, false).unwrap_or_else(|error| panic!("{error}"));
    for log in [&old, &whole] {
        let file = log.join("worker-default/0-test/data-log.tsv");
        let text = std::fs::read_to_string(&file).expect("the log has this file");
        let header: Vec<&str> = text.lines().next().expect("there is a header").split('\t').collect();
        let without = |line: &str| {
            let cells = line.split('\t').zip(&header);
            let kept = cells.filter(|(_, name)| **name != ENDING && **name != ENDED_BY);
            kept.map(|(cell, _)| cell).collect::<Vec<_>>().join("\t") + "\n"
        };
        std::fs::write(&file, text.lines().map(without).collect::<String>()).expect("the folder is writable");
    }
    run_scenario(&old, u64::MAX, true).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((words(&old, ENDING), words(&old, ENDED_BY)), (None, None));
    let text = |log: &Path| {
        std::fs::read_to_string(log.join("worker-default/0-test/data-log.tsv")).expect("the log has this file")
    };
    assert_eq!(
        text(&old),
        text(&whole),
        "the same as an uninterrupted run without these columns"
    );
}

#[test]
fn endings_are_success_step_limit_and_failure() {
    let ended = |success, truncated| {
        Experience {
            success,
            truncated,
            ..Experience::default()
        }
        .ending()
    };
    assert_eq!(ended(true, false), "success");
    assert_eq!(ended(false, true), "step_limit");
    assert_eq!(ended(false, false), "failure");
}
