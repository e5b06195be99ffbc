//! What tests of the command share: running it, and reading what it says. What it should say is the tests' own.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Runs the command in a folder.
pub(crate) fn driftworld(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_driftworld"))
        .current_dir(folder)
        .args(arguments)
        .output()
        .expect("the command was built and can be run")
}

/// Runs it and expects that it succeeds; returns what it prints.
pub(crate) fn succeed(folder: &Path, arguments: &[&str]) -> String {
    let output = driftworld(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?} failed:\n{errors}");
    String::from_utf8(output.stdout).expect("it prints text")
}

/// Runs it and expects that it fails with this exit code; returns what it says on standard error.
pub(crate) fn fail(folder: &Path, code: i32, arguments: &[&str]) -> String {
    let output = driftworld(folder, arguments);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{arguments:?} said:\n{errors}");
    errors
}

/// A folder for files that nobody needs afterwards.
pub(crate) fn scratch() -> tempfile::TempDir {
    tempfile::tempdir().expect("the machine has a folder for temporary files")
}

/// The text of a file.
pub(crate) fn text(path: impl AsRef<Path>) -> String {
    let path = path.as_ref();
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// A file or folder of the reference data, or nothing, said aloud, where the data are absent.
#[expect(clippy::print_stderr, reason = "a skipped oracle must be seen")]
pub(crate) fn reference(name: &str) -> Option<PathBuf> {
    let default = concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/reference");
    let base = std::env::var_os("DRIFTWORLD_REFERENCE").map_or_else(|| PathBuf::from(default), PathBuf::from);
    let path = base.join(name);
    if path.exists() {
        return Some(path);
    }
    eprintln!("SKIPPED: nothing at {}; set DRIFTWORLD_REFERENCE", path.display());
    None
}
