//! Elements of the decision process that variants change.

use driftworld::elements::{ElementsRequest, elements_of};
use driftworld_spec::Modality;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::document::to_py;
use crate::errors::{Result, refused};
use crate::interruptible::run_detached;
use crate::options::Options;
use crate::task::PyTask;

const REFUSED: &str = "TaskError";

/// The elements that variants of a task claim to change and those that were found to change: the JSON of
/// `driftworld elements --json` as a dictionary.
#[pyfunction]
pub(crate) fn elements<'py>(
    py: Python<'py>,
    task: Bound<'py, PyTask>,
    options: Bound<'py, PyDict>,
) -> Result<Bound<'py, PyAny>> {
    let options = Options::new(options, REFUSED);
    let task = task.get().0.clone();
    let usual = ElementsRequest::of(task.name());
    let variants: Option<Vec<String>> = options.list("between", "two names of variants")?;
    let between = variants.map(<[String; 2]>::try_from).transpose();
    let Ok(between) = between else {
        return Err(options.refuse("between: found other than two variants, expected two".to_owned()));
    };
    let modality = |word: String| -> Result<Modality> {
        serde_json::from_value(word.into()).map_err(|error| options.refuse(format!("modalities: {error}")))
    };
    let words: Option<Vec<String>> = options.list("modalities", "a list of kinds of images, such as [\"rgb\"]")?;
    let modalities: Option<Result<_>> = words.map(|words| words.into_iter().map(modality).collect());
    let request = ElementsRequest {
        between,
        modalities: modalities.transpose()?,
        worlds: options.whole("worlds")?.unwrap_or(usual.worlds),
        seed: options.whole("seed")?.unwrap_or(usual.seed),
        steps: options.whole("steps")?.unwrap_or(usual.steps),
        libraries: options.path("assets")?.into_iter().collect(),
        ..usual
    };
    let found = run_detached(py, move || elements_of(&task, &request))?;
    Ok(to_py(py, &found.map_err(|failure| refused(REFUSED, &failure))?)?)
}
