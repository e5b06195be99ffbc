//! The stage `tests`: runs cargo-nextest if installed, otherwise `cargo test`. Doc tests are a separate stage, because nextest
//! cannot run them.

use std::io::{self, BufRead, BufReader};
use std::process::{Command, Stdio};

use crate::process::{Result, Workspace, ended, run, works};
use crate::stage::Outcome;

/// Runs the workspace's tests; the outcome's note is the runner's summary.
pub(crate) fn stage(workspace: &Workspace) -> Result<Outcome> {
    let mut command = if works(workspace.cargo(&["nextest", "--version"])) {
        workspace.cargo_everywhere(&["nextest", "run"])
    } else {
        println!("cargo-nextest is not installed (cargo install cargo-nextest --locked): using cargo test");
        workspace.cargo_everywhere(&["test", "--lib", "--bins", "--tests"])
    };
    if workspace.is_full {
        // Commands on documentation pages run with the release build, which most readers use.
        run(workspace.cargo(&["build", "--release"]))?;
        let built = workspace.target.join("release/driftworld");
        command.env("DRIFTWORLD_FULL", "1").env("DRIFTWORLD_COMMAND", built);
    }
    relay(command).map(|closing| Outcome::Passed(summary(&closing)))
}

/// Runs the command, passes its output on line by line, and returns the closing lines of test runs: nextest's `Summary` line, or
/// one `test result` line per program.
fn relay(mut command: Command) -> Result<Vec<String>> {
    let (reader, writer) = io::pipe().map_err(|error| error.to_string())?;
    let other = writer.try_clone().map_err(|error| error.to_string())?;
    command.stdout(writer).stderr(other);
    let child = command.spawn();
    // Closes our write ends of the pipe, so that reading ends when the child exits.
    command.stdout(Stdio::inherit()).stderr(Stdio::inherit());
    let mut closing = Vec::new();
    for line in BufReader::new(reader).split(b'\n').map_while(std::result::Result::ok) {
        let line = String::from_utf8_lossy(&line).into_owned();
        println!("{line}");
        let line = line.trim_start();
        if line.starts_with("Summary [") || line.starts_with("test result: ") {
            closing.push(line.to_owned());
        }
    }
    ended(&command, child.and_then(|mut child| child.wait())).map(|()| closing)
}

/// nextest's own line, or the totals of all `cargo test` lines.
fn summary(closing: &[String]) -> String {
    if let Some(line) = closing.iter().find(|line| line.starts_with("Summary")) {
        return line.clone();
    }
    let count = |word: &str| -> u64 {
        let before = closing
            .iter()
            .filter_map(|line| line.split_once(word)?.0.rsplit(' ').next());
        before.filter_map(|number| number.parse::<u64>().ok()).sum()
    };
    let (passed, ignored) = (count(" passed"), count(" ignored"));
    format!(
        "{passed} tests passed, {ignored} ignored, in {} test programs",
        closing.len()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closing_lines_are_found_and_added_up() {
        let check = |script: &str, expected: &str| {
            let mut shell = Command::new("sh");
            shell.args(["-c", script]);
            assert_eq!(relay(shell).map(|closing| summary(&closing)), Ok(expected.to_owned()));
        };
        check(
            "echo '     Summary [ 0.1s] 2 tests run' >&2; echo done",
            "Summary [ 0.1s] 2 tests run",
        );
        check(
            "echo 'test result: ok. 3 passed; 0 failed; 1 ignored'; echo 'test result: ok. 40 passed; 0 failed; 0 ignored'",
            "43 tests passed, 1 ignored, in 2 test programs",
        );
        let mut shell = Command::new("sh");
        shell.args(["-c", "exit 3"]);
        assert!(relay(shell).is_err());
    }
}
