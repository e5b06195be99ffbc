//! Where results go: standard output, or files that appear whole or not at all. What they say is the commands' own;
//! what a terminal would obey or hide in it is shown here, so that no command can forget it.

use std::io::{IsTerminal, Write};
use std::path::Path;
use std::time::Duration;

use driftworld_text::{ShownPath, printable_json, printable_lines};
use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use crate::Failure;
pub(crate) use crate::output_file::{create, unwritable, write, write_picture};
use crate::report::picture::Picture;

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

/// Writes a picture as a PNG file, and says so with its size.
pub(crate) fn write_picture_and_tell(path: &Path, picture: &Picture) -> Result<(), Failure> {
    write_picture(path, picture)?;
    line(format!(
        "{}: {} × {} pixels",
        path.shown(),
        picture.width,
        picture.height
    ))
}

/// A bar on a terminal, nothing elsewhere.
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
