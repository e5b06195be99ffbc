//! Reads and writes files for Python.

use std::path::PathBuf;

use crate::rounding::detach;
use driftworld::{MAX_LIBRARY_BYTES, MAX_MATRIX_BYTES};
use driftworld_files::FileError;
use driftworld_spec::MAX_BYTES;
use driftworld_text::printable_lines;
use pyo3::exceptions::{PyIsADirectoryError, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// Writes a file; creates its folder if it is missing.
#[pyfunction]
pub(crate) fn write_file(py: Python<'_>, path: PathBuf, content: &[u8]) -> PyResult<()> {
    Ok(detach(py, || driftworld_atomic_files::write(&path, content))?)
}

/// Reads a regular file: a `"document"`, a `"library"` or a `"matrix"`, each with its size limit.
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
        // Python has a message for the error number.
        FileError::Unreadable { source, .. } => match source.raw_os_error() {
            Some(number) => PyOSError::new_err((number, source.to_string())),
            None => source.into(),
        },
        FileError::NotAFile { found: "a folder", .. } => PyIsADirectoryError::new_err(text),
        _ => PyOSError::new_err(text),
    }
}
