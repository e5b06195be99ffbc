//! What killed processes left of the files that they wrote: found by its name, and by the lock that nobody holds.
//!
//! Not here: what this process has not finished, see `unfinished`.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// How the name of every file ends that is not finished.
pub(crate) const ENDING: &str = ".driftworld-part";

/// How often something is made anew that another process took for a leftover before it was locked.
pub(crate) const TRIES: u32 = 8;

/// Most folders that are remembered as looked through.
const MOST_FOLDERS: usize = 4096;

/// Whether a file has the name of one that is being written, or was when its process was killed.
pub fn is_unfinished(name: &str) -> bool {
    name.starts_with('.') && name.ends_with(ENDING)
}

/// Removes from a folder the files that processes left which were killed while they wrote. What cannot be looked at or
/// removed stays: it harms nobody.
pub fn remove_leftovers(folder: &Path) {
    remove_in(folder, is_unfinished, |path| fs::remove_file(path));
}

/// The same once for each folder: a process that writes many files into one looks through it once.
pub(crate) fn remove_leftovers_once(folder: &Path) {
    static LOOKED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    let Ok(folder) = folder.canonicalize() else { return };
    let is_new = {
        let mut looked = LOOKED.lock().unwrap_or_else(PoisonError::into_inner);
        if looked.len() == MOST_FOLDERS {
            looked.clear();
        }
        looked.insert(folder.clone())
    };
    if is_new {
        remove_leftovers(&folder);
    }
}

/// Removes what has such a name and is locked by nobody.
pub(crate) fn remove_in(folder: &Path, is_ours: impl Fn(&str) -> bool, remove: impl Fn(&Path) -> io::Result<()>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let is_plain = entry.file_type().is_ok_and(|kind| kind.is_file() || kind.is_dir());
        if is_plain && is_ours(&entry.file_name().to_string_lossy()) {
            let path = entry.path();
            // The lock is held while it is removed: nobody takes the file up meanwhile.
            if let Ok(file) = opened(&path)
                && file.try_lock().is_ok()
            {
                let _ = remove(&path);
            }
        }
    }
}

/// Opened for writing where possible: some file systems lock nothing else.
fn opened(path: &Path) -> io::Result<File> {
    let written = OpenOptions::new().read(true).write(true).open(path);
    // To be locked and not read, not by driftworld-files: it is ours by its name.
    written.or_else(|_| File::open(path))
}
