//! Reading libraries from disk: never more than their limits.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::env::{Catalogue, Library};
use clap::Args;
use driftworld_text::ShownPath;
use serde_json::{Value, json};

use super::super::{Failure, input};

/// The largest library in bytes.
const MAX_LIBRARY_BYTES: usize = 1 << 30;

/// The libraries that a command's worlds take their assets from.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct LibraryChoice {
    /// A library of assets in front of the built-in ones; may be given several times, the last one first.
    #[arg(long = "assets", value_name = "LIBRARY")]
    libraries: Vec<PathBuf>,
}

impl LibraryChoice {
    /// The built-in assets, and the chosen libraries in front of them.
    pub(crate) fn catalogue(&self) -> Result<Catalogue, Failure> {
        let mut catalogue = Catalogue::default();
        for library in self.read()? {
            catalogue = catalogue.with_library(&library);
        }
        Ok(catalogue)
    }

    /// The checksum of each chosen library by its file's name, in the order they were named in; nothing if none was chosen.
    pub(crate) fn prints(&self) -> Result<Vec<Value>, Failure> {
        let print = |path: &PathBuf| {
            let bytes = bytes(path, MAX_LIBRARY_BYTES).map_err(|reason| unreadable(path, &reason))?;
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            Ok(json!({ "library": name, "sha256": input::checksum(&bytes) }))
        };
        self.libraries.iter().map(print).collect()
    }

    /// The chosen libraries, in the order they were named in.
    pub(super) fn read(&self) -> Result<Vec<Library>, Failure> {
        self.libraries.iter().map(|path| library(path)).collect()
    }
}

/// A library from its file.
pub(super) fn library(path: &Path) -> Result<Library, Failure> {
    let bytes = bytes(path, MAX_LIBRARY_BYTES).map_err(|reason| unreadable(path, &reason))?;
    Library::from_bytes(&bytes).map_err(|error| Failure::input(format!("{}: {error}", path.shown())))
}

pub(super) fn unreadable(path: &Path, reason: &str) -> Failure {
    Failure::input(format!("{}: cannot be read: {reason}", path.shown()))
}

/// The bytes of a regular file of at most `most` bytes.
pub(super) fn bytes(path: &Path, most: usize) -> Result<Vec<u8>, String> {
    let said = |error: std::io::Error| error.to_string();
    // Looked at before it is opened: opening a pipe would wait for ever.
    if !fs::metadata(path).map_err(said)?.is_file() {
        return Err("it is a folder or a device, not a file".to_owned());
    }
    let mut bytes = Vec::new();
    let file = fs::File::open(path).map_err(said)?;
    file.take(most as u64 + 1).read_to_end(&mut bytes).map_err(said)?;
    if bytes.len() > most {
        return Err(format!("it has more than {most} bytes"));
    }
    Ok(bytes)
}
