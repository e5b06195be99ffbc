//! The files and folders of this process that are not finished, to be removed when it is stopped.
//!
//! Not here: what other processes left, see `leftovers`.

use std::collections::BTreeSet;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn paths() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    // Whoever panics with the lock has changed nothing by halves.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Something that is not finished: forgotten when this is dropped.
#[derive(Debug)]
pub(crate) struct Unfinished(PathBuf);

impl Unfinished {
    /// Makes something, and notes it in the same breath: nobody ends the process in between.
    pub(crate) fn make<T>(
        make: impl FnOnce() -> io::Result<T>,
        path: impl FnOnce(&T) -> &Path,
    ) -> io::Result<(T, Self)> {
        let mut paths = paths();
        let made = make()?;
        let path = path(&made).to_owned();
        paths.insert(path.clone());
        Ok((made, Self(path)))
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        paths().remove(&self.0);
    }
}

/// Removes every file and folder of this process that is not finished. For a process that is about to end: whoever
/// begins a file afterwards waits for ever.
pub fn remove_unfinished() {
    let paths = paths();
    for path in paths.iter() {
        // What cannot be removed stays for the next that writes there.
        let _ = fs::remove_file(path).or_else(|_| fs::remove_dir_all(path));
    }
    std::mem::forget(paths);
}
