//! What is to be read must be a regular file: a pipe would be waited for without an end, a device may never end.
//!
//! Not here: opening it.

use std::fs::{self, FileType};
use std::path::Path;

use crate::MetricsError;

/// Refuses what is there, but is no regular file; links are followed. Where there is nothing, opening it says so.
pub(super) fn check(path: &Path) -> Result<(), MetricsError> {
    let found = match fs::metadata(path) {
        Ok(found) if found.is_file() => return Ok(()),
        Ok(found) => name(found.file_type()),
        Err(_) if path.is_symlink() => LOST,
        Err(_) => return Ok(()),
    };
    Err(error(path, found))
}

/// The error for a link that leads nowhere.
pub(super) fn lost_link(path: &Path) -> MetricsError {
    error(path, LOST)
}

const LOST: &str = "a link that leads nowhere";

fn error(path: &Path, found: &'static str) -> MetricsError {
    MetricsError::NotAFile {
        path: path.to_owned(),
        found,
    }
}

#[cfg(unix)]
fn name(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    if kind.is_dir() {
        "a directory"
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
    if kind.is_dir() { "a directory" } else { "something else" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_file_is_named() {
        let base = tempfile::tempdir().unwrap();
        let found = |path: &Path| match check(path) {
            Err(MetricsError::NotAFile { found, .. }) => Some(found),
            Err(other) => panic!("{other}"),
            Ok(()) => None,
        };
        assert_eq!(found(&base.path().join("absent")), None);
        assert_eq!(found(base.path()), Some("a directory"));
        let file = base.path().join("file");
        fs::write(&file, "").unwrap();
        assert_eq!(found(&file), None);
        #[cfg(unix)]
        {
            use std::os::unix::{fs::symlink, net::UnixListener};
            let at = |name: &str| base.path().join(name);
            symlink(&file, at("link")).unwrap();
            assert_eq!(found(&at("link")), None);
            symlink("nowhere", at("lost")).unwrap();
            assert_eq!(found(&at("lost")), Some("a link that leads nowhere"));
            let _socket = UnixListener::bind(at("socket")).unwrap();
            assert_eq!(found(&at("socket")), Some("a socket"));
            assert_eq!(found(Path::new("/dev/null")), Some("a device"));
        }
    }
}
