//! The `tests` stage: cargo-nextest where it is installed, `cargo test` elsewhere, and the runner's closing lines kept
//! for the summary. Doc tests are a stage of their own, for nextest cannot run them.

use std::io::{BufRead, BufReader, IsTerminal, Read, Write};
use std::process::{Command, Stdio};
use std::thread;

use crate::error::XtaskError;
use crate::process::AS_TESTED;
use crate::process::{cargo, not_started, shown, succeeded, works};
use crate::workspace::Workspace;

/// Runs every test of the workspace; returns the runner's closing line.
pub(crate) fn stage(workspace: &Workspace) -> Result<String, XtaskError> {
    let has_nextest = works(cargo(workspace, &["nextest", "--version"]));
    let mut command = if has_nextest {
        cargo(workspace, &[&["nextest", "run"], &AS_TESTED[..]].concat())
    } else {
        println!("cargo-nextest is not installed (cargo install cargo-nextest --locked): using cargo test");
        cargo(
            workspace,
            &[&["test", "--lib", "--bins", "--tests"], &AS_TESTED[..]].concat(),
        )
    };
    // The runner writes to a pipe, so it has to be told that a terminal reads it.
    if std::io::stderr().is_terminal() && std::env::var_os("CARGO_TERM_COLOR").is_none() {
        command.env("CARGO_TERM_COLOR", "always");
    }
    relay(command).map(|closing| summary(&closing))
}

/// Runs the command, passes on what it prints line by line, and returns its closing lines.
fn relay(mut command: Command) -> Result<Vec<String>, XtaskError> {
    let shown = shown(&command);
    println!("$ {shown}");
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(|source| not_started(&command, source))?;
    let readers = [
        child
            .stdout
            .take()
            .map(|pipe| thread::spawn(move || pass_on(pipe, std::io::stdout()))),
        child
            .stderr
            .take()
            .map(|pipe| thread::spawn(move || pass_on(pipe, std::io::stderr()))),
    ];
    let status = child.wait().map_err(|source| not_started(&command, source))?;
    let closing = readers
        .into_iter()
        .flatten()
        .flat_map(|reader| reader.join().unwrap_or_default())
        .collect();
    succeeded(&shown, status)?;
    Ok(closing)
}

/// Copies lines from one to the other and keeps those which close a test run.
fn pass_on(from: impl Read, mut to: impl Write) -> Vec<String> {
    let mut closing = Vec::new();
    for line in BufReader::new(from).split(b'\n').map_while(Result::ok) {
        let line = String::from_utf8_lossy(&line).into_owned();
        // Whoever reads us may have gone; the tests still count.
        let _ = writeln!(to, "{line}");
        if is_closing(&without_colors(&line)) {
            closing.push(without_colors(&line).trim().to_owned());
        }
    }
    closing
}

/// nextest closes once, with `Summary`; `cargo test` closes each test program, with `test result`.
fn is_closing(line: &str) -> bool {
    line.trim_start().starts_with("Summary [") || line.starts_with("test result: ")
}

/// nextest's own line, or the counts of all `cargo test` lines added up.
fn summary(closing: &[String]) -> String {
    if let Some(line) = closing.iter().find(|line| line.starts_with("Summary")) {
        return line.clone();
    }
    let count = |word: &str| -> u64 { closing.iter().filter_map(|line| count_before(line, word)).sum() };
    let programs = closing.len();
    format!(
        "{} tests passed, {} ignored, in {programs} test programs",
        count(" passed"),
        count(" ignored")
    )
}

/// The number that stands right before `word`.
fn count_before(line: &str, word: &str) -> Option<u64> {
    let (before, _) = line.split_once(word)?;
    before.rsplit(' ').next()?.parse().ok()
}

/// The line without its terminal colours (`ESC [ … m`).
fn without_colors(line: &str) -> String {
    let mut pieces = line.split('\u{1b}');
    let first = pieces.next().unwrap_or_default().to_owned();
    pieces.fold(first, |text, piece| {
        text + piece.split_once('m').map_or("", |(_, rest)| rest)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(printed: &str, expected: &str) {
        let mut copied = Vec::new();
        let closing = pass_on(printed.as_bytes(), &mut copied);
        assert_eq!(String::from_utf8(copied).unwrap(), printed, "every line is passed on");
        assert_eq!(summary(&closing), expected);
    }

    #[test]
    fn nextest_closes_with_its_own_line() {
        let line = "Summary [   0.152s] 12 tests run: 12 passed, 0 skipped";
        check(&format!("   PASS [0.1s] spec x\n     {line}\n"), line);
        check(
            "\u{1b}[32;1m     Summary\u{1b}[0m [   0.1s] \u{1b}[1m2\u{1b}[0m tests\n",
            "Summary [   0.1s] 2 tests",
        );
    }

    #[test]
    fn cargo_test_results_are_added_up() {
        let printed = "test result: ok. 3 passed; 0 failed; 1 ignored; 0 measured\n\
                       test a::b ... ok\n\
                       test result: ok. 40 passed; 0 failed; 0 ignored; 0 measured\n";
        check(printed, "43 tests passed, 1 ignored, in 2 test programs");
    }

    #[test]
    fn a_failing_runner_fails_the_stage() {
        let mut command = Command::new("sh");
        command.args(["-c", "exit 3"]);
        assert!(matches!(relay(command), Err(XtaskError::Failed { .. })));
    }
}
