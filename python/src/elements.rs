//! Elements of the decision process that variants change.

use driftworld::elements::{ElementsRequest, elements_of};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{Result, refused};
use crate::interruptible::run_detached;
use crate::json::to_py;
use crate::options::Options;
use crate::task::PyTask;

const REFUSED: &str = "TaskError";

/// The elements that variants of a task declare to change, and those that were measured to change: the JSON of
/// `driftworld elements --json` as a dictionary.
#[pyfunction]
pub(crate) fn elements<'py>(
    py: Python<'py>,
    task: Bound<'py, PyTask>,
    options: Bound<'py, PyDict>,
) -> Result<Bound<'py, PyAny>> {
    let task = task.get().0.clone();
    let request = ElementsRequest {
        task: task.name().to_owned(),
        ..Options::new(options, REFUSED).request()?
    };
    let found = run_detached(py, move || elements_of(&task, &request))?;
    Ok(to_py(py, &found.map_err(|failure| refused(REFUSED, &failure))?)?)
}
