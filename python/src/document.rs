//! Checks documents, and reads whole numbers.

use std::path::Path;

use driftworld::documents::{self, Kind};
use driftworld::{scenarios, tasks};
use pyo3::exceptions::{PyOverflowError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::classes::catalogue;
use crate::errors::{Error, Result, described};
use crate::rounding::detach;

/// A non-negative integer, such as a seed.
#[derive(Clone, Copy)]
pub(crate) struct Whole(pub(crate) u64);

impl<'py> FromPyObject<'_, 'py> for Whole {
    type Error = PyErr;

    fn extract(value: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        // Values that are not integers raise a type error; -1 and 2^64 a value error.
        value.extract().map(Self).map_err(|error| {
            if error.is_instance_of::<PyOverflowError>(value.py()) {
                PyValueError::new_err(format!("found {}, expected a whole number in 0..{}", &*value, u64::MAX))
            } else {
                error
            }
        })
    }
}

/// The document's kind, its problems, its warnings, and the error to raise.
type Verdict<'py> = (&'static str, Bound<'py, PyList>, Vec<String>, Option<Py<PyAny>>);

/// Checks a document: returns its kind, its problems and its warnings. `name` is used in messages; if it is the path of a file,
/// a scenario's tasks are resolved from its folder.
///
/// `libraries` are the bytes of asset libraries, whose classes are known in addition to the built-in ones.
#[pyfunction]
pub(crate) fn check<'py>(
    py: Python<'py>,
    name: &str,
    text: &str,
    kind: Option<&str>,
    libraries: Vec<Vec<u8>>,
) -> Result<Verdict<'py>> {
    let kind = match kind {
        Some(word) => word.parse::<Kind>().map_err(PyValueError::new_err)?,
        None => Kind::of(text),
    };
    let catalogue = catalogue(&libraries)?;
    let classes = tasks::classes(&catalogue);
    let path = Path::new(name);
    let checked = detach(py, || {
        let mut task = |called: &str| {
            if path.is_file() {
                scenarios::task_from(path, called)
            } else {
                tasks::task(called)
            }
        };
        let mut checked = documents::check(name, text, kind, &mut task, &classes);
        if kind == Kind::World && checked.error.is_none() {
            checked.warnings.extend(documents::start_inside(name, text, &catalogue));
        }
        checked.warnings.append(&mut checked.missing_tasks);
        checked
    });
    let problems = PyList::empty(py);
    let mut error = None;
    if let Some(found) = checked.error {
        for problem in found.problems() {
            problems.append(described(py, problem)?)?;
        }
        let raised = PyErr::from(Error::from(found));
        if problems.is_empty() {
            problems.append(alone(py, &raised)?)?;
        }
        error = Some(raised.into_value(py).into_any());
    }
    if let Some(found) = checked.same_log_name {
        let raised = PyErr::from(Error::from(found));
        problems.append(alone(py, &raised)?)?;
        error = Some(raised.into_value(py).into_any());
    }
    Ok((kind.word(), problems, checked.warnings, error))
}

/// A problem that concerns the whole document, as a dictionary.
fn alone<'py>(py: Python<'py>, raised: &PyErr) -> PyResult<Bound<'py, PyDict>> {
    let value = raised.value(py);
    let problem = PyDict::new(py);
    for name in ["code", "pointer", "line", "column"] {
        problem.set_item(name, value.getattr(name)?)?;
    }
    problem.set_item("message", value.str()?)?;
    Ok(problem)
}
