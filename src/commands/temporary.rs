//! [`Temporary`]: a file while it is written, under a name that says whose it will be. Where it goes then is `output.rs`'s.
//!
//! It is removed when the work fails or is interrupted. What a killed process leaves behind is removed by the next one that writes
//! the same file: whoever writes holds a lock, so what nobody has locked is left over.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

/// How the name of every such file ends.
const ENDING: &str = ".driftworld-part";

/// Most characters of a file's name that its temporary one begins with.
const MOST_CHARACTERS: usize = 60;

/// How often a file is made anew that another process took for a leftover before it was locked.
const TRIES: u32 = 8;

/// A file that is being written. Dropped, it is gone.
pub(crate) struct Temporary(NamedTempFile);

impl Temporary {
    /// One in a folder, which will be called `name`.
    pub(crate) fn new(folder: &Path, name: &str) -> io::Result<Self> {
        let mut tries = 0;
        loop {
            let file = Builder::new()
                .prefix(&beginning(name))
                .suffix(ENDING)
                .tempfile_in(folder)?;
            // Some file systems have no locks: then leftovers stay.
            let _ = file.as_file().try_lock();
            tries += 1;
            if file.path().exists() || tries == TRIES {
                return Ok(Self(file));
            }
        }
    }

    /// One that gets no name: what is in it is copied.
    pub(crate) fn nameless() -> io::Result<Self> {
        Ok(Self(NamedTempFile::new()?))
    }

    /// The file itself.
    pub(crate) fn as_file(&self) -> &fs::File {
        self.0.as_file()
    }

    /// The file, opened again from its beginning.
    pub(crate) fn reopen(&self) -> io::Result<fs::File> {
        self.0.reopen()
    }

    /// Gives it its name.
    pub(crate) fn persist(self, path: &Path) -> io::Result<fs::File> {
        self.0.persist(path).map_err(|error| error.error)
    }
}

impl Write for Temporary {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

fn beginning(name: &str) -> String {
    let name: String = name.chars().take(MOST_CHARACTERS).collect();
    format!(".{name}.")
}

/// Removes what processes left in a folder that were killed while they wrote: of the file of this name, or of all files.
///
/// What cannot be looked at or removed stays: it harms nobody.
pub(crate) fn remove_leftovers(folder: &Path, name: Option<&str>) {
    let beginning = name.map_or_else(|| ".".to_owned(), beginning);
    let Ok(entries) = fs::read_dir(folder) else { return };
    let is_ours = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with(&beginning) && name.ends_with(ENDING)
    };
    for path in entries.flatten().map(|entry| entry.path()).filter(is_ours) {
        let is_left_over = fs::File::open(&path).is_ok_and(|file| file.try_lock().is_ok());
        if is_left_over {
            let _ = fs::remove_file(&path);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).expect("the folder is there");
        let name =
            |entry: io::Result<fs::DirEntry>| entry.expect("an entry").file_name().to_string_lossy().into_owned();
        let mut names: Vec<String> = entries.map(name).collect();
        names.sort();
        names
    }

    #[test]
    fn leftovers_go_and_what_is_being_written_stays() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path();
        for name in [
            ".a.jsonl.123.driftworld-part",
            ".b.jsonl.123.driftworld-part",
            ".a.jsonl.swp",
        ] {
            fs::write(path.join(name), "half").expect("the folder is ours");
        }
        let mut written = Temporary::new(path, "a.jsonl").expect("the folder is ours");
        written.write_all(b"more").expect("there is room");
        remove_leftovers(path, Some("a.jsonl"));
        let left = names(path);
        assert_eq!(left.len(), 3, "{left:?}");
        assert!(left.contains(&".b.jsonl.123.driftworld-part".to_owned()) && left.contains(&".a.jsonl.swp".to_owned()));
        written.persist(&path.join("a.jsonl")).expect("the folder is ours");
        remove_leftovers(path, None);
        assert_eq!(names(path), [".a.jsonl.swp", "a.jsonl"]);
    }

    #[test]
    fn a_file_that_is_given_up_is_gone() {
        let folder = tempfile::tempdir().expect("a folder");
        drop(Temporary::new(folder.path(), &"ä".repeat(200)).expect("long names are cut"));
        assert!(names(folder.path()).is_empty());
    }
}
