//! Where results go: standard output, or files that appear whole or not at all. What they say is the commands' own.

use std::fs;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};
use serde::Serialize;

use super::temporary::{Temporary, remove_leftovers};
use super::{Answer, Failure};

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

/// Prints text as it is.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
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
    line(serde_json::to_string_pretty(value)?)
}

/// Says something on standard error that is not a result.
pub(crate) fn note(text: impl AsRef<str>) {
    if keep(|answer| answer.notes.push(text.as_ref().to_owned())) {
        return;
    }
    to_standard_error(text.as_ref());
}

/// A line on standard error. Where its reader has gone, there is nobody to tell, and the work goes on.
pub(super) fn to_standard_error(text: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{text}");
}

/// Says on standard error what is odd.
pub(crate) fn warning(text: impl AsRef<str>) {
    note(format!("warning: {}", text.as_ref()));
}

/// Writes a file under a temporary name beside its own and renames it: it is there whole or not at all.
pub(crate) fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    let failed = |error: std::io::Error| unwritable(path, &error);
    let mut file = beside(path).map_err(failed)?;
    file.write_all(bytes).map_err(failed)?;
    persist(file, path)
}

/// A file to write into for long until it can take `path`'s name, as [`beside`]; what killed processes left of it is removed.
pub(crate) fn temporary(path: &Path) -> std::io::Result<Temporary> {
    let file = beside(path)?;
    if !is_special(path) {
        let (folder, name) = place(&behind_links(path));
        remove_leftovers(&folder, Some(&name));
    }
    Ok(file)
}

/// A file to write into until it can take `path`'s name: in the same folder, which is made where it is missing.
fn beside(path: &Path) -> std::io::Result<Temporary> {
    if is_special(path) {
        return Temporary::nameless();
    }
    let (folder, name) = place(&behind_links(path));
    fs::create_dir_all(&folder)?;
    Temporary::new(&folder, &name)
}

/// The folder of a file, and its name there.
fn place(path: &Path) -> (PathBuf, String) {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    (folder.unwrap_or(Path::new(".")).to_owned(), name)
}

/// Gives a finished temporary file its name.
///
/// A device or a pipe cannot be given away: what was written is copied into it instead.
pub(crate) fn persist(file: Temporary, path: &Path) -> Result<(), Failure> {
    let failed = |error: std::io::Error| unwritable(path, &error);
    if is_special(path) {
        let mut out = fs::OpenOptions::new().write(true).open(path).map_err(failed)?;
        std::io::copy(&mut file.reopen().map_err(failed)?, &mut out).map_err(failed)?;
        return Ok(());
    }
    file.as_file().sync_all().map_err(failed)?;
    let file = file.persist(&behind_links(path)).map_err(failed)?;
    readable_by_all(&file).map_err(failed)
}

fn unwritable(path: &Path, error: &std::io::Error) -> Failure {
    Failure::input(format!("{}: cannot be written: {error}", path.display()))
}

/// Whether the path is there and is neither a file nor a folder: `/dev/null`, a pipe, a terminal.
fn is_special(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|found| !found.is_file() && !found.is_dir())
}

/// The file that a symbolic link leads to, so that the link stays; else the path itself.
fn behind_links(path: &Path) -> PathBuf {
    path.canonicalize().unwrap_or_else(|_| path.to_path_buf())
}

/// Temporary files are private to their owner; results are not.
#[cfg(unix)]
fn readable_by_all(file: &fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn readable_by_all(_: &fs::File) -> std::io::Result<()> {
    Ok(())
}

/// To a file, or to standard output for `-`.
pub(crate) fn write_or_print(path: &Path, text: &str) -> Result<(), Failure> {
    if path == Path::new("-") {
        print(text)
    } else {
        write(path, text.as_bytes())
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
