//! Writes, reads and checks logs of lifetimes.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError};

use driftworld::clock::Clock;
use driftworld_curriculum::Recordings;
use driftworld_metrics::{
    BlockType, LogWriter, LoggerInfo, Record, Rows, ScenarioInfo, SharedColumn, TaskParams, Timestamp,
};
use numpy::{PyArray1, ToPyArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use serde_json::{Map, Value, json};

use crate::document::Whole;
use crate::errors::{Result, wrong};
use crate::json::{from_python, to_py};
use crate::recordings::PyRecording;
use crate::rounding::detach;

/// An open log. Threads take turns writing to it.
#[pyclass(name = "LogFile", module = "driftworld._native", frozen)]
pub(crate) struct PyLogFile(Mutex<Option<OpenLog>>);

/// A log with the recordings of its rows.
struct OpenLog {
    writer: LogWriter,
    recordings: Recordings,
}

impl OpenLog {
    fn new(writer: LogWriter) -> Self {
        let recordings = Recordings::new(writer.dir());
        Self { writer, recordings }
    }
}

#[pymethods]
impl PyLogFile {
    /// Creates a log in a new or empty folder.
    #[staticmethod]
    fn create(folder: PathBuf, columns: Vec<String>, info: &Bound<'_, PyAny>) -> Result<Self> {
        let info = scenario_info(from_python(info)?)?;
        let writer = LogWriter::create(folder, &LoggerInfo::new(columns)?, &info)?;
        Ok(Self(Mutex::new(Some(OpenLog::new(writer)))))
    }

    /// Resumes a log.
    #[staticmethod]
    fn resume(folder: PathBuf) -> Result<Self> {
        Ok(Self(Mutex::new(Some(OpenLog::new(LogWriter::resume(folder)?)))))
    }

    /// Writes one row and flushes it, preceded by the recording of its experience, if given. Uses the current time.
    #[pyo3(signature = (
        block_num, exp_num, block_type, block_subtype, task_name, task_params, exp_status, worker_id, metrics, recording=None
    ))]
    #[expect(
        clippy::too_many_arguments,
        reason = "a row has these cells; called from one place, by name"
    )]
    fn write(
        &self,
        block_num: Whole,
        exp_num: Whole,
        block_type: &str,
        block_subtype: &str,
        task_name: &str,
        task_params: &Bound<'_, PyAny>,
        exp_status: &str,
        worker_id: &str,
        metrics: BTreeMap<String, f64>,
        recording: Option<&Bound<'_, PyRecording>>,
    ) -> Result<()> {
        let params = match from_python(task_params)? {
            Value::Object(params) => params,
            other => {
                let message = format!("task_params: found {other}, expected a dictionary");
                return Err(PyValueError::new_err(message).into());
            }
        };
        let record = Record {
            block_subtype: block_subtype.parse()?,
            exp_status: exp_status.parse()?,
            metrics: metrics.into_iter().collect(),
            ..Record::new(
                block_num.0,
                exp_num.0,
                block_type.parse::<BlockType>()?,
                task_name,
                now()?,
            )
            .with_task_params(TaskParams::new(params))
            .with_worker(worker_id)
        };
        // Locked only while holding the GIL, and unlocked before the GIL is released, so that no thread waits for the
        // lock while holding the GIL.
        let mut writer = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let log = writer.as_mut().ok_or_else(|| {
            PyValueError::new_err("log: found it closed, expected an open one; begin another, or resume it")
        })?;
        if let Some(recording) = recording {
            // Written before the row, so that an interruption never leaves a row without its recording.
            let recording = recording.get().of_row(&record);
            log.recordings
                .append(&record.worker_id, (record.block_num, record.block_type), &recording)?;
        }
        Ok(log.writer.write(&record)?)
    }

    /// Closes the log and syncs it to disk. A second call does nothing.
    fn close(&self) -> Result<()> {
        let log = self.0.lock().unwrap_or_else(PoisonError::into_inner).take();
        let Some(mut log) = log else { return Ok(()) };
        let synced = log.recordings.sync();
        log.writer.finish()?;
        Ok(synced?)
    }
}

/// Name, columns, the two info files, warnings.
type ReadLog<'py> = (
    String,
    Bound<'py, PyDict>,
    Bound<'py, PyAny>,
    Bound<'py, PyAny>,
    Vec<String>,
);

