//! Variants as Python objects.

use std::sync::Arc;

use driftworld::tasks;
use driftworld_generator::{Subject, at_distance};
use driftworld_similarity::{VariantMeasure, Weights};
use driftworld_spec::{DEFAULT_VARIANT, Value, Variant, World};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::distances::element;
use crate::document::Whole;
use crate::errors::{Result, wrong};
use crate::interruptible::run_detached;
use crate::json::{from_python, parsed, to_py};
use crate::portions::{draw, numbers};
use crate::rounding::{detach, usually_rounded};
use crate::task::{PyTask, hash_of, specs};

/// One variant of a task, in which every parameter that is not drawn for each world has a fixed value.
///
/// Immutable; equal if worlds and distances are the same. Can be pickled.
#[pyclass(name = "Variant", module = "driftworld._native", frozen)]
#[derive(Clone)]
pub(crate) struct PyVariant(pub(crate) Variant);

#[pymethods]
impl PyVariant {
    /// ``task#variant``.
    #[getter]
    fn id(&self) -> String {
        self.0.id()
    }

    /// Its name within the task.
    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    /// The task that it is a variant of.
    #[getter]
    fn task(&self) -> PyTask {
        PyTask(Arc::clone(self.0.task()))
    }

    /// A table for notebooks: its values, those that differ from the task's defaults first.
    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        specs(slf.py(), "_variant_html")?.call1((slf,))
    }

    /// The author's description of it, if any.
    #[getter]
    fn description(&self) -> Option<&str> {
        self.0.task().variant_description(self.0.name())
    }

    /// The values of all parameters that are the same in every world, by name.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(to_py(py, self.0.values())?)
    }

    /// A hash of everything that determines its worlds and distances: 64 hexadecimal digits.
    #[getter]
    fn hash(&self) -> String {
        self.0.hash()
    }

    /// A copy of this variant with a new name and different values of some parameters: ``with_values("dim", light=0.5)``.
    #[pyo3(signature = (name, /, **changes))]
    fn with_values(&self, name: &str, changes: Option<&Bound<'_, PyDict>>) -> Result<Self> {
        let mut values: Vec<(String, Value)> = Vec::new();
        for (parameter, value) in changes.into_iter().flatten() {
            let parameter: String = parameter.extract()?;
            let value = value_of(&parameter, &value)?;
            values.push((parameter, value));
        }
        sound_name(name)?;
        Ok(Self(usually_rounded(|| self.0.with(name, values))?))
    }

    /// Finds a variant at a given distance, 0 or more, from this one, changing as few parameters as possible. ``subject``
    /// limits what may change: an element of the decision process (``"reward"`` or ``"R"``; the distance is the one in this element), or a
    /// list of parameters (the distance is the total). Returns the variant and its distance.
    #[pyo3(signature = (distance, subject, *, tolerance=1e-3, name="found"))]
    fn at_distance(
        &self,
        py: Python<'_>,
        distance: f64,
        subject: &Bound<'_, PyAny>,
        tolerance: f64,
        name: &str,
    ) -> Result<(Self, f64)> {
        for (option, number) in [("distance", distance), ("tolerance", tolerance)] {
            if !(number.is_finite() && number >= 0.0) {
                let message = format!("{option}: found {number}, expected a finite number, 0 or more");
                return Err(PyValueError::new_err(message).into());
            }
        }
        sound_name(name)?;
        let (subject, element) = match subject.extract::<String>() {
            Ok(word) => {
                let element = element(&word)?;
                (Subject::Element(element), Some(element))
            }
            Err(_) => (Subject::Parameters(subject.extract()?), None),
        };
        let from = self.0.clone();
        let found = run_detached(py, move || {
            let measured = VariantMeasure::new(from.task(), Weights::of_task(from.task()));
            let measure = |other: &Variant| {
                // Unbounded distributions have no finite distance, so they count as farther than any requested distance.
                let distance = measured.between(&from, other);
                distance.map_or(f64::INFINITY, |distance| distance.within(element))
            };
            at_distance(&from, &subject, distance, tolerance, measure)
        })??;
        Ok((Self(found.variant.with(name, [])?), found.distance))
    }

    /// World number ``index`` under a seed, as a dictionary.
    #[pyo3(signature = (seed=Whole(0), index=Whole(0)), text_signature = "($self, seed=0, index=0)")]
    pub(crate) fn sample<'py>(&self, py: Python<'py>, seed: Whole, index: Whole) -> Result<Bound<'py, PyAny>> {
        Ok(parsed(py, &self.sample_json(py, seed, index)?)?)
    }

    /// Like ``sample``, as one line of JSON.
    #[pyo3(signature = (seed=Whole(0), index=Whole(0)), text_signature = "($self, seed=0, index=0)")]
    fn sample_json(&self, py: Python<'_>, seed: Whole, index: Whole) -> Result<String> {
        let world = detach(py, || driftworld_generator::sample(&self.0, seed.0, index.0))?;
        Ok(world.to_json())
    }

    /// ``count`` worlds, starting at number ``start``, as dictionaries, drawn by ``threads`` threads; 0 means one per processor.
    #[pyo3(
        signature = (count, *, seed=Whole(0), start=Whole(0), threads=Whole(0)),
        text_signature = "($self, count, *, seed=0, start=0, threads=0)"
    )]
    fn sample_many<'py>(
        &self,
        py: Python<'py>,
        count: Whole,
        seed: Whole,
        start: Whole,
        threads: Whole,
    ) -> Result<Bound<'py, PyList>> {
        self.many(py, [seed, start, count, threads], |text| parsed(py, &text))
    }

    /// Like ``sample_many``, each world as one line of JSON.
    #[pyo3(
        signature = (count, *, seed=Whole(0), start=Whole(0), threads=Whole(0)),
        text_signature = "($self, count, *, seed=0, start=0, threads=0)"
    )]
    fn sample_many_json<'py>(
        &self,
        py: Python<'py>,
        count: Whole,
        seed: Whole,
        start: Whole,
        threads: Whole,
    ) -> Result<Bound<'py, PyList>> {
        self.many(py, [seed, start, count, threads], |text| {
            Ok(text.into_pyobject(py)?.into_any())
        })
    }

    /// Draws the first ``count`` worlds under a seed, and reports the number of failures and their reasons.
    #[pyo3(signature = (count, *, seed=Whole(0)), text_signature = "($self, count, *, seed=0)")]
    fn try_worlds<'py>(&self, py: Python<'py>, count: Whole, seed: Whole) -> Result<Bound<'py, PyAny>> {
        let trial = detach(py, || driftworld_curriculum::try_worlds(&self.0, seed.0, count.0));
        Ok(to_py(py, &trial)?)
    }

    fn __repr__(&self) -> String {
        format!("<Variant {:?}>", self.0.id())
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other.cast::<Self>().is_ok_and(|other| {
            let other = &other.get().0;
            self.0.name() == other.name()
                && self.0.values() == other.values()
                && (self.0.task().is_same_as(other.task()) || self.0.hash() == other.hash())
        })
    }

    fn __hash__(&self) -> u64 {
        hash_of(&self.0.id())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (PyTask, String, String))> {
        let again = py.get_type::<Self>().getattr("_again")?;
        let values = serde_json::to_string(self.0.values()).map_err(wrong)?;
        Ok((again, (self.task(), self.0.name().to_owned(), values)))
    }

    /// Recreates a variant in another process.
    #[staticmethod]
    #[pyo3(name = "_again")]
    fn again(task: &Bound<'_, PyTask>, name: &str, values: &str) -> Result<Self> {
        let task = &task.get().0;
        let wanted: indexmap::IndexMap<String, Value> = serde_json::from_str(values).map_err(wrong)?;
        if let Ok(declared) = task.variant(name)
            && *declared.values() == wanted
        {
            return Ok(Self(declared));
        }
        // Values that equal the base variant's are not set again: some values cannot be set.
        let mut bases = usually_rounded(|| task.all_variants());
        bases.extend(task.variant(DEFAULT_VARIANT));
        let mut refused = None;
        for base in bases {
            let changes = wanted.iter().filter(|(name, value)| base.value(name) != Some(*value));
            match base.with(name, changes.map(|(name, value)| (name.clone(), value.clone()))) {
                Ok(variant) => return Ok(Self(variant)),
                Err(error) => refused = Some(error),
            }
        }
        Err(refused.map_or_else(|| wrong("the task has no variant").into(), Into::into))
    }
}

