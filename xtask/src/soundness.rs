//! `cargo xtask soundness`: tests under tools that see what `unsafe` code and foreign code do to memory. Which tests,
//! within how much time, and what is left out and why is the table below; what it found is in `docs/unsafe.md`.

use std::process::Command;
use std::time::{Duration, Instant};

use crate::error::XtaskError;
use crate::process::{nightly_cargo, not_started, shown, works};
use crate::workspace::Workspace;

/// A tool that watches a program run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tool {
    /// Miri: an interpreter that knows Rust's rules for memory.
    Miri,
    /// `AddressSanitizer`: reads and writes outside of what was allocated, in C++, too.
    Address,
    /// `ThreadSanitizer`: two threads at one place without an order between them.
    Threads,
}

/// One run of a tool: the arguments of `cargo test` behind `-p`, and behind them the tests.
struct Run {
    package: &'static str,
    arguments: &'static [&'static str],
    tests: &'static [&'static str],
    limit: Duration,
}

const fn run(
    package: &'static str,
    arguments: &'static [&'static str],
    tests: &'static [&'static str],
    minutes: u64,
) -> Run {
    let limit = Duration::from_secs(60 * minutes);
    Run {
        package,
        arguments,
        tests,
        limit,
    }
}

impl Tool {
    pub(crate) const ALL: [Self; 3] = [Self::Miri, Self::Address, Self::Threads];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Miri => "miri",
            Self::Address => "address",
            Self::Threads => "threads",
        }
    }

    pub(crate) fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|tool| tool.name() == name)
    }

    fn runs(self) -> Vec<Run> {
        match self {
            Self::Miri => vec![
                run("driftworld-env", &["--lib"], &["render::lanes", "batch::depth"], 20),
                run(
                    "driftworld-env",
                    &["--lib"],
                    &["agents::grid", "agents::script::", "assets::blocks"],
                    20,
                ),
                run("driftworld-similarity", &["--lib"], &["color::rows"], 10),
            ],
            Self::Address => vec![
                run("driftworld-env", &["--features", "gltf", "--lib"], &["assets"], 20),
                run("driftworld-env", &["--features", "gltf", "--test", "import"], &[], 10),
                run("driftworld-env", &["--features", "gltf", "--test", "hostile"], &[], 20),
                run("driftworld-env", &["--features", "gltf", "--test", "pictures"], &[], 10),
                run("driftworld-similarity", &["--lib"], &["color::rows"], 10),
            ],
            Self::Threads => vec![
                run("driftworld-env", &["--lib"], &["batch"], 15),
                run("driftworld-env", &["--test", "batch"], &[], 20),
            ],
        }
    }

    /// What the tool does not run, and why.
    fn left_out(self) -> &'static [&'static str] {
        match self {
            Self::Miri => &[
                "AVX-512: Miri does not know its instructions; address runs them where the processor has them",
                "laws of geometry, of libraries' bytes and of documents: safe code, and hours in an interpreter",
                "whole pictures, worlds and batches: an interpreter takes minutes for one; address and threads run them",
                "models from glTF files: Miri does not run meshopt's C++; address does",
                "the Python face: Miri does not run Python; its one view is read-only, which its tests check",
            ],
            Self::Address => &["leaks: nothing frees by hand, and the test harness itself leaks"],
            Self::Threads => &["rapier and the renderer alone: they start no threads, a batch runs them in several"],
        }
    }

    fn command(self, workspace: &Workspace, run: &Run) -> Command {
        let mut command = nightly_cargo();
        command.current_dir(&workspace.root);
        let target = workspace.target.join("soundness").join(self.name());
        command.env("CARGO_TARGET_DIR", target);
        match self {
            Self::Miri => {
                command.args(["miri", "test"]);
                command.env("MIRIFLAGS", "-Zmiri-disable-isolation");
                // What Miri takes the processor for has the instructions that it was built with.
                command.env("RUSTFLAGS", "-C target-feature=+avx2");
                command.env("PROPTEST_CASES", "2");
            }
            Self::Address => {
                command.arg("test");
                command.env("RUSTFLAGS", "-Zsanitizer=address");
                // The C++ of meshopt is watched, too; the runtime is the one that comes with Rust.
                command.env("CXXFLAGS", "-fsanitize=address -fno-omit-frame-pointer");
                // It takes two tables of meshopt's that are private to their files for one that stands twice.
                command.env("ASAN_OPTIONS", "detect_leaks=0:detect_odr_violation=0");
                command.env("PROPTEST_CASES", "64");
            }
            Self::Threads => {
                command.args(["test", "-Zbuild-std"]);
                command.env("RUSTFLAGS", "-Zsanitizer=thread -Cunsafe-allow-abi-mismatch=sanitizer");
                command.env("PROPTEST_CASES", "8");
            }
        }
        if self != Self::Miri {
            // With a target named, build scripts and macros are built without the tool.
            command.args(["--target", HOST]);
        }
        command.args(["-p", run.package]).args(run.arguments);
        command.arg("--").args(run.tests);
        command
    }
}

/// The only machine that all three tools are used on.
const HOST: &str = "x86_64-unknown-linux-gnu";

/// Runs these tools, all of them to their ends; fails if any found something.
pub(crate) fn check(workspace: &Workspace, tools: &[Tool]) -> Result<(), XtaskError> {
    let mut failed = Ok(());
    for tool in tools {
        let mut probe = nightly_cargo();
        probe.arg("--version");
        if !works(probe) {
            return Err(XtaskError::Missing {
                what: "soundness",
                reason: "no nightly toolchain; rustup toolchain install nightly --component miri --component rust-src",
            });
        }
        for run in tool.runs() {
            if let Err(error) = watch(tool.command(workspace, &run), run.limit) {
                println!("  {}: {error}", tool.name());
                failed = Err(error);
            }
        }
        for reason in tool.left_out() {
            println!("  {} leaves out {reason}", tool.name());
        }
    }
    failed
}

/// Runs a command for so long at most, and says how long it took.
fn watch(mut command: Command, limit: Duration) -> Result<(), XtaskError> {
    let line = shown(&command);
    println!("$ {line}");
    let start = Instant::now();
    let mut child = command.spawn().map_err(|source| not_started(&command, source))?;
    let failure = |source| XtaskError::NotStarted {
        command: line.clone(),
        program: "cargo".to_owned(),
        source,
    };
    loop {
        if let Some(status) = child.try_wait().map_err(failure)? {
            println!("  took {:.0} s", start.elapsed().as_secs_f64());
            return crate::process::succeeded(&line, status);
        }
        if start.elapsed() > limit {
            child.kill().map_err(failure)?;
            child.wait().map_err(failure)?;
            return Err(XtaskError::TooSlow {
                command: line,
                limit_secs: limit.as_secs(),
            });
        }
        std::thread::sleep(Duration::from_millis(200));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_tool_runs_something_and_is_known_by_its_name() {
        for tool in Tool::ALL {
            assert_eq!(Tool::from_name(tool.name()), Some(tool));
            assert!(!tool.runs().is_empty() && !tool.left_out().is_empty());
        }
        assert_eq!(Tool::from_name("valgrind"), None);
    }
}
