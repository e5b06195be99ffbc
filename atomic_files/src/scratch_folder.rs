//! [`ScratchFolder`]: a folder for what is made of several files, gone when the work is over, however it ends.

use std::fs::{self, TryLockError};
use std::io;
use std::path::Path;

use tempfile::TempDir;

use crate::leftovers::{TRIES, remove_in};
use crate::unfinished::Unfinished;

/// A folder of our own with a name that begins as given. Dropped, it is gone with all that is in it.
#[derive(Debug)]
pub struct ScratchFolder {
    folder: TempDir,
    /// Held, not used: who has it locked is still at work.
    _lock: Option<fs::File>,
    _unfinished: Unfinished,
}

impl ScratchFolder {
    /// Makes one in a folder that is there. Those that killed processes left there under such names are removed.
    ///
    /// # Errors
    /// Those of the system.
    pub fn new(prefix: &str, parent: &Path) -> io::Result<Self> {
        remove_in(parent, |name| name.starts_with(prefix), |path| fs::remove_dir_all(path));
        let mut tries = 0;
        loop {
            let (folder, unfinished) = Unfinished::make(|| TempDir::with_prefix_in(prefix, parent), TempDir::path)?;
            // A folder to be locked, not by driftworld-files: that opens regular files only.
            let lock = fs::File::open(folder.path());
            let is_taken = match lock.as_ref().map(fs::File::try_lock) {
                Err(_) | Ok(Err(TryLockError::WouldBlock)) => true,
                // Some file systems have no locks: then another may take it for a leftover.
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

    /// Where it is.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }

    /// Removes it, and says if that fails.
    ///
    /// # Errors
    /// Those of the system.
    pub fn close(self) -> io::Result<()> {
        self.folder.close()
    }
}
