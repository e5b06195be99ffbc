//! [`AtomicFile`]: writes a file under a temporary name, and renames it when it is complete.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use crate::destination::Destination;
use crate::leftovers::{ENDING, TRIES, remove_leftovers_once};
use crate::permissions;
use crate::unfinished::Unfinished;

/// Maximum number of characters that a temporary name copies from the file's name.
const MAX_CHARACTERS: usize = 60;

/// A file that is being written. If it is dropped before [`commit`](Self::commit), it is removed, and a previous file
/// of the same name stays as it was.
#[derive(Debug)]
pub struct AtomicFile(Kind);

#[derive(Debug)]
enum Kind {
    Beside {
        // Declared before `unfinished`, so that the file is removed before its entry.
        file: NamedTempFile,
        target: PathBuf,
        unfinished: Unfinished,
    },
    Straight(fs::File),
}

impl AtomicFile {
    /// Starts a file, and creates its folder if that is missing. Links are followed, and kept.
    ///
    /// A new file gets mode 0666 minus the umask. A file that replaces an existing one keeps its mode, and its
    /// owner where permitted. Devices, pipes and descriptors (`/dev/null`, `/dev/stdout`, `/dev/fd/3`) are opened and
    /// written directly.
    ///
    /// # Errors
    /// I/O errors; [`io::ErrorKind::IsADirectory`] if the path is a folder.
    pub fn create(path: &Path) -> io::Result<Self> {
        match Destination::of(path)? {
            Destination::File(target) => Self::beside(target),
            Destination::Straight(file) => Ok(Self(Kind::Straight(file))),
        }
    }

    /// Like [`create`](Self::create), but does not follow links: a link at this path is replaced, and its target stays
    /// unchanged.
    ///
    /// # Errors
    /// The errors of [`create`](Self::create).
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
        let prefix: String = name.chars().take(MAX_CHARACTERS).collect();
        let prefix = format!(".{prefix}.");
        let mut builder = Builder::new();
        builder.prefix(&prefix).suffix(ENDING);
        permissions::begin(&mut builder, before.as_ref());
        let mut tries = 0;
        loop {
            let (file, unfinished) = Unfinished::make(|| builder.tempfile_in(folder), NamedTempFile::path)?;
            // Some file systems do not support locks; leftovers stay there.
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

    /// Whether output goes directly to a device, a pipe or an open descriptor, whose reader may see it before
    /// [`commit`](Self::commit).
    pub fn is_straight(&self) -> bool {
        matches!(self.0, Kind::Straight(_))
    }

    /// Finishes the file: syncs it to disk, and renames it to its final name.
    ///
    /// # Errors
    /// I/O errors. A previous file then stays as it was.
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

/// Writes a whole file with [`AtomicFile`].
///
/// # Errors
/// The errors of [`AtomicFile::create`] and [`AtomicFile::commit`].
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = AtomicFile::create(path)?;
    file.write_all(bytes)?;
    file.commit()
}
