//! Designs curricula from names of tasks.

use std::path::PathBuf;

use driftworld::design::{self, DesignRequest};
use driftworld_spec::Scenario;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::errors::{Result, refused};
use crate::interruptible::run_detached;
use crate::options::Options;

const REFUSED: &str = "CurriculumError";

/// Scenarios, by name and text: the designed ones, and their controls.
type Texts = (Vec<(String, String)>, Vec<(String, String)>);

/// Designs scenarios with the options of `Curriculum.design`, or their experts if requested; plots the blocks if a file is given
/// for that.
#[pyfunction]
pub(crate) fn design_curriculum(py: Python<'_>, options: Bound<'_, PyDict>, plot: Option<PathBuf>) -> Result<Texts> {
    let options = Options::new(options, REFUSED);
    let request = DesignRequest {
        ordering: options.request()?,
        ..options.request()?
    };
    if request.is_of_several() && plot.is_some() {
        return Err(
            options.refuse("plot: found it for several scenarios, expected it for one; leave it out".to_owned())
        );
    }
    let experts = request.experts;
    let designed = run_detached(py, move || {
        let designed = design::design(&request)?;
        if let Some(path) = plot {
            designed.write_plot(&path)?;
        }
        Ok(designed)
    })?;
    let designed = designed.map_err(|failure| refused(REFUSED, &failure))?;
    let texts = |scenarios: Vec<Scenario>| {
        let text = |scenario: Scenario| (scenario.name.clone(), scenario.to_json_pretty());
        scenarios.into_iter().map(text).collect()
    };
    let scenarios = if experts { designed.experts } else { designed.scenarios };
    Ok((texts(scenarios), texts(designed.controls)))
}
