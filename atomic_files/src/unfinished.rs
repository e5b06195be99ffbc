//! Keeps track of this process's unfinished files and folders, so that they can be removed when it is stopped.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn paths() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // The set is valid even if a thread panicked while holding the lock.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The entry of an unfinished file or folder, removed on drop.
#[derive(Debug)]
pub(crate) struct Unfinished(PathBuf);

impl Unfinished {
    /// Creates a file or folder and records it under the same lock, so that [`remove_unfinished`] cannot miss it.
    pub(crate) fn make<T>(
        make: impl FnOnce() -> io::Result<T>,
        path: impl FnOnce(&T) -> &Path,
    ) -> io::Result<(T, Self)> {
        let mut paths = paths();
        let created = make()?;
        let path = path(&created).to_owned();
        paths.insert(path.clone());
        Ok((created, Self(path)))
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        paths().remove(&self.0);
    }
}

/// Removes all unfinished files and folders of this process. Only for a process that is about to exit: starting or
/// finishing a file afterwards blocks forever.
pub fn remove_unfinished() {
    let paths = paths();
    for path in paths.iter() {
        // Anything that cannot be removed is left to the next process that writes there.
        let _ = fs::remove_file(path).or_else(|_| fs::remove_dir_all(path));
    }
    std::mem::forget(paths);
}
