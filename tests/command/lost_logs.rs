//! A log that is removed, renamed, replaced or truncated while `run` writes it: the run ends with exit code 1 and reports the
//! loss.
#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::process::Stdio;

use super::run_files::{files, write};
use super::terminal::{Says, driftworld, scratch, succeed, text};

/// Many experiences, more than are run before the damage.
fn scenario(folder: &Path) -> String {
    let path = folder.join("scenario.json");
    let regime = r#"{ "task": "find_objects", "variant": "red", "count": 2000, "max_steps": 100 }"#;
    write(
        &path,
        &format!(r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{regime}] }}] }}"#),
    );
    text(&path).to_owned()
}

/// Runs until there are rows, damages the log, and returns the run's final message.
fn damage_log(jobs: &str, log: &Path, scenario: &str, damage: impl FnOnce(&Path)) -> String {
    let arguments = [
        "run",
        scenario,
        "--agent",
        "random",
        "--jobs",
        jobs,
        "--output",
        text(log),
    ];
    let mut command = driftworld(&arguments);
    let mut child = command
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let table = log.join("worker-default/0-train/data-log.tsv");
    while fs::metadata(&table).map_or(0, |found| found.len()) < 3000 {
        assert!(
            child.try_wait().expect("it has a status").is_none(),
            "the run ended before the damage"
        );
        std::thread::yield_now();
    }
    damage(&table);
    let ended = child.wait_with_output().expect("the child can be waited for");
    let error = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(1), "{error}");
    assert!(
        !error.contains("panicked") && !error.contains("all complete"),
        "{error}"
    );
    error
}

#[test]
fn missing_folder_is_an_error_and_is_not_recreated() {
    let folder = scratch();
    let scenario = scenario(folder.path());
    for jobs in ["1", "3"] {
        let log = folder.path().join(format!("deleted-{jobs}"));
        let error = damage_log(jobs, &log, &scenario, |_| {
            // Concurrent writes may interfere with the removal.
            while log.exists() {
                let _ = fs::remove_dir_all(&log);
            }
        });
        assert!(
            error.contains(&format!(
                "{}: found no directory, expected the directory",
                log.display()
            )) && error.contains(" rows in "),
            "{error}"
        );
        assert!(!log.exists());
        let log = folder.path().join(format!("swapped-{jobs}"));
        let away = log.with_extension("away");
        let error = damage_log(jobs, &log, &scenario, |_| {
            fs::rename(&log, &away).expect("the folder is writable");
            fs::create_dir(&log).expect("the folder is writable");
        });
        assert!(error.contains("found another directory"), "{error}");
        assert_eq!(fs::read_dir(&log).expect("it exists").count(), 0);
        assert!(away.join("logger_info.json").exists(), "the renamed log is intact");
    }
}

#[test]
fn truncated_removed_or_replaced_file_is_an_error() {
    let folder = scratch();
    let scenario = scenario(folder.path());
    for jobs in ["1", "3"] {
        let check = |name: &str, damage: &dyn Fn(&Path), expected: &str| {
            let log = folder.path().join(format!("{name}-{jobs}"));
            let error = damage_log(jobs, &log, &scenario, damage);
            assert!(
                error.contains("data-log.tsv: found ") && error.contains(expected),
                "{error}"
            );
        };
        let cut = |table: &Path| {
            let file = fs::OpenOptions::new().write(true).open(table);
            file.and_then(|file| file.set_len(1000)).expect("the file is writable");
        };
        check("cut", &cut, " in 1");
        check(
            "removed",
            &|table| fs::remove_file(table).expect("the file is writable"),
            "found no file",
        );
        let replace = |table: &Path| {
            fs::copy(table, table.with_extension("copy"))
                .and_then(|_| fs::rename(table.with_extension("copy"), table))
                .expect("the file is writable");
        };
        check("replaced", &replace, "expected the ");
    }
}

#[test]
fn new_run_in_a_replaced_folder_is_undisturbed() {
    let folder = scratch();
    let scenario = scenario(folder.path());
    let (log, small) = (folder.path().join("log"), folder.path().join("small.json"));
    let scenario_text = fs::read_to_string(&scenario).expect("it was written");
    write(&small, &scenario_text.replace("2000", "20"));
    damage_log("2", &log, &scenario, |_| {
        fs::rename(&log, log.with_extension("away")).expect("the folder is writable");
        succeed(&["run", text(&small), "--agent", "random", "--output", text(&log)]);
    });
    let alone = folder.path().join("alone");
    succeed(&["run", text(&small), "--agent", "random", "--output", text(&alone)]);
    assert_eq!(files(&log), files(&alone));
    succeed(&["logs", "validate", text(&log)]);
}

#[test]
fn stopped_clock_makes_logs_byte_identical() {
    let folder = scratch();
    let scenario = scenario(folder.path()).replace("scenario.json", "small.json");
    let scenario_text = fs::read_to_string(folder.path().join("scenario.json")).expect("it was written");
    write(Path::new(&scenario), &scenario_text.replace("2000", "20"));
    let bytes = |name: &str, jobs: &str| {
        let log = folder.path().join(name);
        let mut run = driftworld(&format!(
            "run {scenario} --agent random --jobs {jobs} --output {}",
            log.display()
        ));
        let run = run.env("DRIFTWORLD_CLOCK", "2026-01-31T12:00:00Z").output();
        assert!(run.is_ok_and(|run| run.status.success()));
        let table = fs::read_to_string(log.join("worker-default/0-train/data-log.tsv")).expect("it was written");
        assert_eq!(table.matches("\t20260131T120000.000000\t").count(), 20, "{table}");
        table
    };
    assert_eq!(bytes("first", "1"), bytes("second", "2"));
    let mut wrong = driftworld(&["run", &scenario, "--output", text(&folder.path().join("wrong"))]);
    let wrong = wrong
        .env("DRIFTWORLD_CLOCK", "yesterday")
        .output()
        .expect("the command starts");
    assert_eq!(wrong.status.code(), Some(1));
    let error = String::from_utf8_lossy(&wrong.stderr).into_owned();
    error.says("DRIFTWORLD_CLOCK: found \"yesterday\", expected a UTC time");
    assert!(!folder.path().join("wrong").exists(), "nothing was started");
}
