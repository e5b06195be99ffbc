//! Runs that are killed, stopped by signals or out of disk space at random moments and then resumed write the same bytes as
//! undisturbed runs. Other commands leave existing files unchanged.
//!
//! `DRIFTWORLD_FAULTS` sets the number of faults, `DRIFTWORLD_FAULTS_SEED` their seed.
#![cfg(unix)]

use std::collections::BTreeMap;
use std::fs;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use super::run_files::{is_table, write};
use super::terminal::{driftworld_in, output, root, scratch, signals, succeed_in};
use crate::files_below::files_below;

/// Maximum number of faults in one lifetime; after that it runs undisturbed.
const MAX_FAULTS: u64 = 12;

/// The time of all rows, so that logs can be compared byte for byte.
const CLOCK: (&str, &str) = ("DRIFTWORLD_CLOCK", "2026-01-31T12:00:00Z");

/// Random numbers, by `SplitMix64`.
struct Rng(u64);

impl Rng {
    fn below(&mut self, end: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        (mixed ^ (mixed >> 31)) % end
    }
}

fn setting(name: &str, default: u64) -> u64 {
    let set = std::env::var(name).ok();
    set.map_or(default, |text| {
        text.parse()
            .unwrap_or_else(|_| panic!("{name}: found `{text}`, expected a number"))
    })
}

/// The command with a file size limit in half kilobytes. Exceeding it is an error, as on a full disk, not a signal.
fn with_room(folder: &Path, half_kilobytes: u64, arguments: &[&str]) -> Command {
    let mut command = Command::new("sh");
    command.args(["-c", "ulimit -f \"$0\"; exec \"$@\""]);
    command
        .arg(half_kilobytes.to_string())
        .arg(env!("CARGO_BIN_EXE_driftworld"));
    command.args(arguments).current_dir(folder).env(CLOCK.0, CLOCK.1);
    command
}

/// Whether it succeeded, or failed with exit code 1 and a message.
fn is_orderly(ended: &Output) -> bool {
    let error = String::from_utf8_lossy(&ended.stderr);
    let code = ended.status.code();
    !error.contains("panicked") && (code == Some(0) || code == Some(1) && error.contains("error: "))
}

/// A lifetime of three blocks.
fn scenario(folder: &Path) {
    let regime = |variant: &str, count: u64| {
        format!(
            r#"{{ "task": "find_objects", "variant": "{variant}", "count": {count}, "seed": 5, "max_steps": 120 }}"#
        )
    };
    let (blue, red, learned) = (regime("blue", 4), regime("red", 4), regime("red", 15));
    let scenario = format!(
        r#"{{ "name": "faults", "blocks": [
            {{ "type": "evaluation", "regimes": [{blue}, {red}] }},
            {{ "type": "learning", "regimes": [{learned}] }},
            {{ "type": "evaluation", "regimes": [{blue}, {red}] }} ] }}"#
    );
    write(&folder.join("scenario.json"), &scenario);
}

/// Starts or resumes a run and applies one fault; returns whether the run ended before the fault.
fn run_with_fault(folder: &Path, arguments: &[&str], took: Duration, size: u64, rng: &mut Rng) -> bool {
    let kind = rng.below(4);
    if kind == 0 {
        let ended = output(&mut with_room(folder, 1 + rng.below(size / 512 + 1), arguments));
        let error = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert!(is_orderly(&ended), "{}: {error}", ended.status);
        assert!(ended.status.success() || error.contains("File too large"), "{error}");
        let tables = files_below(&folder.join("log"))
            .into_iter()
            .filter(|(name, _)| is_table(name));
        let torn: Vec<_> = tables.filter(|(_, bytes)| bytes.last() != Some(&b'\n')).collect();
        assert_eq!(torn, [], "a partial row is left");
        return ended.status.success();
    }
    let mut command = driftworld_in(folder, arguments);
    command
        .env(CLOCK.0, CLOCK.1)
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    let child = command.spawn().expect("the command starts");
    thread::sleep(took.mul_f64(rng.below(1000) as f64 / 800.0));
    let signals: Vec<_> = signals().chain([("-KILL", 9), ("-KILL", 9), ("-KILL", 9)]).collect();
    let (signal, number) = signals[rng.below(signals.len() as u64) as usize];
    // Fails if the run has ended.
    let _ = Command::new("kill")
        .args([signal, &child.id().to_string()])
        .stderr(Stdio::null())
        .status();
    let ended = child.wait_with_output().expect("the command ends");
    let error = String::from_utf8_lossy(&ended.stderr).into_owned();
    let is_stopped = ended.status.signal() == Some(number) || ended.status.code() == Some(128 + number);
    assert!(
        is_stopped || ended.status.success(),
        "{signal}: {}: {error}",
        ended.status
    );
    assert!(!error.contains("panicked"), "{signal}: {error}");
    !is_stopped
}

