//! Told to stop, wherever a command is: it ends within two seconds, says so, and leaves nothing half written.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use super::figures::Figures;
use super::options::Options;
use super::subject::{Subject, all_files, end, file_error};
use crate::error::XtaskError;
use crate::process::{not_started, works};
use crate::workspace::Workspace;

/// How long it may take.
const LIMIT: Duration = Duration::from_secs(2);

/// A command that goes on for long, in words, and whether somebody reads what it prints.
struct Case {
    what: &'static str,
    arguments: &'static [&'static str],
    /// Before the signal comes.
    wait_millis: u64,
    /// Its output is a pipe that nobody reads, which fills.
    is_blocked: bool,
}

const CASES: [Case; 7] = [
    Case {
        what: "run",
        arguments: &["run", "long.json", "--agent", "random", "--output", "out/log"],
        wait_millis: 300,
        is_blocked: false,
    },
    Case {
        what: "run, in a step of seconds",
        arguments: &["run", "heap.json", "--agent", "random", "--output", "out/log"],
        wait_millis: 1500,
        is_blocked: false,
    },
    Case {
        what: "sample into a file",
        arguments: &[
            "sample",
            "find_objects",
            "--count",
            "100000000",
            "--jsonl",
            "-o",
            "out/worlds.jsonl",
        ],
        wait_millis: 300,
        is_blocked: false,
    },
    Case {
        what: "sample into a table",
        arguments: &[
            "sample",
            "find_objects",
            "--count",
            "100000000",
            "-o",
            "out/worlds.parquet",
        ],
        wait_millis: 300,
        is_blocked: false,
    },
    Case {
        what: "sample into a pipe that nobody reads",
        arguments: &["sample", "find_objects", "--count", "100000000", "--jsonl", "-o", "-"],
        wait_millis: 500,
        is_blocked: true,
    },
    Case {
        what: "sample into a pipe that nobody opens",
        arguments: &["sample", "find_objects", "--count", "10", "--jsonl", "-o", "pipe"],
        wait_millis: 300,
        is_blocked: false,
    },
    Case {
        what: "bench similarity",
        arguments: &["bench", "similarity"],
        wait_millis: 500,
        is_blocked: false,
    },
];

pub(super) fn figures(workspace: &Workspace, subject: &Subject, options: &Options) -> Result<Figures, XtaskError> {
    let mut figures = Figures::default();
    prepare(subject)?;
    let mut longest = Duration::ZERO;
    // Under nohup the command passes hanging up over, as it should.
    let signals = if passes_hanging_up_over() {
        figures.notes.push("started under nohup, without SIGHUP".to_owned());
        &["-INT", "-TERM"][..]
    } else {
        &["-INT", "-TERM", "-HUP"]
    };
    for case in &CASES {
        for signal in signals {
            for _ in 0..options.scaled(5) {
                longest = longest.max(case.figures(subject, signal, &mut figures)?);
            }
        }
        println!("{}: longest so far {:.2} s", case.what, longest.as_secs_f64());
    }
    let stand_in = workspace.target.join("debug").join("driftworld-unity");
    longest = longest.max(stopped_stand_in(&stand_in, subject, &mut figures)?);
    figures
        .notes
        .push(format!("the longest took {:.2} s to end", longest.as_secs_f64()));
    Ok(figures)
}

