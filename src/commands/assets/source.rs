//! Reading libraries and glTF files from disk: never more than their limits, and nothing outside a model's own folder.

use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

use crate::env::{Catalogue, Library, MAX_IMPORT_BYTES};
use clap::Args;
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
    Library::from_bytes(&bytes).map_err(|error| Failure::input(format!("{}: {error}", path.display())))
}

/// Refuses to write a library in place of a file that is something else, such as a model.
pub(super) fn check_output(path: &Path) -> Result<(), Failure> {
    // What is not there, or is a pipe or a device, is not opened: there is nothing to lose.
    if !fs::metadata(path).is_ok_and(|about| about.is_file() && about.len() > 0) {
        return Ok(());
    }
    let mut start = Vec::new();
    let read = fs::File::open(path).and_then(|file| file.take(16).read_to_end(&mut start));
    read.map_err(|error| unreadable(path, &error.to_string()))?;
    if Library::is_meant(&start) {
        return Ok(());
    }
    let found = "found a file that is no library, expected a new name or a library";
    Err(Failure::input(format!("{}: {found}", path.display())))
}

/// The bytes of a glTF file.
pub(super) fn model(path: &Path) -> Result<Vec<u8>, Failure> {
    bytes(path, MAX_IMPORT_BYTES).map_err(|reason| unreadable(path, &reason))
}

fn unreadable(path: &Path, reason: &str) -> Failure {
    Failure::input(format!("{}: cannot be read: {reason}", path.display()))
}

/// Reads the files beside a glTF file, as far as they lie in its folder when all links are followed.
pub(super) fn beside(path: &Path) -> impl FnMut(&str) -> Result<Vec<u8>, String> {
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    move |relative| {
        let folder = if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            &folder
        };
        let whole = |path: &Path| path.canonicalize().map_err(|error| error.to_string());
        let (folder, file) = (whole(folder)?, whole(&folder.join(relative))?);
        if !file.starts_with(&folder) {
            return Err("it leads out of the model's folder".to_owned());
        }
        bytes(&file, MAX_IMPORT_BYTES)
    }
}

/// The bytes of a regular file of at most `most` bytes.
fn bytes(path: &Path, most: usize) -> Result<Vec<u8>, String> {
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
