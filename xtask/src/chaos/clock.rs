//! A clock that jumps back and forth by years while a run goes on and is killed: the rows are the same, but for their
//! stamps.

use super::figures::Figures;
use super::kills::Life;
use super::rng::Rng;
use super::subject::{Files, Subject, all_files, difference, to_its_end};
use super::{Options, shim, subject};
use crate::error::XtaskError;
use crate::workspace::Workspace;

/// How many lifetimes.
const TRIES: u64 = 60;

pub(super) fn figures(
    workspace: &Workspace,
    subject: &Subject,
    options: &Options,
    rng: &mut Rng,
) -> Result<Figures, XtaskError> {
    let library = match shim::built(workspace, subject) {
        Ok(library) => library,
        Err(reason) => return Ok(Figures::skipped(reason)),
    };
    let mut figures = Figures::default();
    for jobs in [1, 4] {
        let (expected, took) = subject.undisturbed(&subject.scenario, "random", jobs)?;
        let expected = timeless(&expected);
        for _ in 0..options.scaled(TRIES / 2) {
            let log = subject.fresh("jumped")?;
            let seed = rng.next().to_string();
            let run = || {
                let mut run = subject.run(&subject.scenario, "random", jobs, &log);
                run.env_remove("DRIFTWORLD_CLOCK")
                    .env("LD_PRELOAD", &library)
                    .env("CHAOS_CLOCK", &seed);
                run
            };
            let life = Life {
                run: &run,
                what: "a clock that jumps",
                log: &log,
                expected: &Files::new(),
                took,
            };
            figures.faults += life.killed(&mut figures.failures, rng)?;
            let last = to_its_end(&mut run())?;
            if !last.is_well() {
                figures.failed(format!("taken up: {}", last.shown()));
            }
            figures.compared(difference(&timeless(&all_files(&log)), &expected), "but for the stamps");
            let valid = to_its_end(subject.command(&["logs", "validate"]).arg(&log))?;
            if !valid.is_well() {
                figures.failed(format!("logs validate: {}", valid.shown()));
            }
            subject::remove(&log)?;
        }
    }
    Ok(figures)
}

/// Files of a log without the column of stamps.
fn timeless(files: &Files) -> Files {
    let stampless = |bytes: &Vec<u8>| {
        let text = String::from_utf8_lossy(bytes);
        let place = text
            .lines()
            .next()
            .and_then(|header| header.split('\t').position(|name| name == "timestamp"));
        let lines = text.lines().map(|line| {
            let cells = line.split('\t').enumerate().filter(|(index, _)| Some(*index) != place);
            cells.map(|(_, cell)| cell).collect::<Vec<_>>().join("\t") + "\n"
        });
        lines.collect::<String>().into_bytes()
    };
    files
        .iter()
        .map(|(name, bytes)| (name.clone(), stampless(bytes)))
        .collect()
}
