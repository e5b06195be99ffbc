//! A signal ends a command at any point, even while it waits for a reader that never comes, and shells see the same exit code
//! from all commands: 130 for an interrupt. If a command does not end, the test reaches its time limit.
#![cfg(unix)]

use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};

use super::run_files::write;
use super::terminal::{driftworld_in, piped, scratch, signal, signals};

fn start(folder: &Path, arguments: &[&str]) -> Child {
    piped(driftworld_in(folder, arguments))
}

/// Waits until a condition holds for a running command.
fn wait_until(child: &mut Child, condition: impl Fn(&Child) -> bool) {
    while !condition(child) {
        let ended = child.try_wait().expect("it has a status");
        assert!(ended.is_none(), "it ended too early: {ended:?}");
        std::thread::yield_now();
    }
}

/// Whether the command handles signals yet, according to the system.
#[cfg(target_os = "linux")]
fn handles_signals(child: &Child) -> bool {
    let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
    let caught = caught.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    caught.is_some_and(|mask| mask & (1 << 14) != 0)
}

fn ended(child: Child) -> (Output, String) {
    let output = child.wait_with_output().expect("the command ends");
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    (output, error)
}

#[cfg(target_os = "linux")]
#[test]
fn command_waiting_for_a_reader_ends_by_the_signal() {
    let folder = scratch();
    let status = Command::new("mkfifo").arg(folder.path().join("pipe")).status();
    assert!(status.is_ok_and(|status| status.success()));
    for (name, number) in signals() {
        let mut child = start(
            folder.path(),
            &["sample", "find_objects", "--count", "3", "--jsonl", "-o", "pipe"],
        );
        wait_until(&mut child, handles_signals);
        signal(&child, name);
        let (output, error) = ended(child);
        assert_eq!(output.status.signal(), Some(number), "{error}");
    }
}

#[test]
fn command_with_a_blocked_reader_ends_with_a_message() {
    let folder = scratch();
    for (name, number) in signals() {
        // The pipe fills, and the command blocks in the middle of a line.
        let mut child = start(
            folder.path(),
            &["sample", "find_objects", "--count", "100000000", "--jsonl", "-o", "-"],
        );
        let mut unread = child.stdout.take().expect("it is a pipe");
        std::io::Read::read_exact(&mut unread, &mut [0; 1]).expect("a world arrives");
        signal(&child, name);
        let (output, error) = ended(child);
        drop(unread);
        assert_eq!(output.status.code(), Some(128 + number), "{error}");
        assert!(error.contains("error: interrupted"), "{error}");
    }
}

#[test]
fn long_experience_does_not_delay_the_end() {
    let folder = scratch();
    let path = folder.path();
    // Nothing in it can end an experience early.
    write(&path.join("endless.json"), r#"{ "version": 2, "name": "endless" }"#);
    let regime = r#"{ "task": "endless.json", "variant": "default", "count": 3, "max_steps": 1000000000 }"#;
    write(
        &path.join("scenario.json"),
        &format!(r#"{{ "name": "s", "blocks": [{{ "type": "learning", "regimes": [{regime}] }}] }}"#),
    );
    for (name, number) in signals() {
        let log = format!("log{name}");
        let mut child = start(path, &["run", "scenario.json", "--agent", "random", "--output", &log]);
        wait_until(&mut child, |_| path.join(&log).join("logger_info.json").exists());
        signal(&child, name);
        let (output, error) = ended(child);
        assert_eq!(output.status.code(), Some(128 + number), "{error}");
        assert!(error.contains("interrupted") && error.contains("--resume"), "{error}");
        let mut rows = fs::read_dir(path.join(&log)).expect("the log was started");
        assert!(
            !rows.any(|entry| entry.is_ok_and(|entry| entry.path().is_dir())),
            "an experience that was cut off left a row"
        );
    }
}

#[cfg(target_os = "linux")]
#[test]
fn hang_up_is_ignored_under_nohup() {
    let folder = scratch();
    let mut command = Command::new("nohup");
    let mut child = command
        .arg(env!("CARGO_BIN_EXE_driftworld"))
        .args("sample find_objects --count 2000 --jsonl -o worlds.jsonl".split(' '))
        .current_dir(folder.path())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the system has nohup");
    wait_until(&mut child, handles_signals);
    signal(&child, "-HUP");
    let (output, _) = ended(child);
    assert!(output.status.success());
    assert!(folder.path().join("worlds.jsonl").exists());
}
