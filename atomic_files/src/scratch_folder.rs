//! [`ScratchFolder`]: a temporary folder that is removed when the work ends, whether it succeeds or fails.

use std::fs::{self, TryLockError};
use std::io;
use std::path::Path;

use tempfile::TempDir;

use crate::leftovers::{TRIES, remove_in};
use crate::unfinished::Unfinished;

/// A temporary folder whose name starts with a given prefix. Dropping it deletes it with all its contents.
#[derive(Debug)]
pub struct ScratchFolder {
    folder: TempDir,
    /// Never read: the held lock tells other processes that the folder is in use.
    _lock: Option<fs::File>,
    _unfinished: Unfinished,
}

impl ScratchFolder {
    /// Creates a scratch folder in `parent`, after removing any that killed processes left there with the same prefix.
    ///
    /// # Errors
    /// I/O errors.
    pub fn new(prefix: &str, parent: &Path) -> io::Result<Self> {
        remove_in(parent, |name| name.starts_with(prefix), |path| fs::remove_dir_all(path));
        let mut tries = 0;
        loop {
            let (folder, unfinished) = Unfinished::make(|| TempDir::with_prefix_in(prefix, parent), TempDir::path)?;
            // Opened here, not through driftworld-files: this is a folder, opened to lock it.
            let lock = fs::File::open(folder.path());
            let is_taken = match lock.as_ref().map(fs::File::try_lock) {
                Err(_) | Ok(Err(TryLockError::WouldBlock)) => true,
                // Another process may have removed it as a leftover before it was locked.
                Ok(_) => !folder.path().exists(),
            };
            tries += 1;
            if !is_taken || tries == TRIES {
                return Ok(Self {
                    folder,
                    _lock: lock.ok(),
                    _unfinished: unfinished,
                });
            }
        }
    }

    /// The folder's path.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Deletes the folder, and reports a failure, which dropping would ignore.
    ///
    /// # Errors
    /// I/O errors.
    pub fn close(self) -> io::Result<()> {
        self.folder.close()
    }
}
