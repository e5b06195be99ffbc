//! Files that appear whole or not at all.
//!
//! [`AtomicFile`] writes under a temporary name in the target's folder, renames the file when it is complete, and
//! removes it if writing fails. Devices and pipes cannot be replaced, so they are written directly.
//! [`ScratchFolder`] is a temporary folder for work with several files.
//!
//! A process that is stopped removes its own unfinished files with [`remove_unfinished`]. The files of a killed process
//! are removed by the next process that writes into the same folder: writers hold locks, so unlocked files are leftovers.
//!
//! ```
//! use std::io::Write;
//! use driftworld_atomic_files::AtomicFile;
//! # let base = tempfile::tempdir()?;
//! # let path = base.path().join("numbers.txt");
//! let mut file = AtomicFile::create(&path)?;
//! write!(file, "1 2 3")?;
//! assert!(!path.exists());
//! file.commit()?;
//! assert_eq!(std::fs::read_to_string(&path)?, "1 2 3");
//! # Ok::<(), std::io::Error>(())
//! ```

mod atomic_file;
mod destination;
mod leftovers;
mod permissions;
mod scratch_folder;
mod unfinished;

pub use atomic_file::{AtomicFile, write};
pub use destination::is_own_stdout;
pub use leftovers::{is_unfinished, remove_leftovers};
pub use scratch_folder::ScratchFolder;
pub use unfinished::remove_unfinished;
