//! The `driftworld` command from Python: run as a program, or asked by the package. What it does is the library's.

use std::ffi::OsString;
use std::sync::{Mutex, PoisonError};

use driftworld::commands::{self, Refusal};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::cause_details;
use crate::patience::{apart, workers};

/// Output, warnings, and message and details of a refusal.
type Answer<'py> = (String, Vec<String>, Option<(String, Bound<'py, PyDict>)>);

/// Runs the command as a program does: prints, and returns the exit code. ``argv`` begins with the program's name.
#[pyfunction]
pub(crate) fn main(py: Python<'_>, argv: Vec<OsString>) -> u8 {
    py.detach(|| commands::run(argv))
}

/// What the command would print, its warnings, and if it fails the message and what the error knows beside it.
#[pyfunction]
pub(crate) fn ask(py: Python<'_>, argv: Vec<OsString>) -> PyResult<Answer<'_>> {
    /// One question at a time is among the workers: one that waited there for another would hold up the worker that both need.
    static ASKED: Mutex<()> = Mutex::new(());
    let pool = workers(py)?;
    let answer = apart(py, move || {
        let _one_at_a_time = ASKED.lock().unwrap_or_else(PoisonError::into_inner);
        pool.install(|| commands::ask(argv))
    })?;
    Ok(match answer {
        Ok(answer) => (answer.output, answer.notes, None),
        Err(Refusal {
            message, notes, cause, ..
        }) => {
            let details = match cause {
                Some(cause) => cause_details(py, &*cause)?,
                None => PyDict::new(py),
            };
            (String::new(), notes, Some((message, details)))
        }
    })
}
