//! [`LogFolder`]: the directory of a log while it is written. It is locked against a second writer, and asked whether
//! it still is what lies at its path.
//!
//! Not here: the files in it, see `block_file`.

use std::fs::{self, File, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::block_file::Written;
use super::identity::Identity;
use super::{logger_info, scenario_info};
use crate::MetricsError;

/// A directory that is held open, so that its lock ends when the writer does, however it ends.
#[derive(Debug)]
pub(super) struct LogFolder {
    /// As the user gave it, for messages.
    shown: PathBuf,
    /// The same from the root: the process may turn to another directory.
    place: PathBuf,
    /// Held, not used: the system lets go of its lock when it is closed. `None` where directories cannot be opened.
    _held: Option<File>,
    /// Of the directory that is held.
    identity: Option<Identity>,
    /// The info files that it holds, with their lengths in bytes.
    info: Vec<(&'static str, u64)>,
}

impl LogFolder {
    /// Opens and locks a directory that is there.
    pub(super) fn lock(dir: &Path) -> Result<Self, MetricsError> {
        let place = std::path::absolute(dir).map_err(MetricsError::io(dir, "find this directory"))?;
        let held = lock(dir, File::try_lock)?;
        let found = held.as_ref().map(File::metadata).transpose();
        let found = found.map_err(MetricsError::io(dir, "look at this directory"))?;
        Ok(Self {
            shown: dir.to_owned(),
            place,
            identity: found.as_ref().map(Identity::of),
            _held: held,
            info: Vec::new(),
        })
    }

    /// Notes which info files there are: those must be there at the end, too.
    pub(super) fn note_info_files(&mut self) {
        let names = [logger_info::FILE_NAME, scenario_info::FILE_NAME];
        self.info = names
            .into_iter()
            .filter_map(|name| Some((name, self.length_of(name)?)))
            .collect();
    }

    /// As the user gave it.
    pub(super) fn shown(&self) -> &Path {
        &self.shown
    }

    /// Where to find something inside.
    pub(super) fn place(&self, inside: &Path) -> PathBuf {
        self.place.join(inside)
    }

    /// What messages call something inside.
    pub(super) fn shown_inside(&self, inside: &Path) -> PathBuf {
        self.shown.join(inside)
    }

    /// Refuses when the directory that is held is not the one at the path; `written` is what would be lost with it.
    pub(super) fn check<'a>(&self, written: impl Iterator<Item = &'a Written>) -> Result<(), MetricsError> {
        let found = match fs::metadata(&self.place) {
            Ok(found) if !found.is_dir() => "a file",
            Ok(found) if self.identity.is_some_and(|held| held != Identity::of(&found)) => "another directory",
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

    /// Refuses when an info file is gone that was there at the beginning, or has another length.
    pub(super) fn check_info_files(&self) -> Result<(), MetricsError> {
        for (name, length) in &self.info {
            let (path, expected) = (self.shown.join(name), *length);
            let Some(found) = self.length_of(name) else {
                let expected = "the info file that this log was begun with; put it back";
                return Err(MetricsError::missing_file(path, expected));
            };
            if found != expected {
                return Err(MetricsError::InfoFileChanged { path, found, expected });
            }
        }
        Ok(())
    }

    /// The length of a file of it in bytes; `None` where there is no file.
    fn length_of(&self, name: &str) -> Option<u64> {
        let found = fs::metadata(self.place.join(name)).ok()?;
        found.is_file().then_some(found.len())
    }

    /// Makes directories inside, one in the other, where they are missing; never the log's directory itself.
    pub(super) fn make(&self, inside: &Path) -> Result<(), MetricsError> {
        let mut path = self.place.clone();
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

/// Keeps a second writer away from a directory, as long as the file that comes back is open. Where the system has no
/// such locks, there is none.
///
/// It is the directory that is locked: it is there before any file of the log, and no file is put in its place. Only
/// where locks are advice: elsewhere they would keep readers away, too.
///
/// `try_lock`: [`File::try_lock`], or [`File::try_lock_shared`], which keeps writers away, but not others that only read.
pub(super) fn lock(dir: &Path, try_lock: fn(&File) -> Result<(), TryLockError>) -> Result<Option<File>, MetricsError> {
    if !cfg!(unix) {
        return Ok(None);
    }
    // A folder to be locked, not by driftworld-files: that opens regular files only.
    let file = File::open(dir).map_err(MetricsError::io(dir, "open this directory"))?;
    match try_lock(&file) {
        Err(TryLockError::WouldBlock) => Err(MetricsError::InUse(dir.to_owned())),
        // Held all the same, to be known again.
        Ok(()) | Err(TryLockError::Error(_)) => Ok(Some(file)),
    }
}
