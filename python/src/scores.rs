//! Scores of lifetimes, and their report page.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use driftworld::lifetime_report::{ReportRequest, write_report};
use driftworld::scoring::{Scores, ScoringRequest, score};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::{Value, json};

use crate::errors::{Result, refused};
use crate::interruptible::run_detached;
use crate::json::to_py;
use crate::options::Options;
use crate::rounding::detach;

const REFUSED: &str = "MetricsError";

/// The scores of lifetimes.
#[pyclass(name = "Scores", module = "driftworld._native", frozen)]
pub(crate) struct PyScores(Scores);

#[pymethods]
impl PyScores {
    /// Scores logs with the options of `driftworld.metrics`; returns warnings as well.
    #[staticmethod]
    fn of(py: Python<'_>, logs: Vec<PathBuf>, options: Bound<'_, PyDict>) -> Result<(Self, Vec<String>)> {
        let request = scoring(logs, &Options::new(options, REFUSED))?;
        let (scores, warnings) = run_detached(py, move || warned(|warn| score(&request, warn)))?;
        let scores = scores.map_err(|failure| refused(REFUSED, &failure))?;
        Ok((Self(scores), warnings))
    }

    /// All results, as in ``driftworld metrics --json``.
    fn values<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(to_py(py, &self.0)?)
    }

    /// The regimes of all lifetimes, one dictionary each.
    fn regimes<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let mut rows = Vec::new();
        for lifetime in &self.0.lifetimes {
            for regime in &lifetime.regimes {
                let mut row = json!({
                    "run_id": lifetime.run_id, "block_num": regime.block_num, "block_type": regime.block_type.name(),
                    "block_subtype": regime.block_subtype.name(), "task_name": regime.task_name,
                    "regime_num": regime.regime_num, "task_params": regime.task_params,
                });
                for (name, value) in regime.values.iter() {
                    row[name] = json!(value);
                }
                rows.push(row);
            }
        }
        Ok(to_py(py, &Value::Array(rows))?)
    }

    /// Saves the results as ``driftworld metrics --do-save`` does.
    fn save(&self, py: Python<'_>, folder: PathBuf, name: Option<&str>) -> Result<()> {
        detach(py, || self.0.save(&folder, name)).map_err(|failure| refused(REFUSED, &failure))?;
        Ok(())
    }
}

/// The report page of lifetimes, and warnings.
#[pyfunction]
pub(crate) fn report(py: Python<'_>, logs: Vec<PathBuf>, options: Bound<'_, PyDict>) -> Result<(String, Vec<String>)> {
    let options = Options::new(options, REFUSED);
    let request = ReportRequest {
        figures: options.request()?,
        scoring: scoring(logs, &options)?,
        ..options.request()?
    };
    let (page, warnings) = run_detached(py, move || warned(|warn| write_report(&request, warn)))?;
    let page = page.map_err(|failure| refused(REFUSED, &failure))?;
    Ok((page.html, warnings))
}

/// Runs work and collects its warnings.
fn warned<T>(work: impl FnOnce(&(dyn Fn(String) + Sync)) -> T) -> (T, Vec<String>) {
    let warnings = Mutex::new(Vec::new());
    // A push is atomic with respect to panics, so the list is valid.
    let done = work(&|text| warnings.lock().unwrap_or_else(PoisonError::into_inner).push(text));
    (done, warnings.into_inner().unwrap_or_else(PoisonError::into_inner))
}

fn scoring(logs: Vec<PathBuf>, options: &Options<'_>) -> Result<ScoringRequest> {
    Ok(ScoringRequest {
        logs,
        settings: options.request()?,
        intervals: options.request()?,
        ..options.request()?
    })
}
