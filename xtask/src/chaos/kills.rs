//! A run that is killed at random moments and gone on with, until it is done: its log is that of a run that nobody
//! killed.

use std::process::Command;
use std::thread;
use std::time::{Duration, Instant};

use super::figures::Figures;
use super::rng::Rng;
use super::subject::{Files, Subject, all_files, difference, end, start, to_its_end};
use super::{Options, subject};
use crate::error::XtaskError;

/// How many experiences at a time.
const JOBS: [u64; 3] = [1, 2, 4];

/// Who lives.
const AGENTS: [&str; 2] = ["random", "onrails"];

/// Most kills in one lifetime: then it is left alone.
const MOST: u64 = 12;

pub(super) fn figures(subject: &Subject, options: &Options, rng: &mut Rng) -> Result<Figures, XtaskError> {
    let kills = options.scaled(options.kills);
    let each = kills.div_ceil((JOBS.len() * AGENTS.len()) as u64);
    let mut all = Figures::default();
    for agent in AGENTS {
        for jobs in JOBS {
            let (expected, took) = subject.undisturbed(&subject.scenario, agent, jobs)?;
            let log = subject.folder.join("killed");
            let run = || subject.run(&subject.scenario, agent, jobs, &log);
            let life = Life {
                run: &run,
                what: &format!("{agent}, {jobs} jobs"),
                log: &log,
                expected: &expected,
                took,
            };
            let figures = life.killed_again_and_again(each, rng)?;
            println!(
                "{agent}, {jobs} jobs: {} lifetimes, {} kills",
                figures.tries, figures.faults
            );
            all.add(figures);
        }
    }
    Ok(all)
}

/// A lifetime that is to be killed.
pub(super) struct Life<'a> {
    pub(super) run: &'a dyn Fn() -> Command,
    pub(super) what: &'a str,
    pub(super) log: &'a std::path::Path,
    pub(super) expected: &'a Files,
    /// How long it takes undisturbed.
    pub(super) took: Duration,
}

impl Life<'_> {
    /// Lives again and again, until so many kills were met.
    pub(super) fn killed_again_and_again(&self, kills: u64, rng: &mut Rng) -> Result<Figures, XtaskError> {
        let mut figures = Figures::default();
        while figures.faults < kills && figures.failures < 10 {
            subject::remove(self.log)?;
            figures.faults += self.killed(&mut figures.failures, rng)?;
            let last = to_its_end(&mut (self.run)())?;
            if !last.is_well() {
                figures.failed(format!("{}, taken up: {}", self.what, last.shown()));
            }
            figures.compared(difference(&all_files(self.log), self.expected), self.what);
        }
        Ok(figures)
    }

    /// Lives until it is done or was killed often enough; returns how often. What goes wrong is counted.
    pub(super) fn killed(&self, failures: &mut u64, rng: &mut Rng) -> Result<u64, XtaskError> {
        // From moments after the start to the whole of a lifetime: some lifetimes are killed often, some late.
        let reach = self.took.mul_f64(0.2 + 0.9 * rng.share());
        for kills in 0..MOST {
            let began = Instant::now();
            let mut child = start(&mut (self.run)())?;
            thread::sleep(reach.mul_f64(rng.share()));
            // Whoever has ended by now was not killed.
            let is_over = child.try_wait().is_ok_and(|status| status.is_some());
            if !is_over {
                let _ = child.kill();
            }
            let ended = end(child, began);
            if ended.said.contains("panicked") || (is_over && !ended.is_well()) {
                *failures += 1;
                println!("FAILED: {}: {}", self.what, ended.shown());
            }
            if is_over {
                return Ok(kills);
            }
        }
        Ok(MOST)
    }
}
