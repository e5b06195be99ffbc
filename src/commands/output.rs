//! Output of commands, to standard output or to files, which are written atomically. Escapes control characters and other text
//! that a terminal would interpret or hide.

use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use driftworld_text::{ShownPath, printable_json, printable_lines};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;
use serde_json::json;

use crate::Failure;
pub(crate) use crate::output_file::{create, refuse_removed_ending, unwritable, write, write_picture};
use crate::report::picture::Drawing;
use crate::style::{self, Style};
use crate::wrap::{columns_of_stderr, columns_of_stdout, wrap_lines};

/// Whether data for a program went to standard output: then nothing else does.
static IS_DATA: AtomicBool = AtomicBool::new(false);

/// Whether the exit code is a result, which counts even if nobody reads the output.
static EXIT_CODE_IS_RESULT: AtomicBool = AtomicBool::new(false);

/// Makes the command run to its end even if the reader of its output has gone, because its exit code is a result.
pub(crate) fn run_to_end_for_exit_code() {
    EXIT_CODE_IS_RESULT.store(true, Ordering::Relaxed);
}

/// Written files that have not been reported yet, with their descriptions.
static WRITTEN: Mutex<Vec<(PathBuf, String)>> = Mutex::new(Vec::new());

fn written() -> MutexGuard<'static, Vec<(PathBuf, String)>> {
    WRITTEN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Records that a file or a folder was written; `what` is a short description, or empty. A line `wrote FILE` is printed at the
/// end of the command.
pub(crate) fn wrote(path: &Path, what: impl Into<String>) {
    // Standard output needs no report. A device is not a file, and may be another name for standard output.
    if !is_stdout(path) && !path.starts_with("/dev") {
        written().push((path.to_owned(), what.into()));
    }
}

/// Reports the written files: on standard output, or on standard error if standard output carries data.
pub(crate) fn report_written_files() -> Result<(), Failure> {
    let is_data = IS_DATA.swap(false, Ordering::Relaxed);
    EXIT_CODE_IS_RESULT.store(false, Ordering::Relaxed);
    for (path, what) in std::mem::take(&mut *written()) {
        let what = if what.is_empty() { what } else { format!(" ({what})") };
        let text = format!("wrote {}{what}", path.shown());
        if is_data {
            note(text);
        } else {
            line(text)?;
        }
    }
    Ok(())
}

/// Prints the written files as JSON if requested, for commands without another result.
pub(crate) fn json_of_what_was_written(is_asked_for: bool) -> Result<(), Failure> {
    if !is_asked_for {
        return Ok(());
    }
    let listed: Vec<_> = std::mem::take(&mut *written())
        .into_iter()
        .map(|(path, what)| json!({ "path": path, "what": what }))
        .collect();
    json(&json!({ "wrote": listed }))
}

/// Prints a line, or ends quietly if the reader has gone. Wraps lines at the terminal's width.
pub(crate) fn line(text: impl AsRef<str>) -> Result<(), Failure> {
    print(&format!("{}\n", wrap_lines(text.as_ref(), columns_of_stdout())))
}

/// Prints text with unprintable characters escaped.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    if style::of_stdout() {
        return print_as_is(&style::paint(text, |text| printable_lines(text).into_owned()));
    }
    print_as_is(&printable_lines(text))
}

/// Prints a JSON document with unprintable characters escaped as in JSON.
pub(crate) fn print_json(json: &str) -> Result<(), Failure> {
    print_as_is(&printable_json(json))
}

/// Prints data for another program: to a terminal like [`print`], else unchanged.
pub(crate) fn print_data(text: &str) -> Result<(), Failure> {
    carries_data();
    if std::io::stdout().is_terminal() {
        return print(text);
    }
    print_as_is(text)
}

/// Marks standard output as carrying data for a program.
pub(crate) fn carries_data() {
    IS_DATA.store(true, Ordering::Relaxed);
}

/// Prints text unchanged, including any colour codes.
pub(crate) fn print_as_is(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Ok(()) => Ok(()),
        // Later input may still turn out to be invalid, and the exit code must say so.
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe && EXIT_CODE_IS_RESULT.load(Ordering::Relaxed) => {
            Ok(())
        }
        // The reader has seen enough, as with `| head`.
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe =>
        {
            #[expect(clippy::exit, reason = "nobody reads the output any more")]
            std::process::exit(0)
        }
        Err(error) => Err(Failure::input(format!("standard output: {error}"))),
    }
}

/// Prints a value as indented JSON.
pub(crate) fn json(value: &impl Serialize) -> Result<(), Failure> {
    carries_data();
    print_json(&(serde_json::to_string_pretty(value)? + "\n"))
}

/// Prints a message that is not a result on standard error, with unprintable characters escaped. If the
/// reader has gone, the work continues.
pub(crate) fn note(text: impl AsRef<str>) {
    let text = wrap_lines(&printable_lines(text.as_ref()), columns_of_stderr());
    let text = match Style::of_message(&text).filter(|_| style::of_stderr()) {
        Some((style, length)) => style.painted(&text[..length]) + &text[length..],
        None => text,
    };
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Prints a warning on standard error.
pub(crate) fn warning(text: impl AsRef<str>) {
    note(format!("warning: {}", text.as_ref()));
}

/// Whether a path means standard output: `-`, or one of the system's names for it.
pub(crate) fn is_stdout(path: &Path) -> bool {
    path == Path::new("-") || driftworld_atomic_files::is_own_stdout(path)
}

/// Writes a JSON document to a file, or prints it for `-`.
pub(crate) fn write_or_print(path: &Path, json: &str) -> Result<(), Failure> {
    if is_stdout(path) {
        carries_data();
        print_json(json)
    } else {
        write(path, json.as_bytes())?;
        wrote(path, "");
        Ok(())
    }
}

/// Writes a picture as PNG or SVG, and reports it with its size.
pub(crate) fn write_and_report_picture(path: &Path, picture: &Drawing) -> Result<(), Failure> {
    write_picture(path, picture)?;
    wrote(path, format!("{} × {} pixels", picture.width, picture.height));
    Ok(())
}

/// A progress bar on a terminal, invisible elsewhere.
pub(crate) fn progress(steps: u64, what: &'static str) -> ProgressBar {
    if !std::io::stderr().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{prefix:<12} {bar:40} {pos}/{len} {eta} {msg}")
        .expect("the template is a constant that indicatif accepts");
    let bar = ProgressBar::new(steps).with_style(style).with_prefix(what);
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}
