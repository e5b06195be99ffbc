//! [`Subject`]: the command that faults happen to, the lifetime that it lives, and what a log of it is when nothing
//! happens.

use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use crate::error::XtaskError;
use crate::process::not_started;
use crate::workspace::Workspace;

/// The variable that stops the command's clock, and where.
const CLOCK: (&str, &str) = ("DRIFTWORLD_CLOCK", "2026-01-01T00:00:00Z");

/// Longer than anything here takes on a slow machine: what takes longer hangs.
const LIMIT: Duration = Duration::from_mins(1);

/// All files below a folder by their paths, with their bytes.
pub(super) type Files = BTreeMap<String, Vec<u8>>;

/// The command, and the folder that everything happens in.
pub(super) struct Subject {
    pub(super) command: PathBuf,
    /// Ours alone, and empty at the beginning.
    pub(super) folder: PathBuf,
    pub(super) scenario: PathBuf,
    /// A shorter lifetime.
    pub(super) short: PathBuf,
}

/// How a program ended.
pub(super) struct Ended {
    pub(super) status: ExitStatus,
    /// What it said on standard error.
    pub(super) said: String,
    pub(super) took: Duration,
    /// It went on and on, and was killed.
    pub(super) hung: bool,
}

impl Ended {
    /// Ended with exit code 1 and a message, or well, and without a panic.
    pub(super) fn is_orderly(&self) -> bool {
        let code = self.status.code();
        !self.hung
            && !self.said.contains("panicked")
            && (code == Some(0) || (code == Some(1) && self.said.contains("error: ")))
    }

    pub(super) fn is_well(&self) -> bool {
        !self.hung && self.status.success()
    }

    /// In a line.
    pub(super) fn shown(&self) -> String {
        let hung = if self.hung { ", and hung" } else { "" };
        format!("{}{hung}: {}", self.status, self.said.trim().replace('\n', " / "))
    }
}

impl Subject {
    pub(super) fn new(workspace: &Workspace, is_quick: bool) -> Result<Self, XtaskError> {
        let folder = workspace.target.join("chaos").join(std::process::id().to_string());
        fs::create_dir_all(&folder).map_err(|source| file_error(&folder, source))?;
        // A copy: what is built meanwhile is another.
        let (built, command) = (
            workspace.target.join("debug").join("driftworld"),
            folder.join("driftworld"),
        );
        fs::copy(&built, &command).map_err(|source| file_error(&built, source))?;
        let (scenario, short) = (folder.join("scenario.json"), folder.join("short.json"));
        let count = if is_quick { 10 } else { 25 };
        for (path, count, steps) in [(&scenario, count, 120), (&short, 2, 20)] {
            fs::write(path, lifetime(count, steps)).map_err(|source| file_error(path, source))?;
        }
        Ok(Self {
            command,
            folder,
            scenario,
            short,
        })
    }

    /// The command with these arguments, in the folder, with a clock that stands still.
    pub(super) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(&self.command);
        command.args(arguments).current_dir(&self.folder).env(CLOCK.0, CLOCK.1);
        command
    }

    /// A run of a lifetime that is begun, or gone on with.
    pub(super) fn run(&self, scenario: &Path, agent: &str, jobs: u64, log: &Path) -> Command {
        let mut command = self.command(&["run", "--agent", agent, "--resume", "--jobs", &jobs.to_string()]);
        command.arg(scenario).arg("--output").arg(log);
        command
    }

    /// A folder that is not there, below ours.
    pub(super) fn fresh(&self, name: &str) -> Result<PathBuf, XtaskError> {
        let path = self.folder.join(name);
        remove(&path)?;
        Ok(path)
    }

    /// What a log of a lifetime is when nothing happens, and how long that takes: the longest of three.
    pub(super) fn undisturbed(&self, scenario: &Path, agent: &str, jobs: u64) -> Result<(Files, Duration), XtaskError> {
        let (mut files, mut longest) = (Files::new(), Duration::ZERO);
        for _ in 0..3 {
            let log = self.fresh("undisturbed")?;
            let ended = to_its_end(&mut self.run(scenario, agent, jobs, &log))?;
            if !ended.is_well() {
                println!("{}", ended.shown());
                return Err(XtaskError::Missing {
                    what: "chaos",
                    reason: "the command does not live its lifetime even undisturbed",
                });
            }
            longest = longest.max(ended.took);
            files = all_files(&log);
        }
        Ok((files, longest))
    }
}