#[test]
fn disturbed_runs_continue_to_the_same_bytes() {
    let seed = setting("DRIFTWORLD_FAULTS_SEED", 2026);
    let mut rng = Rng(seed);
    let is_full = std::env::var_os("DRIFTWORLD_FULL").is_some();
    let mut left = setting("DRIFTWORLD_FAULTS", if is_full { 30 } else { 10 });
    let folder = scratch();
    let folder = folder.path();
    scenario(folder);
    let mut undisturbed = BTreeMap::new();
    while left > 0 {
        let agent = ["random", "onrails"][rng.below(2) as usize];
        let jobs = ["1", "2", "4"][rng.below(3) as usize];
        let run = |log: &'static str| {
            let line = "run scenario.json --resume --agent";
            line.split(' ')
                .chain([agent, "--jobs", jobs, "--output", log])
                .collect::<Vec<_>>()
        };
        let (expected, took) = undisturbed.entry(agent).or_insert_with(|| {
            let start = Instant::now();
            let done = output(driftworld_in(folder, &run("undisturbed")).env(CLOCK.0, CLOCK.1));
            assert!(done.status.success());
            let files = files_below(&folder.join("undisturbed"));
            fs::remove_dir_all(folder.join("undisturbed")).expect("it was written");
            (files, start.elapsed())
        });
        let largest = expected.values().map(Vec::len).max().unwrap_or_default() as u64;
        for _ in 0..MAX_FAULTS.min(left) {
            if run_with_fault(folder, &run("log"), *took, largest, &mut rng) {
                break;
            }
            left -= 1;
        }
        let last = output(driftworld_in(folder, &run("log")).env(CLOCK.0, CLOCK.1));
        let error = String::from_utf8_lossy(&last.stderr);
        assert!(last.status.success(), "seed {seed}, {left} faults left: {error}");
        let found = files_below(&folder.join("log"));
        let names = found.keys().chain(expected.keys());
        let differing: Vec<&String> = names.filter(|name| found.get(*name) != expected.get(*name)).collect();
        assert_eq!(
            differing, [""; 0],
            "seed {seed}, {left} faults left, {agent}, {jobs} jobs"
        );
        fs::remove_dir_all(folder.join("log")).expect("it was written");
    }
}

#[test]
fn files_are_unchanged_without_disk_space() {
    let folder = scratch();
    let folder = folder.path();
    scenario(folder);
    succeed_in(
        folder,
        &["run", "scenario.json", "--agent", "random", "--output", "log"],
    );
    for (line, name) in [
        (
            "sample find_objects#red --count 60 --jsonl -o out/worlds.jsonl",
            "worlds.jsonl",
        ),
        ("sample find_objects#red -o out/world.json", "world.json"),
        ("order find_objects --matrix out/matrix.csv", "matrix.csv"),
        (
            "curriculum find_objects#red find_objects#blue --force -o out/scenario.json",
            "scenario.json",
        ),
        ("sheet find_objects#red --size 32 -o out/sheet.png", "sheet.png"),
        ("logs aggregate log -o out/rows.tsv", "rows.tsv"),
        ("metrics log --output-dir out --output scores", "scores.json"),
        ("report log -o out/page.html", "page.html"),
    ] {
        let arguments: Vec<&str> = line.split(' ').collect();
        let path = folder.join("out").join(name);
        write(&path, "older");
        let before = files_below(&folder.join("out"));
        let ended = output(&mut with_room(folder, 0, &arguments));
        let error = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert_eq!(ended.status.code(), Some(1), "{line}: {error}");
        assert!(
            is_orderly(&ended) && error.contains("File too large"),
            "{line}: {error}"
        );
        assert_eq!(files_below(&folder.join("out")), before, "{line}");
        succeed_in(folder, &arguments);
        assert_ne!(files_below(&folder.join("out")), before, "{line}");
        fs::remove_dir_all(folder.join("out")).expect("it was written");
    }
}

#[test]
fn full_device_is_an_error() {
    for line in [
        "sample find_objects#red --count 60 --jsonl -o /dev/full",
        "sheet find_objects#red --size 32 -o /dev/full",
    ] {
        let arguments: Vec<&str> = line.split(' ').collect();
        let ended = output(&mut driftworld_in(root(), &arguments));
        let error = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert_eq!(ended.status.code(), Some(1), "{line}: {error}");
        assert!(is_orderly(&ended) && error.contains("No space left"), "{line}: {error}");
    }
}
