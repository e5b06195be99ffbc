//! Scores of lifetimes, and their report page.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use driftworld::lifetime_report::{ReportRequest, write_report};
use driftworld::scales::ScalesFile;
use driftworld::scoring::{Scores, ScoringChoice, ScoringRequest, ScoringSettings, score};
use driftworld_metrics::{BootstrapOptions, DataRanges, Noise, Scales};
use driftworld_report::{Figure, FigureOptions};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::de::DeserializeOwned;
use serde_json::{Value, json};

use crate::document::to_py;
use crate::errors::{Result, refused};
use crate::interruptible::run_detached;
use crate::json::json_to_py;
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
        Ok(json_to_py(py, &Value::Array(rows))?)
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
    let mut shown = Vec::new();
    for word in options
        .list::<String>("plot_types", "a list of words")?
        .unwrap_or_default()
    {
        let figures = Figure::asked_for(&word);
        shown.extend(figures.map_err(|error| options.refuse(format!("plot_types: {error}")))?);
    }
    let mut request = ReportRequest {
        title: options.text("title")?,
        date: options.text("date")?,
        distances: options.path("distances")?,
        plots: options.path("plots")?,
        studio: options.text("studio")?,
        figure_options: FigureOptions {
            unit: options.word("unit")?.unwrap_or_default(),
            ..FigureOptions::default()
        },
        scoring: scoring(logs, &options)?,
        ..ReportRequest::of::<PathBuf>([])
    };
    if !shown.is_empty() {
        request.figures.retain(|figure| shown.contains(figure));
    }
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
    let usual = BootstrapOptions::default();
    Ok(ScoringRequest {
        logs,
        recursive: options.flag("recursive")?,
        against: options.paths("against")?,
        settings: ScoringSettings {
            choice: ScoringChoice {
                experts: options.paths("ste")?,
                expert_store: options.path("ste_data")?,
                perf_measure: options.text("perf_measure")?,
                variant_mode: options.word("variant_mode")?,
                ste_averaging_method: options.word("ste_averaging_method")?,
                aggregation_method: options.word("aggregation_method")?,
                maintenance_method: options.word("maintenance_method")?,
                transfer_method: options.word("transfer_method")?,
                normalization_method: options.word("normalization_method")?,
                smoothing_method: options.word("smoothing_method")?,
                smooth_eval_data: options.flag("smooth_eval_data")?,
                window_length: options.whole("window_length")?,
                clamp_outliers: options.flag("clamp_outliers")?,
            },
            file: options.path("load_settings")?,
            data_range: data_ranges(options)?,
            scales: scales(options)?,
            noise: noise(options)?,
            strict_definitions: options.flag("strict_definitions")?,
        },
        common_ranges: options.flag("common_ranges")?,
        power: options.number("power")?,
        intervals: BootstrapOptions {
            confidence: options.number("confidence")?.unwrap_or(usual.confidence),
            resamples: options.whole("resamples")?.unwrap_or(usual.resamples),
            resampling: options.word("resampling")?.unwrap_or(usual.resampling),
            seed: options.whole("bootstrap_seed")?.unwrap_or(usual.seed),
        },
    })
}

/// The reward ranges of tasks: a dictionary for each, by lower-cased names as in the metrics.
fn data_ranges(options: &Options<'_>) -> Result<Option<DataRanges>> {
    let expected = r#"a range for each task, such as {"find_red": {"min": 0, "max": 10}}"#;
    let given = options.json("data_range")?;
    given
        .map(|tasks| by_task(options, "data_range", tasks, expected))
        .transpose()
}

/// Floors and ceilings of tasks: the path of a file, or a dictionary for each, by lower-cased names.
fn scales(options: &Options<'_>) -> Result<Option<Scales>> {
    let expected = r#"a file, or floor and ceiling for each task, such as {"find_red": {"floor": 0, "ceiling": 10}}"#;
    match options.json("scales")? {
        None => Ok(None),
        Some(Value::String(path)) => {
            let read = ScalesFile::read(path.as_ref()).map_err(|failure| refused(REFUSED, &failure))?;
            Ok(Some(read.anchors()))
        }
        Some(tasks) => by_task(options, "scales", tasks, expected).map(Some),
    }
}

/// A value for each task, by its lower-cased name.
fn by_task<T: DeserializeOwned, M: FromIterator<(String, T)>>(
    options: &Options<'_>,
    option: &str,
    tasks: Value,
    expected: &str,
) -> Result<M> {
    let Value::Object(tasks) = tasks else {
        return Err(options.wrong(option, tasks, expected));
    };
    let read = |(task, value): (String, Value)| {
        let read = serde_json::from_value(value);
        let read = read.map_err(|error| options.refuse(format!("{option}, {task:?}: {error}; expected {expected}")))?;
        Ok((task.to_lowercase(), read))
    };
    tasks.into_iter().map(read).collect()
}

fn noise(options: &Options<'_>) -> Result<Option<Noise>> {
    let expected = "mean and standard deviation, such as (0, 0.1)";
    let seed = options.whole("noise_seed")?;
    match options.list::<f64>("noise", expected)?.as_deref() {
        None if seed.is_some() => {
            Err(options.refuse("options: found no noise, expected it beside noise_seed".to_owned()))
        }
        None => Ok(None),
        Some([mean, std]) => Ok(Some(Noise {
            mean: *mean,
            std: *std,
            seed: seed.unwrap_or(0),
        })),
        Some(found) => Err(options.wrong("noise", format!("{} numbers", found.len()), expected)),
    }
}