impl Case {
    /// How long it took to end.
    fn figures(&self, subject: &Subject, signal: &str, figures: &mut Figures) -> Result<Duration, XtaskError> {
        let out = subject.fresh("out")?;
        fs::create_dir(&out).map_err(|source| file_error(&out, source))?;
        let mut command = subject.command(self.arguments);
        let stdout = if self.is_blocked { Stdio::piped() } else { Stdio::null() };
        command.stdin(Stdio::null()).stdout(stdout).stderr(Stdio::piped());
        let mut child = command.spawn().map_err(|source| not_started(&command, source))?;
        // Held open, and never read.
        let unread = child.stdout.take();
        thread::sleep(Duration::from_millis(self.wait_millis));
        figures.tries += 1;
        let what = format!("{}, {signal}", self.what);
        if child.try_wait().is_ok_and(|status| status.is_some()) {
            let ended = end(child, Instant::now());
            figures.failed(format!("{what}: it was over before: {}", ended.shown()));
            return Ok(Duration::ZERO);
        }
        send(signal, child.id());
        figures.faults += 1;
        let ended = end(child, Instant::now());
        drop(unread);
        // By the signal where nobody could say more, else with an error and the exit code that a shell makes of the signal.
        let is_by_signal = ended.status.code().is_none() && ended.said.is_empty();
        let is_with_words = ended.status.code() == Some(exit_code(signal)) && ended.said.contains("error: ");
        let is_orderly = !ended.hung && !ended.said.contains("panicked") && (is_by_signal || is_with_words);
        if ended.took > LIMIT || !is_orderly {
            figures.failed(format!("{what}: {:.2} s, {}", ended.took.as_secs_f64(), ended.shown()));
        }
        if let Some(name) = all_files(&out).keys().find(|name| name.ends_with(".driftworld-part")) {
            figures.failed(format!("{what}: {name} is left"));
        }
        Ok(ended.took)
    }
}

/// What a shell sees of a program that this signal ends.
fn exit_code(signal: &str) -> i32 {
    match signal {
        "-HUP" => 129,
        "-TERM" => 143,
        _ => 130,
    }
}

/// The executable in place of Unity's, while it looks for a client.
fn stopped_stand_in(stand_in: &Path, subject: &Subject, figures: &mut Figures) -> Result<Duration, XtaskError> {
    let mut longest = Duration::ZERO;
    for signal in ["-INT", "-TERM"] {
        let mut command = Command::new(stand_in);
        command
            .args(["--mlagents-port", "1"])
            .current_dir(&subject.folder)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::piped());
        let child = command.spawn().map_err(|source| not_started(&command, source))?;
        thread::sleep(Duration::from_millis(300));
        send(signal, child.id());
        let ended = end(child, Instant::now());
        figures.tries += 1;
        figures.faults += 1;
        if ended.took > LIMIT || ended.hung {
            figures.failed(format!("driftworld-unity, {signal}: {}", ended.shown()));
        }
        longest = longest.max(ended.took);
    }
    Ok(longest)
}

/// Whether hanging up is passed over here, and so by what is started from here.
fn passes_hanging_up_over() -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let ignored = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    ignored.is_some_and(|mask| mask & 1 != 0)
}

pub(super) fn send(signal: &str, process: u32) {
    let mut kill = Command::new("kill");
    kill.args([signal, &process.to_string()]);
    works(kill);
}

/// Lifetimes of long experiences: of many steps, and of steps that take seconds, among cubes that are all pushed at
/// once.
fn prepare(subject: &Subject) -> Result<(), XtaskError> {
    let cube = r#"{ "class": "cube", "coordinates": [0.3, 0.8], "pushable": { "mass": 1 } }"#;
    let heap = format!(r#"{{ "max_steps": 100000, "objects": [{}] }}"#, [cube; 1000].join(", "));
    let scenario = |regime: &str| {
        format!(
            r#"{{ "name": "long", "blocks": [{{ "type": "learning", "regimes": [{{ {regime}, "count": 500 }}] }}] }}"#
        )
    };
    let texts = [
        ("heap_world.json", heap),
        (
            "heap.json",
            scenario(r#""task": "heap", "variant": "a", "world": "heap_world.json""#),
        ),
        (
            "long.json",
            scenario(r#""task": "find_objects", "variant": "red", "max_steps": 1000000"#),
        ),
    ];
    for (name, text) in texts {
        let path = subject.folder.join(name);
        fs::write(&path, text).map_err(|source| file_error(&path, source))?;
    }
    let mut pipe = Command::new("mkfifo");
    pipe.arg(subject.fresh("pipe")?);
    works(pipe);
    Ok(())
}