/// Reads a log: its name, its columns by name, its two info files, its warnings.
#[pyfunction]
pub(crate) fn read_log(py: Python<'_>, folder: PathBuf, texts: bool) -> Result<ReadLog<'_>> {
    let log = detach(py, || {
        if texts {
            driftworld_metrics::read_log_with_texts(&folder)
        } else {
            driftworld_metrics::read_log(&folder)
        }
    })?;
    let columns = columns(py, &log.rows)?;
    let logger = json!({
        "metrics_columns": log.logger_info.metrics_columns(), "log_format_version": log.logger_info.log_format_version(),
    });
    let warnings = log.warnings.iter().map(ToString::to_string).collect();
    Ok((
        log.run_id,
        columns,
        to_py(py, &logger)?,
        to_py(py, &log.scenario_info)?,
        warnings,
    ))
}

/// Checks a log: whether it is valid, problems as pairs of code and message, number of further problems, warnings, number of
/// further warnings, counts.
#[pyfunction]
pub(crate) fn validate_log(py: Python<'_>, folder: PathBuf) -> Result<Bound<'_, PyAny>> {
    let found = detach(py, || driftworld_metrics::validate_log(&folder));
    let problems = found.problems.iter();
    let problems: Vec<Value> = problems
        .map(|problem| json!({ "code": problem.code(), "message": problem.to_string() }))
        .collect();
    let counts = &found.counts;
    let said = json!({
        "valid": found.is_valid(), "problems": problems, "more_problems": found.more_problems,
        "warnings": found.warnings.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "more_warnings": found.more_warnings, "rows": counts.rows, "complete_rows": counts.complete_rows,
        "experiences": counts.experiences, "files": counts.files, "workers": counts.workers, "blocks": counts.blocks,
        "tasks": counts.tasks,
    });
    Ok(to_py(py, &said)?)
}

/// The current time, to the microsecond, or the one in `DRIFTWORLD_CLOCK`.
fn now() -> PyResult<Timestamp> {
    Ok(Clock::from_environment().map_err(wrong)?.now())
}

fn scenario_info(said: Value) -> Result<ScenarioInfo> {
    let Value::Object(mut extra) = said else {
        let message = format!("scenario_info: found {said}, expected a dictionary");
        return Err(PyValueError::new_err(message).into());
    };
    let mut word = |key: &str| match extra.shift_remove(key) {
        None | Some(Value::Null) => Ok(None),
        Some(Value::String(word)) => Ok(Some(word)),
        Some(other) => Err(PyValueError::new_err(format!(
            "scenario_info, {key}: found {other}, expected a word of the format; store anything else under another key"
        ))),
    };
    let (complexity, difficulty, form) = (word("complexity")?, word("difficulty")?, word("scenario_type")?);
    Ok(ScenarioInfo {
        complexity: complexity.map(|word| word.parse()).transpose()?,
        difficulty: difficulty.map(|word| word.parse()).transpose()?,
        scenario_type: form.map(|word| word.parse()).transpose()?,
        extra,
    })
}

/// The columns of a log: numbers as arrays, strings as lists.
fn columns<'py>(py: Python<'py>, rows: &Rows) -> Result<Bound<'py, PyDict>> {
    let columns = PyDict::new(py);
    columns.set_item("block_num", rows.block_nums().to_pyarray(py))?;
    columns.set_item("exp_num", rows.exp_nums().to_pyarray(py))?;
    let text = |text: &String| Ok(text.into_pyobject(py)?.into_any());
    columns.set_item("worker_id", shared(py, rows.workers(), text)?)?;
    columns.set_item("block_type", words(py, rows.block_types())?)?;
    columns.set_item("block_subtype", words(py, rows.block_subtypes())?)?;
    columns.set_item("task_name", shared(py, rows.task_names(), text)?)?;
    let params = |params: &TaskParams| to_py(py, &Value::Object(Map::clone(&Arc::clone(params))));
    columns.set_item("task_params", shared(py, rows.task_params(), params)?)?;
    columns.set_item("exp_status", words(py, rows.exp_statuses())?)?;
    let micros = rows.timestamps().iter().map(|stamp| stamp.unix_micros());
    columns.set_item("timestamp", PyArray1::from_iter(py, micros))?;
    for name in rows.metric_names() {
        columns.set_item(name, rows.metric(name).unwrap_or_default().to_pyarray(py))?;
    }
    for name in rows.text_names() {
        if let Some(column) = rows.text(name) {
            columns.set_item(name, shared(py, column, text)?)?;
        }
    }
    Ok(columns)
}

/// Converts a column whose values are repeated in many rows: each is converted once.
fn shared<'py, T>(
    py: Python<'py>,
    column: &SharedColumn<T>,
    make: impl Fn(&T) -> PyResult<Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyList>> {
    let values = column.values().iter().map(make).collect::<PyResult<Vec<_>>>()?;
    PyList::new(py, column.ids().iter().map(|id| &values[*id as usize]))
}

fn words<'py>(py: Python<'py>, column: &[impl ToString]) -> PyResult<Bound<'py, PyList>> {
    PyList::new(py, column.iter().map(ToString::to_string))
}
