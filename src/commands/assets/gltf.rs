//! Reads glTF files up to a size limit, and never a file outside the model's own folder.

use std::fs;
use std::io::Read;
use std::path::Path;

use crate::env::{Library, MAX_IMPORT_BYTES};

use crate::Failure;

/// Refuses to overwrite a file that is not a library, such as a model.
pub(super) fn check_output(path: &Path) -> Result<(), Failure> {
    // Do not open a missing file, a pipe or a device: there is nothing to overwrite.
    if !fs::metadata(path).is_ok_and(|about| about.is_file() && about.len() > 0) {
        return Ok(());
    }
    let mut start = Vec::new();
    let read = driftworld_files::open(path, u64::MAX)?
        .file
        .take(16)
        .read_to_end(&mut start);
    read.map_err(|error| Failure::in_file(path, format!("cannot be read: {error}")))?;
    if Library::is_meant(&start) {
        return Ok(());
    }
    let found = "found a file that is not a library, expected a new name or a library";
    Err(Failure::in_file(path, found))
}

/// Reads a glTF file.
pub(super) fn model(path: &Path) -> Result<Vec<u8>, Failure> {
    Ok(driftworld_files::read(path, MAX_IMPORT_BYTES as u64)?)
}

/// Reads files beside a glTF file, provided that they lie in its folder after resolving all links.
pub(super) fn read_beside(path: &Path) -> impl FnMut(&str) -> Result<Vec<u8>, String> {
    let folder = crate::documents::folder_of(path).to_owned();
    move |relative| {
        let resolve = |path: &Path| path.canonicalize().map_err(|error| error.to_string());
        let (folder, file) = (resolve(&folder)?, resolve(&folder.join(relative))?);
        if !file.starts_with(&folder) {
            return Err("it leads out of the model's folder".to_owned());
        }
        let bytes = driftworld_files::read(&file, MAX_IMPORT_BYTES as u64);
        // The importer's message already names the file.
        bytes.map_err(|error| error.without_path())
    }
}
