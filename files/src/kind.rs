//! Checks that a path is a regular file; the error names its actual kind.

use std::fs::FileType;
use std::path::Path;

use crate::FileError;

/// Name of a broken link in messages.
pub const LOST_LINK: &str = "a link that leads nowhere";

/// Returns an error for anything but a regular file.
pub(crate) fn check(path: &Path, kind: FileType) -> Result<(), FileError> {
    if kind.is_file() {
        Ok(())
    } else {
        Err(error(path, name(kind)))
    }
}

pub(crate) fn error(path: &Path, found: &'static str) -> FileError {
    FileError::NotAFile {
        path: path.to_owned(),
        found,
    }
}

#[cfg(unix)]
fn name(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    if kind.is_dir() {
        "a folder"
    } else if kind.is_fifo() {
        "a named pipe"
    } else if kind.is_socket() {
        "a socket"
    } else {
        "a device"
    }
}

#[cfg(not(unix))]
fn name(kind: FileType) -> &'static str {
    if kind.is_dir() { "a folder" } else { "something else" }
}
