//! Opens regular files only, because reading a pipe could block forever, and a device may never end. Converts errors of
//! `driftworld-files` to [`MetricsError`].

use std::path::Path;

use driftworld_files::{FileError, Opened};

use crate::MetricsError;

/// Fails if the path exists but is not a regular file; links are followed. A missing file is reported when it is opened.
pub(super) fn check(path: &Path) -> Result<(), MetricsError> {
    match driftworld_files::check(path) {
        Err(error @ FileError::NotAFile { .. }) => Err(as_metrics_error(error)),
        _ => Ok(()),
    }
}

/// Opens a file of at most `limit` bytes.
pub(super) fn open(path: &Path, limit: u64) -> Result<Opened, MetricsError> {
    driftworld_files::open(path, limit).map_err(as_metrics_error)
}

/// The text of a file of at most `limit` bytes; `None` if there is no file.
pub(super) fn text(path: &Path, limit: u64) -> Result<Option<String>, MetricsError> {
    match driftworld_files::text(path, limit) {
        Ok(text) => Ok(Some(text)),
        Err(error) if error.missing().is_some() => Ok(None),
        Err(error) => Err(as_metrics_error(error)),
    }
}

fn as_metrics_error(error: FileError) -> MetricsError {
    match error {
        FileError::Unreadable { path, source } => MetricsError::io(&path, "read this file")(source),
        FileError::NotAFile { path, found } => MetricsError::NotAFile {
            path,
            // All messages about logs say "directory".
            found: if found == "a folder" { "a directory" } else { found },
        },
        FileError::NotText { path, at, line } => MetricsError::Json {
            path,
            line,
            column: 1,
            wrong: format!("byte {at} is not UTF-8, expected UTF-8 text; save it as UTF-8"),
        },
        FileError::TooLarge { path, found, limit } => MetricsError::too_large(path, "bytes or more", found, limit),
        other => MetricsError::Io {
            path: Path::new("").to_owned(),
            doing: "read this file",
            source: std::io::Error::other(other),
        },
    }
}

/// The error for a broken link.
pub(super) fn lost_link(path: &Path) -> MetricsError {
    MetricsError::NotAFile {
        path: path.to_owned(),
        found: driftworld_files::LOST_LINK,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn path_that_is_not_a_regular_file_is_reported() {
        let base = tempfile::tempdir().unwrap();
        let found = |path: &Path| match check(path) {
            Err(MetricsError::NotAFile { found, .. }) => Some(found),
            Err(other) => panic!("{other}"),
            Ok(()) => None,
        };
        assert_eq!(found(&base.path().join("absent")), None);
        assert_eq!(found(base.path()), Some("a directory"));
        let file = base.path().join("file");
        std::fs::write(&file, "").unwrap();
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
