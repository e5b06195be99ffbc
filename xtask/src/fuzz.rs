//! `cargo xtask fuzz`: lets libFuzzer look for bytes that break the laws in `fuzz/src/`, which the tests check on the
//! seeds, too.
//!
//! Inputs that took a new way stay in `fuzz/corpus/`, with which the next call begins; those that broke a law, in
//! `fuzz/artifacts/`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::error::XtaskError;
use crate::process::{nightly_cargo, not_started, run, shown};
use crate::workspace::Workspace;

/// The machine that is fuzzed on: coverage is counted only where it is named.
const MACHINE: &str = "x86_64-unknown-linux-gnu";

/// What makes the compiler count which ways a run takes, as cargo-fuzz asks it to.
const COVERAGE: &str = "--cfg fuzzing -Ccodegen-units=1 -Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
                        -Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
                        -Cllvm-args=-sanitizer-coverage-trace-compares";

/// The longest input in bytes, the most seconds and the most megabytes for one.
const LIMITS: [&str; 3] = ["-max_len=4096", "-timeout=10", "-rss_limit_mb=2048"];

/// What is fuzzed, and for how long.
#[derive(Debug, PartialEq)]
pub(crate) struct Fuzz {
    seconds: u32,
    /// All of them where none is named.
    targets: Vec<String>,
}

impl Fuzz {
    /// Reads `SECONDS [TARGET]...`.
    pub(crate) fn parse(words: &[&str]) -> Result<Self, String> {
        let (seconds, targets) = words
            .split_first()
            .ok_or("found `fuzz` without seconds, expected `fuzz SECONDS`")?;
        let number = seconds.parse().ok().filter(|seconds| *seconds > 0);
        Ok(Self {
            seconds: number.ok_or_else(|| format!("found `{seconds}`, expected the seconds for each target"))?,
            targets: targets.iter().map(|&name| name.to_owned()).collect(),
        })
    }
}

/// What came of one target.
struct Figures {
    target: String,
    executions: u64,
    /// Inputs in its corpus.
    inputs: usize,
    held: bool,
}

/// Builds the fuzzer and hands it one target after the other; fails at the end where a law was broken.
pub(crate) fn search(workspace: &Workspace, request: &Fuzz) -> Result<(), XtaskError> {
    let folder = workspace.root.join("fuzz");
    let known = names(&folder.join("seeds"))?;
    if let Some(strange) = request.targets.iter().find(|name| !known.contains(name)) {
        return Err(XtaskError::UnknownTarget {
            found: strange.clone(),
            known: known.join(", "),
        });
    }
    let program = build(workspace, &folder)?;
    let mut figures = Vec::new();
    for target in known {
        if request.targets.is_empty() || request.targets.contains(&target) {
            figures.push(fuzz(&program, &folder, target, request.seconds)?);
        }
    }
    println!("\n{:<14} {:>14} {:>10}  laws", "target", "executions", "inputs");
    for one in &figures {
        let laws = if one.held { "held" } else { "BROKEN, see fuzz/artifacts" };
        println!("{:<14} {:>14} {:>10}  {laws}", one.target, one.executions, one.inputs);
    }
    let total: u64 = figures.iter().map(|one| one.executions).sum();
    println!("{:<14} {total:>14}", "together");
    let broken: Vec<&str> = figures
        .iter()
        .filter(|one| !one.held)
        .map(|one| one.target.as_str())
        .collect();
    if broken.is_empty() {
        return Ok(());
    }
    Err(XtaskError::LawBroken {
        targets: broken.join(", "),
    })
}

/// The fuzzer, by the nightly compiler.
fn build(workspace: &Workspace, folder: &Path) -> Result<PathBuf, XtaskError> {
    let target_folder = workspace.root.join("target/fuzz");
    let mut command = nightly_cargo();
    command
        .args(["build", "--release", "--target", MACHINE, "--target-dir"])
        .arg(&target_folder)
        .current_dir(folder.join("targets"))
        .env("RUSTFLAGS", COVERAGE);
    run(command)?;
    Ok(target_folder.join(MACHINE).join("release/fuzz"))
}

fn fuzz(program: &Path, folder: &Path, target: String, seconds: u32) -> Result<Figures, XtaskError> {
    let corpus = folder.join("corpus").join(&target);
    let artifacts = folder.join("artifacts").join(&target);
    for needed in [&corpus, &artifacts] {
        fs::create_dir_all(needed).map_err(|source| XtaskError::File {
            path: needed.clone(),
            source,
        })?;
    }
    let mut command = Command::new(program);
    command
        .env("DRIFTWORLD_FUZZ_TARGET", &target)
        .args(LIMITS)
        .args(["-print_final_stats=1", "-reload=0"])
        .arg(format!("-max_total_time={seconds}"))
        .arg(format!("-artifact_prefix={}/", artifacts.display()));
    let dictionary = folder.join("dictionaries").join(format!("{target}.txt"));
    if dictionary.exists() {
        command.arg(format!("-dict={}", dictionary.display()));
    }
    command.arg(&corpus).arg(folder.join("seeds").join(&target));
    println!("$ {}", shown(&command));
    let done = command
        .stdout(Stdio::inherit())
        .output()
        .map_err(|source| not_started(&command, source))?;
    let said = String::from_utf8_lossy(&done.stderr);
    let held = done.status.success();
    if !held {
        println!("{said}");
    }
    Ok(Figures {
        executions: executions(&said),
        inputs: names(&corpus)?.len(),
        held,
        target,
    })
}

/// How many inputs were tried, as libFuzzer says at its end, or last said where it was stopped.
fn executions(said: &str) -> u64 {
    let number = |text: &str| text.trim().parse().ok();
    let at_end = |line: &str| number(line.strip_prefix("stat::number_of_executed_units:")?);
    let meanwhile = |line: &str| number(line.strip_prefix('#')?.split_whitespace().next()?);
    let last = said.lines().rev().find_map(meanwhile).unwrap_or(0);
    said.lines().find_map(at_end).unwrap_or(last)
}

/// The names in a folder, sorted.
fn names(folder: &Path) -> Result<Vec<String>, XtaskError> {
    let entries = fs::read_dir(folder).map_err(|source| XtaskError::File {
        path: folder.to_owned(),
        source,
    })?;
    let mut names: Vec<String> = entries
        .flatten()
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .collect();
    names.sort();
    Ok(names)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_come_before_targets() {
        let wanted = |seconds, targets: &[&str]| {
            Ok(Fuzz {
                seconds,
                targets: targets.iter().map(ToString::to_string).collect(),
            })
        };
        assert_eq!(Fuzz::parse(&["60"]), wanted(60, &[]));
        assert_eq!(Fuzz::parse(&["1", "task", "log"]), wanted(1, &["task", "log"]));
        assert!(Fuzz::parse(&[]).is_err());
        assert!(Fuzz::parse(&["0"]).is_err());
        assert!(Fuzz::parse(&["task"]).is_err_and(|error| error.contains("`task`")));
    }

    #[test]
    fn executions_are_read_off_the_end_or_off_the_last_line() {
        let said = "#2\tINITED cov: 5\n#1024\tpulse  cov: 7\nDone 1500 runs\nstat::number_of_executed_units: 1500\n";
        assert_eq!(executions(said), 1500);
        assert_eq!(
            executions("#2\tINITED\n#77\tNEW\n==1== ERROR: libFuzzer: deadly signal\n"),
            77
        );
        assert_eq!(executions(""), 0);
    }
}