impl Drop for Subject {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.folder);
    }
}

/// A lifetime of three blocks, with so many experiences in the middle one.
fn lifetime(count: u64, steps: u64) -> String {
    let regime = |variant: &str, count: u64| {
        format!(
            r#"{{ "task": "find_objects", "variant": "{variant}", "count": {count}, "seed": 5, "max_steps": {steps} }}"#
        )
    };
    let (blue, red, learned) = (regime("blue", 4), regime("red", 4), regime("red", count));
    format!(
        r#"{{ "name": "chaos", "blocks": [
            {{ "type": "evaluation", "regimes": [{blue}, {red}] }},
            {{ "type": "learning", "regimes": [{learned}] }},
            {{ "type": "evaluation", "regimes": [{blue}, {red}] }} ] }}"#
    )
}

/// Starts a program that says nothing but errors.
pub(super) fn start(command: &mut Command) -> Result<Child, XtaskError> {
    let quiet = command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped());
    quiet.spawn().map_err(|source| not_started(command, source))
}

/// Runs a program to its end.
pub(super) fn to_its_end(command: &mut Command) -> Result<Ended, XtaskError> {
    let start_time = Instant::now();
    let child = start(command)?;
    Ok(end(child, start_time))
}

/// Waits until a program ends; one that hangs is killed.
pub(super) fn end(mut child: Child, start: Instant) -> Ended {
    let said = child.stderr.take().map(|mut pipe| {
        thread::spawn(move || {
            let mut said = Vec::new();
            let _ = pipe.read_to_end(&mut said);
            String::from_utf8_lossy(&said).into_owned()
        })
    });
    let mut hung = false;
    let status = loop {
        match child.try_wait() {
            Ok(Some(status)) => break status,
            Ok(None) if start.elapsed() > LIMIT && !hung => {
                hung = true;
                let _ = child.kill();
            }
            _ => thread::sleep(Duration::from_millis(1)),
        }
    };
    let took = start.elapsed();
    let said = said.and_then(|said| said.join().ok()).unwrap_or_default();
    Ended {
        status,
        said,
        took,
        hung,
    }
}

/// All files below a folder; none where there is no folder.
pub(super) fn all_files(folder: &Path) -> Files {
    let mut found = Files::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(next) = folders.pop() {
        for entry in fs::read_dir(next).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() {
                folders.push(path);
            } else if let (Ok(inside), Ok(bytes)) = (path.strip_prefix(folder), fs::read(&path)) {
                found.insert(inside.display().to_string(), bytes);
            }
        }
    }
    found
}

/// Where the first of two logs differs from the second, if it does.
pub(super) fn difference(found: &Files, expected: &Files) -> Option<String> {
    let name = found
        .keys()
        .chain(expected.keys())
        .find(|name| found.get(*name) != expected.get(*name))?;
    let length = |files: &Files| {
        files
            .get(name)
            .map_or("none".to_owned(), |bytes| format!("{} bytes", bytes.len()))
    };
    Some(format!(
        "{name}: found {}, expected {}",
        length(found),
        length(expected)
    ))
}

/// Bytes of all files.
pub(super) fn num_bytes(files: &Files) -> u64 {
    files.values().map(|bytes| bytes.len() as u64).sum()
}

/// Removes a file or a folder that may not be there.
pub(super) fn remove(path: &Path) -> Result<(), XtaskError> {
    let removed = fs::remove_dir_all(path).or_else(|_| fs::remove_file(path));
    match removed {
        Err(source) if path.symlink_metadata().is_ok() => Err(file_error(path, source)),
        _ => Ok(()),
    }
}

pub(super) fn file_error(path: &Path, source: std::io::Error) -> XtaskError {
    XtaskError::File {
        path: path.to_owned(),
        source,
    }
}
