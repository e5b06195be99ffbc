//! Removes the unfinished files of killed processes: those with our file name suffix that no process has locked.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// File name suffix of unfinished files.
pub(crate) const ENDING: &str = ".driftworld-part";

/// Maximum number of attempts to create a file or folder: another process may remove it as a leftover before it is locked.
pub(crate) const TRIES: u32 = 8;

/// Maximum number of folders remembered as already searched.
const MAX_FOLDERS: usize = 4096;

/// Whether this is the name of an unfinished file: one being written, or one left by a killed process.
pub fn is_unfinished(name: &str) -> bool {
    name.starts_with('.') && name.ends_with(ENDING)
}

/// Removes the unfinished files that killed processes left in a folder. Files that cannot be opened or removed are left in
/// place; they do no harm.
pub fn remove_leftovers(folder: &Path) {
    remove_in(folder, is_unfinished, |path| fs::remove_file(path));
}

/// Like [`remove_leftovers`], but once per folder: a process that writes many files into it searches it only once.
pub(crate) fn remove_leftovers_once(folder: &Path) {
    static SEARCHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    let Ok(folder) = folder.canonicalize() else { return };
    let is_new = {
        let mut searched = SEARCHED.lock().unwrap_or_else(PoisonError::into_inner);
        if searched.len() == MAX_FOLDERS {
            searched.clear();
        }
        searched.insert(folder.clone())
    };
    if is_new {
        remove_leftovers(&folder);
    }
}

/// Removes files and folders whose names match and that no process has locked.
pub(crate) fn remove_in(folder: &Path, is_ours: impl Fn(&str) -> bool, remove: impl Fn(&Path) -> io::Result<()>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let is_plain = entry.file_type().is_ok_and(|kind| kind.is_file() || kind.is_dir());
        if is_plain && is_ours(&entry.file_name().to_string_lossy()) {
            let path = entry.path();
            // Holds the lock while removing, so that no other process starts to use the file.
            if let Ok(file) = open_to_lock(&path)
                && file.try_lock().is_ok()
            {
                let _ = remove(&path);
            }
        }
    }
}

/// Opens a file to lock it, for writing where possible: some file systems can lock only files open for writing.
fn open_to_lock(path: &Path) -> io::Result<File> {
    let for_writing = OpenOptions::new().read(true).write(true).open(path);
    // Opened here, not through driftworld-files: it is only locked, never read, and its name shows that it is ours.
    for_writing.or_else(|_| File::open(path))
}
