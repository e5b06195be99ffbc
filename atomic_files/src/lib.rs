//! Files that appear whole or not at all.
//!
//! [`AtomicFile`] is a file while it is written: under a temporary name beside the one that it will have, removed when
//! the work fails. Devices and pipes keep nothing that could be half, and are written straight. [`ScratchFolder`] is a
//! folder for what is made of several files.
//!
//! What a stopped process leaves is removed by itself, with [`remove_unfinished`]; what a killed one leaves, by the
//! next that writes into the same folder: whoever writes holds a lock, so what nobody has locked is left over.
//!
//! Not here: what is written, and reading it.
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
