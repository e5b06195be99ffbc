//! [`LogFolder`]: the directory of a log that is being written. Locks it against a second writer, and checks that it is still the
//! one at its path.

use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::block_file::Written;
use super::identity::Identity;
use super::{logger_info, scenario_info};
use crate::MetricsError;

/// An open, locked log directory. It stays open, so that the system releases its lock even if the writer is killed.
#[derive(Debug)]
pub(super) struct LogFolder {
    /// The path as the user gave it, for messages.
    shown: PathBuf,
    /// The absolute path, because the process may change its working directory.
    absolute: PathBuf,
    /// Never read; holds the lock, which the system releases on closing. `None` if directories cannot be opened.
    _lock: Option<File>,
    /// Identity of the open directory.
    identity: Option<Identity>,
    /// Its info files, with their lengths in bytes.
    info: Vec<(&'static str, u64)>,
}

impl LogFolder {
    /// Opens and locks an existing directory.
    pub(super) fn lock(dir: &Path) -> Result<Self, MetricsError> {
        let absolute = std::path::absolute(dir).map_err(MetricsError::io(dir, "find this directory"))?;
        let lock = lock(dir, File::try_lock)?;
        let found = lock.as_ref().map(File::metadata).transpose();
        let found = found.map_err(MetricsError::io(dir, "inspect this directory"))?;
        Ok(Self {
            shown: dir.to_owned(),
            absolute,
            identity: found.as_ref().map(Identity::of),
            _lock: lock,
            info: Vec::new(),
        })
    }

    /// Records the existing info files, which must still exist at the end.
    pub(super) fn note_info_files(&mut self) {
        let names = [logger_info::FILE_NAME, scenario_info::FILE_NAME];
        self.info = names
            .into_iter()
            .filter_map(|name| Some((name, self.length_of(name)?)))
            .collect();
    }

    /// The path as the user gave it.
    pub(super) fn shown(&self) -> &Path {
        &self.shown
    }

    /// The absolute path of a file or directory inside.
    pub(super) fn absolute(&self, inside: &Path) -> PathBuf {
        self.absolute.join(inside)
    }

    /// The path of a file or directory inside, for messages.
    pub(super) fn shown_inside(&self, inside: &Path) -> PathBuf {
        self.shown.join(inside)
    }

    /// Fails if the open directory is no longer the one at the path; `written` are the files that would be lost with it.
    pub(super) fn check<'a>(&self, written: impl Iterator<Item = &'a Written>) -> Result<(), MetricsError> {
        let found = match fs::metadata(&self.absolute) {
            Ok(found) if !found.is_dir() => "a file",
            Ok(found) if self.identity.is_some_and(|identity| identity != Identity::of(&found)) => "another directory",
            Ok(_) => return Ok(()),
            Err(error) if error.kind() == ErrorKind::NotFound => "no directory",
            Err(error) => return Err(MetricsError::io(&self.shown, "find this directory")(error)),
        };
        let (rows, bytes) = written.fold((0, 0), |(rows, bytes), file| (rows + file.rows, bytes + file.bytes));
        Err(MetricsError::FolderLost {
            path: self.shown.clone(),
            found,
            rows,
            bytes,
        })
    }

    /// Fails if a recorded info file is missing or has a different length.
    pub(super) fn check_info_files(&self) -> Result<(), MetricsError> {
        for (name, length) in &self.info {
            let (path, expected) = (self.shown.join(name), *length);
            let Some(found) = self.length_of(name) else {
                let expected = "the info file that this log was started with; put it back";
                return Err(MetricsError::missing_file(path, expected));
            };
            if found != expected {
                return Err(MetricsError::InfoFileChanged { path, found, expected });
            }
        }
        Ok(())
    }

    /// The length of a file in the directory, in bytes; `None` if there is no such file.
    fn length_of(&self, name: &str) -> Option<u64> {
        let found = fs::metadata(self.absolute.join(name)).ok()?;
        found.is_file().then_some(found.len())
    }

    /// Creates missing nested directories inside, but never the log's directory itself.
    pub(super) fn make(&self, inside: &Path) -> Result<(), MetricsError> {
        let mut path = self.absolute.clone();
        for part in inside {
            path.push(part);
            match fs::create_dir(&path) {
                Err(error) if error.kind() != ErrorKind::AlreadyExists => {
                    let shown = self.shown_inside(inside);
                    return Err(MetricsError::io(shown, "make this directory")(error));
                }
                _ => {}
            }
        }
        Ok(())
    }
}

/// Locks a directory against a second writer while the returned file is open. On systems without such locks, there is no
/// protection.
///
/// The directory is locked because it exists before any file of the log and, unlike files, is never replaced. It is locked only
/// where locks are advisory: elsewhere the lock would block readers as well.
///
/// `try_lock` is [`File::try_lock`], or [`File::try_lock_shared`], which excludes writers but allows other readers.
pub(super) fn lock(dir: &Path, try_lock: fn(&File) -> Result<(), TryLockError>) -> Result<Option<File>, MetricsError> {
    if !cfg!(unix) {
        return Ok(None);
    }
    // Opened directly, not through driftworld-files: this is a folder, not a regular file.
    let file = File::open(dir).map_err(MetricsError::io(dir, "open this directory"))?;
    match try_lock(&file) {
        Err(TryLockError::WouldBlock) => Err(MetricsError::InUse(dir.to_owned())),
        // Without a lock, the open directory still provides its identity.
        Ok(()) | Err(TryLockError::Error(_)) => Ok(Some(file)),
    }
}
