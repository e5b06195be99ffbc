//! A small scenario lived from the first experience to the last: logged, repeatable, scorable, interruptible.

use std::ops::ControlFlow;
use std::path::Path;
use std::sync::Arc;

use driftworld_curriculum::{
    Choice, CurriculumError, Design, Progress, Summary, Surroundings, design, logger_info, run, scenario_info,
};
use driftworld_env::{Agent, Catalogue, OnRailsAgent, RandomAgent};
use driftworld_metrics::{LogWriter, MaintenanceMethod, Options, Timestamp, read_log, score};
use driftworld_spec::{Scenario, TaskSpec, Variant};

fn task() -> Arc<TaskSpec> {
    let path = format!("{}/../examples/tasks/find_objects.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("the example tasks ship with the project");
    TaskSpec::from_json("find_objects.json", &text).unwrap_or_else(|error| panic!("{error}"))
}

fn scenario(variants: &[&str]) -> Scenario {
    let choices: Vec<Choice> = variants.iter().map(|name| Choice::new("find_objects", *name)).collect();
    let options = Design {
        name: "small".to_owned(),
        learn: 3,
        evaluate: 2,
        seed: 5,
        ..Design::default()
    };
    design(&choices, &options).expect("the design is sound")
}

/// Lives a scenario by a clock that ticks a second at each look, and stops after `most` experiences.
fn live(scenario: &Scenario, agent: &mut dyn Agent, folder: &Path, most: u64) -> Result<Summary, CurriculumError> {
    let task = task();
    let mut seconds = 1_600_000_000;
    let mut log = LogWriter::create(folder, &logger_info()?, &scenario_info(scenario, "test"))?;
    let mut around = Surroundings {
        find: &mut |name, variant| -> Result<Variant, String> {
            if name == "find_objects" {
                task.variant(variant).map_err(|e| e.to_string())
            } else {
                Err("no such task".to_owned())
            }
        },
        now: &mut || {
            seconds += 1;
            Timestamp::from_unix_micros(seconds * 1_000_000).expect("the year is 2020")
        },
        watch: &mut |progress: &Progress| {
            if progress.done < most {
                ControlFlow::Continue(())
            } else {
                ControlFlow::Break(())
            }
        },
        catalogue: Catalogue::default(),
    };
    let summary = run(scenario, agent, &mut log, &mut around)?;
    log.finish()?;
    Ok(summary)
}

fn scratch() -> tempfile::TempDir {
    tempfile::tempdir().expect("the machine has a folder for temporary files")
}

/// All data files of a log with their paths, as one text.
fn everything(folder: &Path) -> String {
    let mut files = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in std::fs::read_dir(next).expect("the log can be listed") {
            let path = entry.expect("the log can be listed").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                files.push(path);
            }
        }
    }
    files.sort();
    let texts = files
        .iter()
        .map(|path| std::fs::read_to_string(path).expect("logs are text"));
    texts.collect::<Vec<_>>().join("\n")
}

#[test]
fn a_lifetime_is_logged_and_can_be_scored() {
    let (folder, scenario) = (scratch(), scenario(&["blue", "red"]));
    let log = folder.path().join("log");
    let summary = live(&scenario, &mut OnRailsAgent::new(), &log, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
    assert!(summary.finished);
    assert_eq!((summary.experiences, scenario.num_experiences()), (18, 18));
    assert!(
        summary
            .regimes
            .iter()
            .all(|regime| regime.success_rate == 1.0 && regime.mean_reward > 400.0)
    );
    let read = read_log(&log).unwrap_or_else(|error| panic!("{error}"));
    assert!(read.warnings.is_empty(), "{:?}", read.warnings);
    let options = Options {
        maintenance_method: MaintenanceMethod::Both,
        ..Options::default()
    };
    let scores = score(&read, &[], &options).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((scores.num_lx, scores.num_ex), (6, 12));
    assert_eq!(
        scores.lifetime.perf_maintenance_mrlep,
        Some(0.0),
        "the same worlds, an agent that does not learn"
    );
    assert_eq!(scores.lifetime.forward_transfer_ratio, Some(1.0));
    assert_eq!(scores.lifetime.backward_transfer_ratio, Some(1.0));
}

#[test]
fn a_lifetime_repeats_to_the_byte_and_agents_differ() {
    let folder = scratch();
    let lived = |name: &str, agent: &mut dyn Agent| {
        let log = folder.path().join(name);
        live(&scenario(&["red", "dusk"]), agent, &log, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
        everything(&log)
    };
    let first = lived("first", &mut RandomAgent::new(0));
    assert_eq!(
        first,
        lived("second", &mut RandomAgent::new(99)),
        "the agent's numbers come from the scenario"
    );
    assert_ne!(first, lived("third", &mut OnRailsAgent::new()));
}

/// `DRIFTWORLD_UPDATE_GOLDEN=1` rewrites the file.
#[test]
fn the_golden_log_is_written_as_it_was() {
    let folder = scratch();
    let log = folder.path().join("log");
    live(&scenario(&["huddle"]), &mut OnRailsAgent::new(), &log, u64::MAX).unwrap_or_else(|error| panic!("{error}"));
    let found = everything(&log);
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden/log.txt");
    if std::env::var_os("DRIFTWORLD_UPDATE_GOLDEN").is_some() {
        std::fs::write(path, &found).expect("the golden file can be written");
    }
    assert_eq!(
        found,
        std::fs::read_to_string(path).expect("the golden file is committed")
    );
}

#[test]
fn a_run_that_is_stopped_leaves_a_log_that_reads() {
    let folder = scratch();
    let log = folder.path().join("log");
    let summary =
        live(&scenario(&["blue"]), &mut RandomAgent::new(0), &log, 4).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!((summary.experiences, summary.finished), (4, false));
    assert_eq!(
        read_log(&log).unwrap_or_else(|error| panic!("{error}")).records.len(),
        4
    );
}

#[test]
fn what_cannot_be_lived_says_where() {
    let folder = scratch();
    let mut odd = scenario(&["blue"]);
    odd.blocks[1].regimes[0].variant = "bleu".to_owned();
    let error = live(&odd, &mut RandomAgent::new(0), &folder.path().join("a"), u64::MAX).expect_err("no such variant");
    assert_eq!(
        error.to_string(),
        "block 1, regime 0: find_objects#bleu: find_objects: found variant \"bleu\", expected one of blue, red, green, \
         dusk, huddle, penalty; did you mean \"blue\"?"
    );
    let log = folder.path().join("b");
    live(&scenario(&["blue"]), &mut RandomAgent::new(0), &log, 1).unwrap_or_else(|error| panic!("{error}"));
    let again = live(&scenario(&["blue"]), &mut RandomAgent::new(0), &log, 1).expect_err("a log is never written over");
    assert_eq!(again.code(), "curriculum/log");
}
