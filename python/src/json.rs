//! Converts between JSON and Python values.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value;

use crate::rounding::usually_rounded;

/// Converts any serialisable value to Python.
pub(crate) fn to_py<'py>(py: Python<'py>, value: &impl serde::Serialize) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(value).map_err(|error| PyValueError::new_err(error.to_string()))?;
    parsed(py, &text)
}

/// Parses our JSON with Python's own parser, but independently of the calling thread's rounding mode.
#[pyfunction]
pub(crate) fn parsed<'py>(py: Python<'py>, text: &str) -> PyResult<Bound<'py, PyAny>> {
    usually_rounded(|| py.import("json")?.call_method1("loads", (text,)))
}

/// Converts a Python value, including `NumPy` numbers, to JSON.
pub(crate) fn from_python(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    let py = value.py();
    let options = PyDict::new(py);
    options.set_item("default", py.import("driftworld._plain")?.getattr("plain")?)?;
    let text = py.import("json")?.call_method("dumps", (value,), Some(&options))?;
    let text: String = text.extract()?;
    let value = usually_rounded(|| serde_json::from_str(&text));
    value.map_err(|error| PyValueError::new_err(format!("found {text}: {error}")))
}
