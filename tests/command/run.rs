//! `driftworld run`: runs that are stopped and resumed, inputs that change between runs, and files that scenarios name.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use super::run_files::{files, num_rows, write};
use super::terminal::{Says, driftworld, fail, output, scratch, succeed, text};

/// A lifetime of 3 blocks and 36 experiences, a few milliseconds each.
fn scenario(folder: &Path) -> PathBuf {
    longer_scenario(folder, 80)
}

/// The same lifetime with at most this number of steps per experience.
fn longer_scenario(folder: &Path, max_steps: u32) -> PathBuf {
    let path = folder.join("scenario.json");
    let regime = |variant: &str, count: u32| {
        format!(
            r#"{{ "task": "find_objects", "variant": "{variant}", "count": {count}, "seed": 5, "max_steps": {max_steps} }}"#
        )
    };
    let (blue, red) = (regime("blue", 4), regime("red", 4));
    let learning = regime("red", 20);
    let text = format!(
        r#"{{ "name": "interrupted", "blocks": [
            {{ "type": "evaluation", "regimes": [{blue}, {red}] }},
            {{ "type": "learning", "regimes": [{learning}] }},
            {{ "type": "evaluation", "regimes": [{blue}, {red}] }} ] }}"#
    );
    write(&path, &text);
    path
}

fn start(arguments: &[&str]) -> Child {
    let mut command = driftworld(arguments);
    let command = command.stdout(Stdio::null()).stderr(Stdio::piped());
    command.spawn().expect("the command was built by cargo and starts")
}

/// Number of complete rows in a log that is being written, or does not exist yet.
#[cfg(unix)]
fn num_whole_rows(log: &Path) -> usize {
    let table = log.join("worker-default/0-test/data-log.tsv");
    let text = fs::read_to_string(table).unwrap_or_default();
    text.matches('\n').count().saturating_sub(1)
}

/// Sends a signal to a run as soon as there is a row; returns its final message. `None` if it finished before.
#[cfg(unix)]
fn stop_with_signal(arguments: &[&str], log: &Path, signal: &str) -> Option<String> {
    let mut child = start(arguments);
    // Interrupted experiences leave no row, so wait for a complete one.
    while num_whole_rows(log) == 0 && child.try_wait().expect("it has a status").is_none() {
        std::thread::yield_now();
    }
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(sent.is_ok(), "the system has the command kill");
    let output = child.wait_with_output().expect("the child can be waited for");
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    if output.status.success() {
        fs::remove_dir_all(log).expect("the log can be removed");
        return None;
    }
    let code = if signal == "-INT" { 130 } else { 143 };
    assert_eq!(output.status.code(), Some(code), "{error}");
    Some(error)
}

#[cfg(unix)]
#[test]
fn stopped_run_keeps_complete_rows_and_says_how_to_continue() {
    let folder = scratch();
    let scenario = longer_scenario(folder.path(), 1000);
    let whole = folder.path().join("whole");
    let all = ["run", text(&scenario), "--agent", "random", "--jobs", "1", "--json"];
    let stdout = succeed(&[&all[..], &["--output", text(&whole)]].concat());
    for signal in ["-INT", "-TERM"] {
        let log = folder.path().join(signal);
        let arguments = [&all[..], &["--output", text(&log)]].concat();
        // If the run finishes before the signal arrives, try again.
        let error = (0..10).find_map(|_| stop_with_signal(&arguments, &log, signal));
        let error = error.expect("a signal reaches the run before it finishes");
        assert!(error.contains("interrupted") && error.contains("--resume"), "{error}");
        let rows = num_rows(&log);
        assert!(
            rows > 0 && error.contains(&format!("holds {rows} of 36 experiences, all complete")),
            "{error}"
        );
        let warnings = || fail(0, &["logs", "validate", text(&log)]);
        warnings().says(&format!(
            "the log ends after {rows} of the 36 experiences of its scenario"
        ));
        // The second time, nothing is left to do.
        for _ in 0..2 {
            assert_eq!(succeed(&[&arguments[..], &["--resume"]].concat()), stdout, "{signal}");
            assert_eq!(files(&log), files(&whole), "{signal}");
        }
        assert!(!warnings().contains("the log ends"), "{}", warnings());
    }
}

#[test]
fn log_of_another_run_is_refused_and_unchanged() {
    let folder = scratch();
    let scenario = scenario(folder.path());
    let log = folder.path().join("log");
    succeed(&["run", text(&scenario), "--agent", "random", "--output", text(&log)]);
    let before = files(&log);
    let resume = |scenario: &Path, agent: &str| {
        let error = fail(
            1,
            &format!(
                "run {} --agent {agent} --output {} --resume",
                scenario.display(),
                log.display()
            ),
        );
        assert_eq!(files(&log), before);
        error
    };
    let error = resume(&scenario, "onrails");
    error.says("/agent: found \"random\", expected \"onrails\" as in this run");
    let other = folder.path().join("other.json");
    let changed = fs::read_to_string(&scenario)
        .expect("it was written")
        .replace("\"count\": 20", "\"count\": 21");
    write(&other, &changed);
    let error = resume(&other, "random");
    error.says("/scenario/blocks/1/regimes/0/count: found 20, expected 21");
}

