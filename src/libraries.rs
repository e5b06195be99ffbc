//! Asset libraries from disk.

use std::path::{Path, PathBuf};

use driftworld_env::{Catalogue, Library};

use crate::Failure;

/// Maximum size of a library in bytes.
pub const MAX_LIBRARY_BYTES: u64 = 1 << 30;

/// The built-in assets, overridden by these libraries; later ones override earlier ones.
pub(crate) fn catalogue(paths: &[PathBuf]) -> Result<Catalogue, Failure> {
    let mut catalogue = Catalogue::default();
    for path in paths {
        catalogue = catalogue.with_library(&library(path)?);
    }
    Ok(catalogue)
}

/// A library from its file.
pub(crate) fn library(path: &Path) -> Result<Library, Failure> {
    let bytes = driftworld_files::read(path, MAX_LIBRARY_BYTES)?;
    Library::from_bytes(&bytes).map_err(|error| Failure::in_file(path, error))
}
