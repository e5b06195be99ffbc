//! Where results go: standard output, or files that appear whole or not at all. What they say is the commands' own;
//! what a terminal would obey or hide in it is shown here, so that no command can forget it.

use std::io::{IsTerminal, Write};
use std::path::Path;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use driftworld_atomic_files::AtomicFile;
use driftworld_text::{ShownPath, printable_json, printable_lines};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use super::{Answer, Failure, overwrite};

/// What is said while somebody wants it handed back. Not a thing of one thread: subcommands work with many.
static KEPT: Mutex<Option<Answer>> = Mutex::new(None);

/// Does something, and hands back what was said meanwhile instead of showing it.
pub(super) fn kept<T>(work: impl FnOnce() -> T) -> (T, Answer) {
    /// Shows again what is said, also after a panic.
    struct Showing;
    impl Drop for Showing {
        fn drop(&mut self) {
            answer().take();
        }
    }
    let showing = Showing;
    *answer() = Some(Answer::default());
    let done = work();
    let said = answer().take().unwrap_or_default();
    drop(showing);
    (done, said)
}

fn answer() -> MutexGuard<'static, Option<Answer>> {
    // Whoever panics with the lock has changed nothing by halves.
    KEPT.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Adds to what is handed back; false if nobody wants it.
fn keep(add: impl FnOnce(&mut Answer)) -> bool {
    answer().as_mut().map(add).is_some()
}

/// Prints a line, or ends quietly if the reader has gone.
pub(crate) fn line(text: impl AsRef<str>) -> Result<(), Failure> {
    print(&format!("{}\n", text.as_ref()))
}

/// Prints text, in which unprintable characters are shown.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    print_as_is(&printable_lines(text))
}

/// Prints a document in JSON, in which unprintable characters are escaped as JSON has it.
pub(crate) fn print_json(json: &str) -> Result<(), Failure> {
    print_as_is(&printable_json(json))
}

/// Prints data for another program: to a terminal as [`print`], else as it is.
pub(crate) fn print_data(text: &str) -> Result<(), Failure> {
    if std::io::stdout().is_terminal() {
        return print(text);
    }
    print_as_is(text)
}

/// Prints text as it is: of our own making, with colours.
pub(crate) fn print_as_is(text: &str) -> Result<(), Failure> {
    if keep(|answer| answer.output.push_str(text)) {
        return Ok(());
    }
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => Ok(()),
        // As with `| head`: whoever read us has seen enough.
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe =>
        {
            #[expect(
                clippy::exit,
                reason = "the reader of our output has gone: there is nobody left to tell"
            )]
            std::process::exit(0)
        }
        Err(error) => Err(Failure::input(format!("standard output: {error}"))),
    }
}

/// Prints a value as indented JSON.
pub(crate) fn json(value: &impl Serialize) -> Result<(), Failure> {
    print_json(&(serde_json::to_string_pretty(value)? + "\n"))
}

/// Says something on standard error that is not a result.
pub(crate) fn note(text: impl AsRef<str>) {
    if keep(|answer| answer.notes.push(printable_lines(text.as_ref()).into_owned())) {
        return;
    }
    to_standard_error(text.as_ref());
}

/// A line on standard error, in which unprintable characters are shown. Where its reader has gone, there is nobody to
/// tell, and the work goes on.
pub(super) fn to_standard_error(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{}", printable_lines(text));
}

/// Says on standard error what is odd.
pub(crate) fn warning(text: impl AsRef<str>) {
    note(format!("warning: {}", text.as_ref()));
}

/// Begins a file that is there whole or not at all; a device or a pipe is written straight. None that a log is made of
/// is written over.
pub(crate) fn create(path: &Path) -> Result<AtomicFile, Failure> {
    if path == Path::new("-") {
        let advice = "expected the path of a file; give /dev/stdout for standard output";
        return Err(Failure::usage(format!("found - as the file to write, {advice}")));
    }
    overwrite::refuse_log_files(path)?;
    AtomicFile::create(path).map_err(|error| unwritable(path, &error))
}

/// Writes a file as [`create`] begins it.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let mut file = create(path)?;
    let written = file.write_all(bytes).and_then(|()| file.commit());
    written.map_err(|error| unwritable(path, &error))
}

/// Why a file cannot be written.
pub(crate) fn unwritable(path: &Path, error: &dyn std::fmt::Display) -> Failure {
    Failure::input(format!("{}: cannot be written: {error}", path.shown()))
}

/// Whether a path stands for standard output: `-`, or a name that the system has for it.
pub(crate) fn is_stdout(path: &Path) -> bool {
    path == Path::new("-") || driftworld_atomic_files::is_own_stdout(path)
}

/// A document in JSON to a file, or to standard output for `-`.
pub(crate) fn write_or_print(path: &Path, json: &str) -> Result<(), Failure> {
    if is_stdout(path) {
        print_json(json)
    } else {
        write(path, json.as_bytes())
    }
}

/// A bar on a terminal, nothing elsewhere.
pub(crate) fn progress(steps: u64, what: &'static str) -> ProgressBar {
    if !std::io::stderr().is_terminal() || keep(|_| ()) {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{prefix:<12} {bar:40} {pos}/{len} {eta} {msg}")
        .expect("the template is a constant that indicatif accepts");
    let bar = ProgressBar::new(steps).with_style(style).with_prefix(what);
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
