//! [`PyDrift`]: the variants between two variants.

use driftworld_generator::Drift;
use driftworld_spec::{DriftSchedule, RegimeDrift};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::document::Whole;
use crate::errors::Result;
use crate::json::from_python;
use crate::rounding::usually_rounded;
use crate::task::specs;
use crate::variant::PyVariant;

/// The path from one variant of a task to another: ``Drift(blue, dusk, schedule="cosine").at(0.25)``.
///
/// ``schedule`` is ``"linear"``, ``"cosine"``, ``{"steps": n}`` or ``{"sawtooth": n}``; ``switch`` says when values that cannot
/// be interpolated change: at a fixed progress with ``"at_point"``; at random with ``"mixture"``, drawn with ``seed``, more
/// likely as the drift goes on. With ``"task"`` the whole variant is one of the two at random; they may belong to different
/// tasks.
#[pyclass(name = "Drift", module = "driftworld._native", frozen)]
pub(crate) struct PyDrift {
    drift: Drift,
    made: Made,
}

/// The arguments of a drift: both ends, schedule (as JSON), switch and seed.
type Made = (PyVariant, PyVariant, Option<String>, String, u64);

#[pymethods]
impl PyDrift {
    #[new]
    #[pyo3(
        signature = (from_, to, *, schedule=None, switch="at_point", seed=Whole(0)),
        text_signature = "(from_, to, *, schedule=None, switch='at_point', seed=0)"
    )]
    fn new(
        from_: &Bound<'_, PyVariant>,
        to: &Bound<'_, PyVariant>,
        schedule: Option<&Bound<'_, PyAny>>,
        switch: &str,
        seed: Whole,
    ) -> Result<Self> {
        let wrong = |option: &str, found: &str, expected: &str| {
            PyValueError::new_err(format!("drift, {option}: found {found}, expected {expected}"))
        };
        let mut written = None;
        let schedule = match schedule {
            None => DriftSchedule::default(),
            Some(said) => {
                let json = from_python(said)?;
                written = Some(json.to_string());
                let sound = serde_json::from_value(json.clone())
                    .ok()
                    .filter(|schedule| !matches!(schedule, DriftSchedule::Steps(0) | DriftSchedule::Sawtooth(0)));
                sound.ok_or_else(|| {
                    let expected = "\"linear\", \"cosine\", {\"steps\": n} or {\"sawtooth\": n} with n at least 1";
                    wrong("schedule", &json.to_string(), expected)
                })?
            }
        };
        let (from, end) = (from_.get().0.clone(), to.get().0.clone());
        let declared = RegimeDrift {
            schedule,
            switch: serde_json::from_value(switch.into()).map_err(|_| {
                let expected = "\"at_point\", \"mixture\" or \"task\"";
                wrong("switch", &format!("{switch:?}"), expected)
            })?,
            ..RegimeDrift::to("")
        };
        Ok(Self {
            drift: usually_rounded(|| Drift::declared(&declared, from, end, seed.0))?,
            made: (
                from_.get().clone(),
                to.get().clone(),
                written,
                switch.to_owned(),
                seed.0,
            ),
        })
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Made)> {
        let again = specs(py, "_drift_again")?;
        Ok((again, self.made.clone()))
    }

    /// The variant at ``progress``, 0..=1; ``index`` is the number of the world, used only with ``"mixture"`` and ``"task"``.
    #[pyo3(signature = (progress, index=Whole(0)), text_signature = "($self, progress, index=0)")]
    fn at(&self, progress: f64, index: Whole) -> Result<PyVariant> {
        if !(0.0..=1.0).contains(&progress) {
            let message = format!("drift, progress: found {progress}, expected a number in 0..1");
            return Err(PyValueError::new_err(message).into());
        }
        Ok(PyVariant(usually_rounded(|| self.drift.at(progress, index.0))?))
    }
}
