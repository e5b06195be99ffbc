//! Task specs as Python objects.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::sync::Arc;

use driftworld::tasks;
use driftworld_spec::{DEFAULT_VARIANT, TaskSpec};
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::document::Whole;
use crate::errors::Result;
use crate::json::{from_python, parsed, to_py};
use crate::rounding::usually_rounded;
use crate::variant::PyVariant;

/// A task: what its worlds have in common, and exactly what varies between them.
///
/// Made by ``TaskSpec.load``, ``TaskSpec.from_json`` or ``TaskSpec.from_dict``. Immutable; equal if the documents have
/// the same content. Can be pickled.
#[pyclass(name = "TaskSpec", module = "driftworld._native", frozen)]
pub(crate) struct PyTask(pub(crate) Arc<TaskSpec>);

#[pymethods]
impl PyTask {
    /// Loads the task with a built-in name, such as ``"find_objects"``, or at a path; ignores a variant after ``#``.
    #[staticmethod]
    fn load(name_or_path: &Bound<'_, PyAny>) -> Result<Self> {
        let name = name_of(name_or_path)?;
        Ok(Self(usually_rounded(|| tasks::task(&name))?))
    }

    /// Reads a task from JSON text; messages refer to the text as ``name``.
    #[staticmethod]
    fn from_json(name: &str, text: &str) -> Result<Self> {
        Ok(Self(usually_rounded(|| TaskSpec::from_json(name, text))?))
    }

    /// Reads a task from a dictionary; messages refer to it as ``name``.
    #[staticmethod]
    #[pyo3(signature = (document, name="task spec"))]
    fn from_dict(document: &Bound<'_, PyDict>, name: &str) -> Result<Self> {
        Self::from_json(name, &from_python(document)?.to_string())
    }

    /// The document as one line of JSON: ``from_json`` reads the same task from it.
    fn to_json(&self) -> String {
        self.0.to_json()
    }

    /// The document as a dictionary.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        parsed(py, &self.0.to_json())
    }

    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    /// The author's description of it.
    #[getter]
    fn description(&self) -> &str {
        self.0.description()
    }

    /// Its parameters by name, each as the document declares it.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(to_py(py, self.0.parameters())?)
    }

    /// The names of its families of variants, which grids and sweeps declare, each with the names of its members.
    #[getter]
    fn families<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyDict>> {
        let families = PyDict::new(py);
        for name in self.0.family_names() {
            families.set_item(name, self.0.family(name).unwrap_or_default())?;
        }
        Ok(families)
    }

    /// A table for notebooks: the changes of each variant.
    fn _repr_html_<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        specs(slf.py(), "_task_html")?.call1((slf,))
    }

    /// The names of the variants that it declares, with families expanded; ``["default"]`` if it declares none.
    fn variant_names(&self) -> Vec<&str> {
        self.0.variant_names()
    }

    /// All variants that it declares, in the order of the document.
    #[getter]
    fn variants(&self) -> Vec<PyVariant> {
        usually_rounded(|| self.0.all_variants())
            .into_iter()
            .map(PyVariant)
            .collect()
    }

    /// One variant; without a name, the one in which every parameter has its default.
    #[pyo3(signature = (name=None))]
    fn variant(&self, name: Option<&str>) -> Result<PyVariant> {
        let name = name.unwrap_or(DEFAULT_VARIANT);
        Ok(PyVariant(usually_rounded(|| self.0.variant(name))?))
    }

    /// World number ``index`` of a variant under a seed, as a dictionary.
    #[pyo3(signature = (variant=None, seed=Whole(0), index=Whole(0)), text_signature = "($self, variant=None, seed=0, index=0)")]
    fn sample<'py>(
        &self,
        py: Python<'py>,
        variant: Option<&str>,
        seed: Whole,
        index: Whole,
    ) -> Result<Bound<'py, PyAny>> {
        self.variant(variant)?.sample(py, seed, index)
    }

    fn __repr__(&self) -> String {
        format!(
            "<TaskSpec {:?} with {} variants>",
            self.0.name(),
            self.0.variant_names().len()
        )
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        other
            .cast::<Self>()
            .is_ok_and(|other| self.0.is_same_as(&other.get().0))
    }

    fn __hash__(&self) -> u64 {
        hash_of(self.0.name())
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String, String))> {
        let again = py.get_type::<Self>().getattr("from_json")?;
        Ok((again, (self.0.name().to_owned(), self.0.to_json())))
    }
}

/// The names of the built-in tasks.
#[pyfunction]
pub(crate) fn built_in_names() -> Vec<&'static str> {
    tasks::built_in_names()
}

/// All tasks that come with Driftworld: each group, and the names of its tasks.
#[pyfunction]
pub(crate) fn task_groups() -> Vec<(&'static str, Vec<&'static str>)> {
    let names = |tasks: &[(&'static str, &str)]| tasks.iter().map(|(name, _)| *name).collect();
    tasks::groups().map(|(group, tasks)| (group, names(tasks))).collect()
}

/// A name, or any kind of Python path.
fn name_of(name_or_path: &Bound<'_, PyAny>) -> PyResult<String> {
    let path = name_or_path
        .py()
        .import("os")?
        .call_method1("fspath", (name_or_path,))?;
    path.extract()
        .map_err(|_| PyTypeError::new_err(format!("found {name_or_path}, expected a name or a path as text")))
}

/// A hash of a string, for Python's `hash`.
pub(crate) fn hash_of(text: &str) -> u64 {
    let mut hasher = DefaultHasher::new();
    text.hash(&mut hasher);
    hasher.finish()
}

/// A function of the package's `specs.py`.
pub(crate) fn specs<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("driftworld.specs")?.getattr(name)
}
