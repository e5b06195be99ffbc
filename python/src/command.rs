//! Runs the `driftworld` command from Python.

use std::ffi::OsString;

use crate::rounding::detach;
use driftworld::commands;
use pyo3::prelude::*;

/// Runs the command as a program does: prints, and returns the exit code. ``argv`` begins with the program's name.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, argv: Vec<OsString>) -> u8 {
    detach(py, || commands::run(argv))
}
