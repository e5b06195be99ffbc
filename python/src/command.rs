//! The `driftworld` command from Python: run as a program, or asked by the package. What it does is the library's.

use std::ffi::OsString;

use driftworld::commands::{self, Refusal};
use pyo3::prelude::*;

use crate::patience::impatiently;

/// Runs the command as a program does: prints, and returns the exit code. ``argv`` begins with the program's name.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, argv: Vec<OsString>) -> u8 {
    py.detach(|| commands::run(argv))
}

/// What the command would print, its warnings, and the message that it fails with, if it does.
#[pyfunction]
pub(crate) fn ask(py: Python<'_>, argv: Vec<OsString>) -> PyResult<(String, Vec<String>, Option<String>)> {
    Ok(match impatiently(py, move || commands::ask(argv))? {
        Ok(answer) => (answer.output, answer.notes, None),
        Err(Refusal { message, notes, .. }) => (String::new(), notes, Some(message)),
    })
}
