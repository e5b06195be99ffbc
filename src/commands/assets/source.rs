//! The option that names asset libraries.

use std::path::PathBuf;

use crate::env::{Catalogue, Library};
use crate::libraries::{self, MAX_LIBRARY_BYTES};
use clap::Args;
use serde_json::{Value, json};

use crate::Failure;
use crate::checksum::checksum;

/// The libraries that a command's worlds take their assets from.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct LibraryChoice {
    /// An asset library to search before the built-in assets. Repeatable.
    ///
    /// The last one given is searched first.
    #[arg(long = "assets", value_name = "LIBRARY")]
    libraries: Vec<PathBuf>,
}

impl LibraryChoice {
    /// The built-in assets, with the chosen libraries in front of them.
    pub(crate) fn catalogue(&self) -> Result<Catalogue, Failure> {
        libraries::catalogue(&self.libraries)
    }

    /// The chosen libraries' files.
    pub(crate) fn paths(&self) -> &[PathBuf] {
        &self.libraries
    }

    /// The checksum of each chosen library by its file name, in the order given; empty if none was chosen.
    pub(crate) fn fingerprints(&self) -> Result<Vec<Value>, Failure> {
        let fingerprint = |path: &PathBuf| {
            let bytes = driftworld_files::read(path, MAX_LIBRARY_BYTES)?;
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            Ok(json!({ "library": name, "sha256": checksum(&bytes) }))
        };
        self.libraries.iter().map(fingerprint).collect()
    }

    /// The chosen libraries, in the order given.
    pub(super) fn read(&self) -> Result<Vec<Library>, Failure> {
        self.libraries.iter().map(|path| libraries::library(path)).collect()
    }
}