#[test]
fn task_changed_between_runs_is_detected() {
    let folder = scratch();
    let task = folder.path().join("lamps.json");
    let spec = r#"{ "name": "lamps", "variants": { "dim": {} }, "world": { "max_steps": 5,
        "environment_params": { "light_intensity": 2 } } }"#;
    write(&task, spec);
    let scenario = folder.path().join("scenario.json");
    let regime = format!(r#"{{ "task": {:?}, "variant": "dim", "count": 2 }}"#, text(&task));
    write(
        &scenario,
        &format!(r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{regime}] }}] }}"#),
    );
    let log = folder.path().join("log");
    succeed(&["run", text(&scenario), "--output", text(&log)]);
    write(&task, &spec.replace("intensity\": 2", "intensity\": 3"));
    let error = fail(1, &["run", text(&scenario), "--output", text(&log), "--resume"]);
    assert!(error.contains("/made_from/lamps#dim/variant: found"), "{error}");
}

#[test]
fn changed_task_with_the_same_first_world_is_detected() {
    let folder = scratch();
    let task = folder.path().join("lamps.json");
    let spec = r#"{ "name": "lamps", "world": { "max_steps": 5 }, "parameters": {
        "light": { "role": "randomized", "type": "number", "affects": ["O"],
            "distribution": { "choice": { "values": [1, 2], "weights": [1, 1] } } } } }"#;
    let first = |weights: &str| {
        write(&task, &spec.replace("[1, 1]", weights));
        succeed(&["sample", text(&task), "--seed", "0"])
    };
    let (odd, even) = (first("[5, 1]"), first("[1, 1]"));
    assert_eq!(odd, even, "the light is not used, so that the worlds are the same");
    let scenario = folder.path().join("scenario.json");
    let regime = format!(r#"{{ "task": {:?}, "variant": "default", "count": 2 }}"#, text(&task));
    write(
        &scenario,
        &format!(r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{regime}] }}] }}"#),
    );
    let log = folder.path().join("log");
    let run = ["run", text(&scenario), "--output", text(&log), "--resume"];
    succeed(&run);
    write(&task, &spec.replace("\"max_steps\"", "  \"max_steps\""));
    succeed(&run);
    write(&task, &spec.replace("[1, 1]", "[5, 1]"));
    let error = fail(1, &run);
    assert!(error.contains("/made_from/lamps#default/variant: found"), "{error}");
}

#[test]
fn script_edited_between_runs_is_detected() {
    let folder = scratch();
    let (scenario, log) = (scenario(folder.path()), folder.path().join("log"));
    let script = folder.path().join("way.txt");
    let run = format!(
        "run {} --agent scripted:{} --output {} --resume",
        scenario.display(),
        script.display(),
        log.display()
    );
    write(&script, "step 3 1 0 0\n");
    succeed(&run);
    let before = files(&log);
    succeed(&run);
    write(&script, "step 4 1 0 0\n");
    let error = fail(1, &run);
    assert!(error.contains("/made_from/script: found"), "{error}");
    assert_eq!(files(&log), before);
}

#[test]
fn task_beside_the_scenario_is_found_from_any_folder() {
    let folder = scratch();
    let task = r#"{ "name": "lamps", "world": { "max_steps": 5 } }"#;
    write(&folder.path().join("own/tasks/lamps.json"), task);
    let scenario = folder.path().join("own/scenario.json");
    let regime = r#"{ "task": "tasks/lamps.json", "variant": "default", "count": 1 }"#;
    write(
        &scenario,
        &format!(r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{regime}] }}] }}"#),
    );
    let stdout = succeed(&["run", text(&scenario), "--output", text(&folder.path().join("log"))]);
    assert!(stdout.contains("lamps#default"), "{stdout}");
}

#[test]
fn converting_a_scenario_away_from_its_worlds_causes_a_warning() {
    let folder = scratch();
    let scenario = folder.path().join("scenario.json");
    let regime = r#"{ "task": "a", "variant": "v", "world": "yard.json", "count": 1 }"#;
    write(
        &scenario,
        &format!(r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{regime}] }}] }}"#),
    );
    write(&folder.path().join("yard.json"), "{}");
    let warns = |to: &str| {
        let to = folder.path().join(to);
        let output = output(&mut driftworld(&["convert", text(&scenario), "-o", text(&to)]));
        String::from_utf8_lossy(&output.stderr).contains("names the world file \"yard.json\", which is missing")
    };
    assert!(warns("elsewhere/scenario.json"));
    assert!(!warns("again.json"));
}

#[test]
fn every_missing_variant_is_named() {
    let folder = scratch();
    let scenario = folder.path().join("scenario.json");
    let regime = |variant: &str| format!(r#"{{ "task": "find_objects", "variant": "{variant}", "count": 1 }}"#);
    let regimes = ["rde", "red", "bleu"].map(regime).join(", ");
    write(
        &scenario,
        &format!(r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{regimes}] }}] }}"#),
    );
    let log = folder.path().join("log");
    let error = fail(1, &["run", text(&scenario), "--output", text(&log)]);
    assert!(error.contains("rde") && error.contains("bleu"), "{error}");
    assert!(!log.exists(), "nothing was started");
}