impl PyVariant {
    /// A list of worlds, each converted from its JSON by `hand_over` for Python.
    fn many<'py>(
        &self,
        py: Python<'py>,
        [seed, start, count, threads]: [Whole; 4],
        hand_over: impl Fn(String) -> PyResult<Bound<'py, PyAny>>,
    ) -> Result<Bound<'py, PyList>> {
        let (drawn, numbers) = (PyList::empty(py), numbers(start.0, count.0)?);
        let text = |world: World| world.to_json();
        draw(py, &self.0, seed.0, numbers, threads.0, text, |text| {
            drawn.append(hand_over(text)?)
        })?;
        Ok(drawn)
    }
}

/// A variant by its name: built in, or a path; with `#` before the variant's own name.
#[pyfunction]
pub(crate) fn load_variant(name: &str) -> Result<PyVariant> {
    Ok(PyVariant(usually_rounded(|| tasks::variant(name))?))
}

/// The variants that a name stands for: one, a family, or all of a task.
#[pyfunction]
pub(crate) fn load_variants(name: &str) -> Result<Vec<PyVariant>> {
    Ok(usually_rounded(|| tasks::variants(name))?
        .into_iter()
        .map(PyVariant)
        .collect())
}

/// Converts a value of a parameter, as written in a task spec.
fn value_of(parameter: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    let expected =
        "expected a value as in a task spec: a finite number, a string, True or False, a list or a dictionary";
    let wrong = || format!("{parameter}: found {value}, {expected}");
    let json = from_python(value).map_err(|error| {
        if error.is_instance_of::<PyTypeError>(value.py()) {
            PyTypeError::new_err(wrong())
        } else {
            PyValueError::new_err(wrong())
        }
    })?;
    serde_json::from_value(json).map_err(|_| PyValueError::new_err(wrong()))
}

/// Checks the name of a new variant, which follows the `#` in its id.
fn sound_name(name: &str) -> PyResult<()> {
    if name.is_empty() || name.contains('#') {
        let message = format!("name: found {name:?}, expected a variant's name of at least one letter, without #");
        return Err(PyValueError::new_err(message));
    }
    Ok(())
}
