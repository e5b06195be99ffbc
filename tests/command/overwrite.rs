//! What is not written over: files of a log, and what a command reads itself.

use std::fs;

use super::terminal::{fail, scratch, succeed, text};

const TASK: &str = r#"{ "name": "orchard", "version": 2, "variants": { "ripe": {}, "sour": {} } }"#;

#[test]
fn what_a_command_reads_is_not_written_over() {
    let folder = scratch();
    let path = folder.path().join("orchard.json");
    fs::write(&path, TASK).expect("the scratch folder can be written");
    let named = format!("{}#ripe", path.display());
    let task = text(&path);
    let ways: [&[&str]; 6] = [
        &["sample", task, "-o", task],
        &["sample", &named, "-o", task],
        &["sample", &named, "--count", "3", "--jsonl", "-o", task],
        &["curriculum", task, "-o", task],
        &["convert", &named, "-o", task],
        &["order", task, "--matrix", task],
    ];
    for way in ways {
        let said = fail(1, way);
        assert!(said.contains("found the input file"), "{way:?}: {said}");
        assert_eq!(fs::read_to_string(&path).expect("it is there"), TASK, "{way:?}");
    }
    // Another name will do.
    succeed(&["sample", task, "-o", text(&folder.path().join("world.json"))]);
}

#[test]
fn files_of_a_log_are_not_written_over() {
    let folder = scratch();
    let scenario = folder.path().join("s.json");
    let log = folder.path().join("log");
    succeed(&[
        "curriculum",
        "find_objects#red",
        "find_objects#blue",
        "--learn",
        "1",
        "--eval-episodes",
        "1",
        "-o",
        text(&scenario),
    ]);
    succeed(&["run", text(&scenario), "--agent", "random", "--output", text(&log)]);
    let rows = log.join("worker-default/0-test/data-log.tsv");
    for file in [log.join("scenario_info.json"), log.join("logger_info.json"), rows] {
        let before = fs::read(&file).expect("it is a file of the log");
        let ways: [&[&str]; 2] = [
            &["report", text(&log), "-o", text(&file)],
            &["sample", "find_objects#red", "-o", text(&file)],
        ];
        for way in ways {
            let said = fail(1, way);
            assert!(said.contains("the log would be overwritten"), "{way:?}: {said}");
            assert_eq!(fs::read(&file).expect("it is there"), before, "{way:?}");
        }
    }
    // A file of that name elsewhere is anybody's.
    succeed(&[
        "sample",
        "find_objects#red",
        "-o",
        text(&folder.path().join("logger_info.json")),
    ]);
}
