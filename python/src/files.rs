//! Files that appear whole or not at all, as Python writes them. How is said in `atomic_files`.

use std::path::PathBuf;

use pyo3::prelude::*;

/// Writes a file; its folder is made where it is missing.
#[pyfunction]
pub(crate) fn write_file(py: Python<'_>, path: PathBuf, content: &[u8]) -> PyResult<()> {
    Ok(py.detach(|| driftworld_atomic_files::write(&path, content))?)
}
