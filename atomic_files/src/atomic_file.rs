//! [`AtomicFile`]: a file while it is written, under a name that says whose it will be.
//!
//! Not here: where it goes, see `destination`; who may read it, see `permissions`.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use crate::destination::Destination;
use crate::leftovers::{ENDING, TRIES, remove_leftovers_once};
use crate::permissions;
use crate::unfinished::Unfinished;

/// Most characters of a file's name that its temporary one begins with.
const MOST_CHARACTERS: usize = 60;

/// A file that is being written. Dropped before [`commit`](Self::commit), it is gone, and what was there before stays.
#[derive(Debug)]
pub struct AtomicFile(Kind);

#[derive(Debug)]
enum Kind {
    Beside {
        // Before the note of it: dropped in this order, it is gone when it is forgotten.
        file: NamedTempFile,
        target: PathBuf,
        unfinished: Unfinished,
    },
    Straight(fs::File),
}

impl AtomicFile {
    /// Begins a file; its folder is made where it is missing. Links are followed, and stay.
    ///
    /// A new file gets the mode 0666 less the umask. One that takes another's place keeps its mode, and its owner where
    /// that is allowed. Devices, pipes and descriptors (`/dev/null`, `/dev/stdout`, `/dev/fd/3`) are opened, and
    /// written straight.
    ///
    /// # Errors
    /// Those of the system; [`io::ErrorKind::IsADirectory`] for a folder.
    pub fn create(path: &Path) -> io::Result<Self> {
        match Destination::of(path)? {
            Destination::File(target) => Self::beside(target),
            Destination::Straight(file) => Ok(Self(Kind::Straight(file))),
        }
    }

    /// The same for a name that is no other's: a link of that name is replaced, and what it leads to stays as it is.
    ///
    /// # Errors
    /// As [`create`](Self::create).
    pub fn create_in_place_of_links(path: &Path) -> io::Result<Self> {
        Self::beside(path.to_owned())
    }

    fn beside(target: PathBuf) -> io::Result<Self> {
        let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new("."));
        fs::create_dir_all(folder)?;
        remove_leftovers_once(folder);
        let before = fs::symlink_metadata(&target).ok().filter(fs::Metadata::is_file);
        let name = target.file_name().unwrap_or_default().to_string_lossy();
        let prefix: String = name.chars().take(MOST_CHARACTERS).collect();
        let prefix = format!(".{prefix}.");
        let mut builder = Builder::new();
        builder.prefix(&prefix).suffix(ENDING);
        permissions::begin(&mut builder, before.as_ref());
        let mut tries = 0;
        loop {
            let (file, unfinished) = Unfinished::make(|| builder.tempfile_in(folder), NamedTempFile::path)?;
            // Some file systems have no locks: then leftovers stay.
            let _ = file.as_file().try_lock();
            tries += 1;
            if file.path().exists() || tries == TRIES {
                if let Some(before) = &before {
                    permissions::keep(file.as_file(), before);
                }
                return Ok(Self(Kind::Beside {
                    file,
                    target,
                    unfinished,
                }));
            }
        }
    }

    /// Whether what is written goes straight into a device, a pipe or what a process has open: somebody may be reading
    /// it now.
    pub fn is_straight(&self) -> bool {
        matches!(self.0, Kind::Straight(_))
    }

    /// Ends the file: asks the disk to have it, and gives it its name.
    ///
    /// # Errors
    /// Those of the system: then there is no such file, or the one that was there before.
    pub fn commit(self) -> io::Result<()> {
        match self.0 {
            Kind::Beside {
                file,
                target,
                unfinished,
            } => {
                file.as_file().sync_all()?;
                file.persist(&target).map_err(|error| error.error)?;
                drop(unfinished);
                Ok(())
            }
            Kind::Straight(mut file) => file.flush(),
        }
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.0 {
            Kind::Beside { file, .. } => file.write(bytes),
            Kind::Straight(file) => file.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.0 {
            Kind::Beside { file, .. } => file.flush(),
            Kind::Straight(file) => file.flush(),
        }
    }
}

/// Writes a file as [`AtomicFile`] does.
///
/// # Errors
/// As [`AtomicFile::create`] and [`AtomicFile::commit`].
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = AtomicFile::create(path)?;
    file.write_all(bytes)?;
    file.commit()
}
