//! Runs that are killed whose agents are Python's: one that learns, and is saved beside the log. The script is in
//! `agent.py`.

use std::env;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

use super::figures::Figures;
use super::kills::Life;
use super::rng::Rng;
use super::subject::{Subject, all_files, file_error, to_its_end};
use super::{Options, subject};
use crate::error::XtaskError;
use crate::process::works;
use crate::workspace::Workspace;

const SCRIPT: &str = include_str!("agent.py");

/// Of so many kills of Rust's agents one is of Python's: it takes a second to start.
const SHARE: u64 = 10;

pub(super) fn figures(
    workspace: &Workspace,
    subject: &Subject,
    options: &Options,
    rng: &mut Rng,
) -> Result<Figures, XtaskError> {
    let Some(python) = python(workspace) else {
        return Ok(Figures::skipped(
            "no Python with driftworld and gymnasium; name one in DRIFTWORLD_PYTHON, and build the module as CONTRIBUTING.md says",
        ));
    };
    let script = subject.folder.join("agent.py");
    fs::write(&script, SCRIPT).map_err(|source| file_error(&script, source))?;
    let log = subject.folder.join("killed");
    let saves = subject.folder.join("killed.agent");
    let run = || {
        let mut run = command(workspace, &python);
        run.arg(&script)
            .arg(&subject.scenario)
            .arg(&log)
            .current_dir(&subject.folder)
            .env("DRIFTWORLD_CLOCK", "2026-01-01T00:00:00Z");
        run
    };
    let (mut expected, mut took) = (subject::Files::new(), Duration::ZERO);
    for _ in 0..2 {
        subject::remove(&log)?;
        subject::remove(&saves)?;
        let ended = to_its_end(&mut run())?;
        if !ended.is_well() {
            let mut figures = Figures::default();
            figures.failed(format!("undisturbed: {}", ended.shown()));
            return Ok(figures);
        }
        took = took.max(ended.took);
        expected = all_files(&log);
    }
    let life = Life {
        run: &run,
        what: "an agent in Python",
        log: &log,
        expected: &expected,
        took,
    };
    let figures = life.killed_again_and_again(options.scaled(options.kills / SHARE), rng)?;
    println!("{} lifetimes, {} kills", figures.tries, figures.faults);
    Ok(figures)
}

/// An interpreter that finds the package, where it was built or where it was installed.
fn python(workspace: &Workspace) -> Option<PathBuf> {
    let named = env::var_os("DRIFTWORLD_PYTHON").map(PathBuf::from);
    let installed = ["newest", "newcomer"].map(|name| workspace.target.join("python").join(name).join("bin/python"));
    named
        .into_iter()
        .chain([PathBuf::from("python3")])
        .chain(installed)
        .find(|python| {
            let mut probe = command(workspace, python);
            probe.args(["-c", "import driftworld, gymnasium; driftworld.Curriculum"]);
            works(probe)
        })
}

/// The interpreter, which finds the module in the checkout if it was built there.
fn command(workspace: &Workspace, python: &std::path::Path) -> Command {
    let mut command = Command::new(python);
    let package = workspace.root.join("python/package");
    if fs::read_dir(package.join("driftworld")).is_ok_and(|entries| {
        entries
            .flatten()
            .any(|entry| entry.file_name().to_string_lossy().starts_with("_native.abi3"))
    }) {
        command.env("PYTHONPATH", package);
    }
    command
}
