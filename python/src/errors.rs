//! Converts Rust errors to the exceptions in `driftworld/errors.py`.

use std::sync::Arc;

use driftworld::distances::DistancesError;
use driftworld::documents::DocumentError;
use driftworld::tasks::TaskError;
use driftworld::{Cause, Failure};
use driftworld_curriculum::CurriculumError;
use driftworld_env::EnvError;
use driftworld_generator::GeneratorError;
use driftworld_metrics::MetricsError;
use driftworld_similarity::SimilarityError;
use driftworld_spec::{Problem, SpecError};
use driftworld_text::printable_lines;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde_json::json;

use crate::json::to_py;

/// An error to be raised in Python.
#[derive(Debug)]
pub(crate) enum Error {
    /// An error of one of the crates.
    Cause(Cause),
    /// A scenario refers to a task with an invalid document: the scenario's error, and the document's problems.
    InScenario(CurriculumError, SpecError),
    /// A failed operation, raised as this class.
    Refused {
        class: &'static str,
        text: String,
        cause: Option<Cause>,
    },
    /// Already a Python exception.
    Python(PyErr),
}

/// Converts a failure of the library to an exception of this class.
pub(crate) fn refused(class: &'static str, failure: &Failure) -> Error {
    Error::Refused {
        class,
        text: failure.to_string(),
        cause: failure.cause(),
    }
}

/// The result of a function for Python.
pub(crate) type Result<T> = std::result::Result<T, Error>;

macro_rules! from {
    ($($source:ty),* $(,)?) => {
        $(impl From<$source> for Error {
            fn from(source: $source) -> Self {
                Self::Cause(Arc::new(source))
            }
        })*
    };
}

from!(
    SpecError,
    TaskError,
    GeneratorError,
    SimilarityError,
    EnvError,
    MetricsError,
    CurriculumError
);

impl From<PyErr> for Error {
    fn from(error: PyErr) -> Self {
        Self::Python(error)
    }
}

/// Classifies a failure by its cause. Without one, wrong usage is a `ValueError`; all else is a `DriftworldError`.
impl From<Failure> for Error {
    fn from(failure: Failure) -> Self {
        let class = match failure.cause().as_deref() {
            Some(cause) if cause.is::<EnvError>() => "EnvError",
            Some(cause) if cause.is::<MetricsError>() => "MetricsError",
            Some(cause) if cause.is::<CurriculumError>() => "CurriculumError",
            None if failure.is_usage() => return value_error(&failure.to_string()),
            _ => "DriftworldError",
        };
        refused(class, &failure)
    }
}

impl From<DistancesError> for Error {
    fn from(source: DistancesError) -> Self {
        match source {
            DistancesError::Generator(source) => source.into(),
            DistancesError::Similarity(source) => source.into(),
            // The enum may grow; the message is complete.
            source => value_error(&source.to_string()),
        }
    }
}

impl From<Error> for PyErr {
    fn from(error: Error) -> Self {
        Python::attach(|py| error.raise(py).unwrap_or_else(|failure| failure))
    }
}

impl Error {
    /// Creates the exception.
    fn raise(self, py: Python<'_>) -> PyResult<PyErr> {
        let details = PyDict::new(py);
        let (class, text) = match self {
            Self::Cause(cause) => {
                // The details describe the invalid variant along the drift.
                if let Some(GeneratorError::Between(source)) = cause.downcast_ref() {
                    of_spec(&details, source)?;
                }
                (describe(&details, &*cause)?, cause.to_string())
            }
            Self::InScenario(source, because) => {
                of_spec(&details, &because)?;
                (describe(&details, &source)?, source.to_string())
            }
            Self::Refused { class, text, cause } => {
                if let Some(cause) = cause {
                    describe(&details, &*cause)?;
                }
                (class, text)
            }
            Self::Python(source) => return Ok(source),
        };
        let class = py.import("driftworld.errors")?.getattr(class)?;
        // Escaped, because Python prints it unchanged.
        let text = printable_lines(&text);
        Ok(PyErr::from_value(class.call((text,), Some(&details))?))
    }
}

/// A `ValueError` with this text, unprintable characters escaped.
fn value_error(text: &str) -> Error {
    Error::Python(PyValueError::new_err(printable_lines(text).into_owned()))
}

/// A `ValueError` with an error's text, unchanged.
pub(crate) fn wrong(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Adds the details that a crate's error has besides its text, and returns the default class for raising it.
fn describe(details: &Bound<'_, PyDict>, cause: &(dyn std::error::Error + 'static)) -> PyResult<&'static str> {
    let (class, code) = if let Some(source) = cause.downcast_ref::<SpecError>() {
        of_spec(details, source)?;
        // An unknown name, rather than an invalid document.
        let is_name = matches!(source, SpecError::UnknownVariant { .. });
        (if is_name { "TaskError" } else { "SpecError" }, source.code())
    } else if let Some(source) = cause.downcast_ref::<MetricsError>() {
        details.set_item("line", source.line())?;
        if let MetricsError::Json { column, .. } = source {
            details.set_item("column", column)?;
        }
        ("MetricsError", source.code())
    } else if let Some(source) = cause.downcast_ref::<TaskError>() {
        match source {
            TaskError::Spec(source) => return describe(details, source),
            TaskError::Unreadable { .. } => ("TaskError", "task/unreadable"),
            TaskError::Document(_) => ("TaskError", "task/document"),
            _ => ("TaskError", "task/unknown"),
        }
    } else if let Some(source) = cause.downcast_ref::<CurriculumError>() {
        if let CurriculumError::Log(source) = source {
            return describe(details, source);
        }
        ("CurriculumError", source.code())
    } else if let Some(DocumentError::Spec(source)) = cause.downcast_ref::<DocumentError>() {
        return describe(details, source);
    } else if let Some(source) = cause.downcast_ref::<GeneratorError>() {
        ("GeneratorError", source.code())
    } else if let Some(source) = cause.downcast_ref::<SimilarityError>() {
        ("SimilarityError", source.code())
    } else if let Some(source) = cause.downcast_ref::<EnvError>() {
        ("EnvError", source.code())
    } else {
        return Ok("DriftworldError");
    };
    details.set_item("code", code)?;
    Ok(class)
}

fn of_spec(details: &Bound<'_, PyDict>, source: &SpecError) -> PyResult<()> {
    let py = details.py();
    let problems = source.problems().iter().map(|problem| described(py, problem));
    details.set_item("problems", PyList::new(py, problems.collect::<PyResult<Vec<_>>>()?)?)?;
    if let SpecError::Syntax { line, column, .. } = source {
        details.set_item("line", line)?;
        details.set_item("column", column)?;
    }
    Ok(())
}

/// Converts a document's problem to a dictionary.
pub(crate) fn described<'py>(py: Python<'py>, problem: &Problem) -> PyResult<Bound<'py, PyAny>> {
    // 0 means that the position is unknown.
    let known = |number: usize| (number > 0).then_some(number);
    let described = json!({
        "code": problem.code, "pointer": problem.pointer, "line": known(problem.line), "column": known(problem.column),
        "found": problem.found, "expected": problem.expected, "advice": problem.advice, "message": problem.to_string(),
    });
    to_py(py, &described)
}
