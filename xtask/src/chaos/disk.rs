//! A disk that has room for so many bytes and no more: an error says so, nothing half written stays, what was there
//! before stays as it was, and the same command with room again gives what it would have given.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::figures::Figures;
use super::rng::Rng;
use super::subject::{Files, Subject, all_files, difference, file_error, num_bytes, to_its_end};
use super::{Options, shim};
use crate::error::XtaskError;
use crate::workspace::Workspace;

/// How many sizes of disk for each command.
const TRIES: u64 = 40;

/// Commands that write below the folder `out`, and what they are called in a message.
const COMMANDS: [&str; 12] = [
    "sample find_objects#red --count 60 --jsonl -o out/worlds.jsonl",
    "sample find_objects#red --count 20 -o out/worlds",
    "sample find_objects#red --count 60 -o out/worlds.parquet",
    "sample find_objects#red -o out/world.json",
    "order find_objects --matrix out/matrix.npy",
    "curriculum find_objects#red find_objects#blue -o out/scenario.json",
    "sheet find_objects#red --size 32 -o out/sheet.png",
    "assets pack MODEL -o out/town.assets",
    "logs aggregate log -o out/rows.tsv",
    "logs aggregate log -o out/rows.parquet",
    "metrics log --output-dir out --output scores",
    "report log -o out/page.html",
];

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
    let disk = Disk {
        subject,
        library: &library,
        tries: options.scaled(TRIES),
    };
    let mut figures = disk.runs(rng)?;
    let log = subject.fresh("log")?;
    to_its_end(&mut subject.run(&subject.scenario, "random", 2, &log))?;
    let model = workspace.root.join("examples/assets/lighthouse.gltf");
    for line in COMMANDS {
        let arguments: Vec<String> = line
            .split(' ')
            .map(|word| word.replace("MODEL", &model.display().to_string()))
            .collect();
        figures.add(disk.command(line, &arguments, rng)?);
    }
    Ok(figures)
}

struct Disk<'a> {
    subject: &'a Subject,
    library: &'a Path,
    tries: u64,
}

impl Disk<'_> {
    fn with_room(&self, mut command: Command, bytes: u64) -> Command {
        command
            .env("LD_PRELOAD", self.library)
            .env("CHAOS_DISK", bytes.to_string());
        command
    }

    /// Lifetimes that find no more room, twice, and go on.
    fn runs(&self, rng: &mut Rng) -> Result<Figures, XtaskError> {
        let (subject, mut figures) = (self.subject, Figures::default());
        let (expected, _) = subject.undisturbed(&subject.scenario, "random", 2)?;
        let total = num_bytes(&expected);
        for _ in 0..self.tries {
            let log = subject.fresh("full")?;
            let run = || subject.run(&subject.scenario, "random", 2, &log);
            for _ in 0..2 {
                let ended = to_its_end(&mut self.with_room(run(), rng.below(total)))?;
                if ended.is_well() {
                    continue;
                }
                figures.faults += 1;
                if !ended.is_orderly() || !ended.said.contains("No space left") {
                    figures.failed(format!("run: {}", ended.shown()));
                }
                let halves = all_files(&log);
                let torn = halves
                    .iter()
                    .find(|(name, bytes)| name.ends_with("tsv") && bytes.last().is_some_and(|last| *last != b'\n'));
                if let Some((name, _)) = torn {
                    figures.failed(format!("run: half a row stays in {name}"));
                }
            }
            let last = to_its_end(&mut run())?;
            if !last.is_well() {
                figures.failed(format!("run, with room again: {}", last.shown()));
            }
            figures.compared(difference(&all_files(&log), &expected), "run");
        }
        println!("run: {} tries, {} full disks", figures.tries, figures.faults);
        Ok(figures)
    }

    /// A command in an empty folder, and in one where its files are already, of other content.
    fn command(&self, line: &str, arguments: &[String], rng: &mut Rng) -> Result<Figures, XtaskError> {
        let (subject, mut figures) = (self.subject, Figures::default());
        let out = subject.folder.join("out");
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let command = || subject.command(&arguments);
        subject.fresh("out")?;
        let ended = to_its_end(&mut command())?;
        if !ended.is_well() {
            figures.failed(format!("{line}: {}", ended.shown()));
            return Ok(figures);
        }
        let expected = all_files(&out);
        let total = num_bytes(&expected);
        for _ in 0..self.tries {
            subject.fresh("out")?;
            let before = if rng.below(2) == 0 {
                Files::new()
            } else {
                older(&out, &expected)?
            };
            let ended = to_its_end(&mut self.with_room(command(), rng.below(total)))?;
            figures.faults += 1;
            let said_so = ended.said.contains("No space left") || ended.said.contains("disk full");
            if ended.status.code() != Some(1) || !ended.is_orderly() || !said_so {
                figures.failed(format!("{line}: {}", ended.shown()));
            }
            for (name, bytes) in all_files(&out) {
                let is_whole = expected.get(&name) == Some(&bytes) || before.get(&name) == Some(&bytes);
                if !is_whole {
                    figures.failed(format!("{line}: {name} is half written"));
                }
            }
            if let Some(name) = before.keys().find(|name| !out.join(name).exists()) {
                figures.failed(format!("{line}: {name}, which was there before, is gone"));
            }
            let again = to_its_end(&mut command())?;
            if !again.is_well() {
                figures.failed(format!("{line}, with room again: {}", again.shown()));
            }
            figures.compared(difference(&all_files(&out), &expected), line);
        }
        println!("{line}: {} tries", figures.tries);
        Ok(figures)
    }
}

/// Files of the same names and of other content.
fn older(out: &Path, names: &Files) -> Result<Files, XtaskError> {
    // Libraries of models are written over by libraries only.
    for name in names.keys().filter(|name| !name.ends_with(".assets")) {
        let path = out.join(name);
        let folder = path.parent().unwrap_or(out);
        fs::create_dir_all(folder)
            .and_then(|()| fs::write(&path, "older"))
            .map_err(|source| file_error(&path, source))?;
    }
    Ok(all_files(out))
}
