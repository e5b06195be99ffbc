//! Files as Python reads and writes them. Reading is careful as in `files`; how files appear whole or not at all is said in
//! `atomic_files`.

use std::path::PathBuf;

use crate::rounding::detach;
use driftworld::{MAX_LIBRARY_BYTES, MAX_MATRIX_BYTES};
use driftworld_files::FileError;
use driftworld_spec::MAX_BYTES;
use driftworld_text::printable_lines;
use pyo3::exceptions::{PyIsADirectoryError, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// Writes a file; its folder is made where it is missing.
#[pyfunction]
pub(crate) fn write_file(py: Python<'_>, path: PathBuf, content: &[u8]) -> PyResult<()> {
    Ok(detach(py, || driftworld_atomic_files::write(&path, content))?)
}

/// The bytes of a regular file: a `"document"`, a `"library"` or a `"matrix"`, each up to its limit.
#[pyfunction]
pub(crate) fn read_file<'py>(py: Python<'py>, path: PathBuf, kind: &str) -> PyResult<Bound<'py, PyBytes>> {
    let limit = match kind {
        "document" => MAX_BYTES as u64,
        "library" => MAX_LIBRARY_BYTES,
        "matrix" => MAX_MATRIX_BYTES,
        _ => {
            return Err(PyValueError::new_err(format!(
                "kind: found {kind:?}, expected document, library or matrix"
            )));
        }
    };
    let bytes = detach(py, || driftworld_files::read(&path, limit)).map_err(refused)?;
    Ok(PyBytes::new(py, &bytes))
}

fn refused(error: FileError) -> PyErr {
    let text = printable_lines(&error.to_string()).into_owned();
    match error {
        // Python has the words for its number.
        FileError::Unreadable { source, .. } => match source.raw_os_error() {
            Some(number) => PyOSError::new_err((number, source.to_string())),
            None => source.into(),
        },
        FileError::NotAFile { found: "a folder", .. } => PyIsADirectoryError::new_err(text),
        _ => PyOSError::new_err(text),
    }
}
