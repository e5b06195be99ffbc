//! Rust's errors as Python's: one `match` for each crate's. The classes themselves are in `driftworld/errors.py`.

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

/// An error of one of the crates, on its way to Python.
#[derive(Debug)]
pub(crate) enum Error {
    Spec(SpecError),
    Task(TaskError),
    Generator(GeneratorError),
    Similarity(SimilarityError),
    Env(EnvError),
    Metrics(MetricsError),
    Curriculum(CurriculumError),
    /// A scenario names a task whose document is wrong: what the scenario's error says, and what is wrong with the document.
    InScenario(CurriculumError, SpecError),
    /// An operation that has no result, raised as this class.
    Refused {
        class: &'static str,
        text: String,
        cause: Option<Cause>,
    },
    /// Already one of Python's.
    Python(PyErr),
}

/// A failure of the library as an exception of this class.
pub(crate) fn refused(class: &'static str, failure: &Failure) -> Error {
    Error::Refused {
        class,
        text: failure.to_string(),
        cause: failure.cause(),
    }
}

/// What a function for Python hands back.
pub(crate) type Result<T> = std::result::Result<T, Error>;

macro_rules! from {
    ($($variant:ident($source:ty)),* $(,)?) => {
        $(impl From<$source> for Error {
            fn from(source: $source) -> Self {
                Self::$variant(source)
            }
        })*
    };
}

from!(
    Spec(SpecError),
    Generator(GeneratorError),
    Similarity(SimilarityError),
    Env(EnvError),
    Metrics(MetricsError),
    Python(PyErr),
);

impl From<CurriculumError> for Error {
    fn from(source: CurriculumError) -> Self {
        match source {
            CurriculumError::Log(source) => Self::Metrics(source),
            source => Self::Curriculum(source),
        }
    }
}

/// A failure by its cause, where that is one of the crates' errors; else as what is wrong with an argument.
impl From<Failure> for Error {
    fn from(failure: Failure) -> Self {
        let class = match failure.cause().as_deref() {
            Some(cause) if cause.is::<EnvError>() => "EnvError",
            Some(cause) if cause.is::<MetricsError>() => "MetricsError",
            Some(cause) if cause.is::<CurriculumError>() => "CurriculumError",
            None if matches!(failure, Failure::Usage(_)) => {
                return Self::Python(PyValueError::new_err(
                    printable_lines(&failure.to_string()).into_owned(),
                ));
            }
            _ => "DriftworldError",
        };
        refused(class, &failure)
    }
}

impl From<TaskError> for Error {
    fn from(source: TaskError) -> Self {
        match source {
            TaskError::Spec(source) => Self::Spec(source),
            source => Self::Task(source),
        }
    }
}

impl From<DistancesError> for Error {
    fn from(source: DistancesError) -> Self {
        match source {
            DistancesError::Generator(source) => Self::Generator(source),
            DistancesError::Similarity(source) => Self::Similarity(source),
            // The enum may grow; its message says all there is to say.
            source => Self::Python(PyValueError::new_err(printable_lines(&source.to_string()).into_owned())),
        }
    }
}

impl From<Error> for PyErr {
    fn from(error: Error) -> Self {
        Python::attach(|py| error.raise(py).unwrap_or_else(|failure| failure))
    }
}

