//! Tests that `sample` leaves no partial output if it fails, is stopped or is killed.
#![cfg(unix)]

use std::path::Path;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

use super::terminal::{driftworld_in, fail_in, scratch, signal, signals, succeed_in};

/// More worlds than can be drawn before the signal arrives.
const MANY: [&str; 4] = ["find_objects", "--count", "100000000", "--jsonl"];

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("the folder exists");
    let name =
        |entry: std::io::Result<std::fs::DirEntry>| entry.map(|entry| entry.file_name().to_string_lossy().into_owned());
    entries.map(|entry| name(entry).expect("it can be listed")).collect()
}

/// Starts a `sample` and waits until it writes into its folder.
fn start_sample(folder: &Path) -> Child {
    let arguments = [&["sample"], &MANY[..], &["-o", "worlds.jsonl"]].concat();
    let child = driftworld_in(folder, &arguments)
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let deadline = Instant::now() + Duration::from_secs(20);
    let is_written = || {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        entries
            .filter_map(|entry| entry.metadata().ok())
            .any(|file| file.len() > 0)
    };
    while !is_written() {
        assert!(Instant::now() < deadline, "nothing was written in time");
        std::thread::yield_now();
    }
    child
}

#[test]
fn stopped_sample_leaves_nothing() {
    for (name, number) in signals() {
        let folder = scratch();
        let child = start_sample(folder.path());
        signal(&child, name);
        let done = child.wait_with_output().expect("the command ends");
        let error = String::from_utf8_lossy(&done.stderr).into_owned();
        assert_eq!(done.status.code(), Some(128 + number), "{name}: {error}");
        assert!(
            error.contains("interrupted after ") && error.contains(" of 100000000 worlds"),
            "{name}: {error}"
        );
        assert_eq!(names(folder.path()), [""; 0], "{name}");
    }
}

#[test]
fn leftovers_of_a_killed_sample_are_removed_but_not_files_in_progress() {
    let folder = scratch();
    let path = folder.path();
    let mut child = start_sample(path);
    // A second process that writes the same file at the same time removes no file in progress.
    succeed_in(path, "sample find_objects --count 3 --jsonl -o worlds.jsonl");
    assert_eq!(names(path).len(), 2, "{:?}", names(path));
    signal(&child, "-KILL");
    child.wait().expect("the command ends");
    assert_eq!(names(path).len(), 2, "{:?}", names(path));
    succeed_in(path, "sample find_objects --count 3 --jsonl -o worlds.jsonl");
    assert_eq!(names(path), ["worlds.jsonl"]);
}

#[test]
fn failed_sample_leaves_nothing() {
    let folder = scratch();
    let text = r#"{ "name": "t", "groups": [{ "name": "a", "count": { "integer_uniform": { "low": 1, "high": 60 } }, "separation": 3,
        "object": { "class": "cube" }, "placement": { "box": { "low": [0, 0], "high": [12, 12] } } }] }"#;
    std::fs::write(folder.path().join("crowded.json"), text).expect("the folder is writable");
    let command = "sample crowded.json --count 2000 --jsonl -o worlds.jsonl";
    fail_in(folder.path(), 1, command);
    assert_eq!(names(folder.path()), ["crowded.json"]);
}