impl Error {
    /// The exception for this error.
    fn raise(self, py: Python<'_>) -> PyResult<PyErr> {
        let details = PyDict::new(py);
        let (class, source): (_, &(dyn std::error::Error + 'static)) = match &self {
            // A name that stands for nothing, and no document that is wrong.
            Self::Spec(source @ SpecError::UnknownVariant { .. }) => ("TaskError", source),
            Self::Spec(source) => ("SpecError", source),
            Self::Task(source) => ("TaskError", source),
            Self::Generator(source) => {
                // What is wrong with the variant on the way is what is wrong.
                if let GeneratorError::Between(source) = source {
                    of_spec(&details, source)?;
                }
                ("GeneratorError", source)
            }
            Self::Similarity(source) => ("SimilarityError", source),
            Self::Env(source) => {
                if let EnvError::BadScript { line, .. } = source {
                    details.set_item("line", line)?;
                }
                ("EnvError", source)
            }
            Self::Metrics(source) => ("MetricsError", source),
            Self::Curriculum(source) => ("CurriculumError", source),
            Self::InScenario(source, because) => {
                of_spec(&details, because)?;
                ("CurriculumError", source)
            }
            Self::Refused { class, text, cause } => {
                if let Some(cause) = cause {
                    describe(&details, &**cause)?;
                }
                return exception(class, text, &details);
            }
            Self::Python(source) => return Ok(source.clone_ref(py)),
        };
        describe(&details, source)?;
        exception(class, &source.to_string(), &details)
    }
}

/// An exception of one of the package's classes.
fn exception(class: &str, text: &str, details: &Bound<'_, PyDict>) -> PyResult<PyErr> {
    let class = details.py().import("driftworld.errors")?.getattr(class)?;
    // Python prints it as it is.
    let text = printable_lines(text);
    Ok(PyErr::from_value(class.call((text,), Some(details))?))
}

/// Adds what an error of one of the crates knows beside its text.
fn describe(details: &Bound<'_, PyDict>, cause: &(dyn std::error::Error + 'static)) -> PyResult<()> {
    let code = if let Some(source) = cause.downcast_ref::<SpecError>() {
        return of_spec(details, source);
    } else if let Some(source) = cause.downcast_ref::<MetricsError>() {
        return of_metrics(details, source);
    } else if let Some(source) = cause.downcast_ref::<TaskError>() {
        if let TaskError::Spec(source) = source {
            return describe(details, source);
        }
        of_task(source)
    } else if let Some(source) = cause.downcast_ref::<CurriculumError>() {
        if let CurriculumError::Log(source) = source {
            return describe(details, source);
        }
        source.code()
    } else if let Some(DocumentError::Spec(source)) = cause.downcast_ref::<DocumentError>() {
        return describe(details, source);
    } else if let Some(source) = cause.downcast_ref::<GeneratorError>() {
        source.code()
    } else if let Some(source) = cause.downcast_ref::<SimilarityError>() {
        source.code()
    } else if let Some(source) = cause.downcast_ref::<EnvError>() {
        source.code()
    } else {
        return Ok(());
    };
    details.set_item("code", code)
}

fn of_task(source: &TaskError) -> &'static str {
    match source {
        TaskError::Unreadable { .. } => "task/unreadable",
        TaskError::Document(_) => "task/document",
        _ => "task/unknown",
    }
}

fn of_spec(details: &Bound<'_, PyDict>, source: &SpecError) -> PyResult<()> {
    details.set_item("code", source.code())?;
    let py = details.py();
    let problems = source.problems().iter().map(|problem| described(py, problem));
    details.set_item("problems", PyList::new(py, problems.collect::<PyResult<Vec<_>>>()?)?)?;
    if let SpecError::Syntax { line, column, .. } = source {
        details.set_item("line", line)?;
        details.set_item("column", column)?;
    }
    Ok(())
}

fn of_metrics(details: &Bound<'_, PyDict>, source: &MetricsError) -> PyResult<()> {
    details.set_item("code", source.code())?;
    details.set_item("line", source.line())?;
    if let MetricsError::Json { column, .. } = source {
        details.set_item("column", column)?;
    }
    Ok(())
}

/// A problem of a document as a dictionary.
pub(crate) fn described<'py>(py: Python<'py>, problem: &Problem) -> PyResult<Bound<'py, PyDict>> {
    let described = PyDict::new(py);
    described.set_item("code", problem.code)?;
    described.set_item("pointer", &problem.pointer)?;
    // 0 says that the place is not known.
    described.set_item("line", (problem.line > 0).then_some(problem.line))?;
    described.set_item("column", (problem.column > 0).then_some(problem.column))?;
    described.set_item("found", &problem.found)?;
    described.set_item("expected", &problem.expected)?;
    described.set_item("advice", problem.advice.as_deref())?;
    described.set_item("message", problem.to_string())?;
    Ok(described)
}
