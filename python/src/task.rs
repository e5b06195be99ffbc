//! Task specs and their variants, as Python holds them. What they say is `spec`'s, drawing their worlds is `generator`'s.

use std::sync::Arc;

use driftworld::tasks;
use driftworld_spec::{DEFAULT_VARIANT, TaskSpec, Variant};
use pyo3::prelude::*;

use crate::errors::Result;

/// A task spec.
#[pyclass(name = "TaskSpec", module = "driftworld._native", frozen)]
pub(crate) struct PyTask(pub(crate) Arc<TaskSpec>);

/// A variant of a task.
#[pyclass(name = "Variant", module = "driftworld._native", frozen)]
#[derive(Clone)]
pub(crate) struct PyVariant(pub(crate) Variant);

#[pymethods]
impl PyTask {
    /// The task of a built-in name or a path; a variant behind `#` is left aside.
    #[staticmethod]
    fn load(name: &str) -> Result<Self> {
        Ok(Self(tasks::task(name)?))
    }

    /// The task that a text says; `name` is what messages call it.
    #[staticmethod]
    fn from_json(name: &str, text: &str) -> Result<Self> {
        Ok(Self(TaskSpec::from_json(name, text)?))
    }

    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    #[getter]
    fn description(&self) -> &str {
        self.0.description()
    }

    /// The names of the variants that it declares.
    fn variant_names(&self) -> Vec<&str> {
        self.0.variant_names()
    }

    /// Every variant that it declares.
    fn all_variants(&self) -> Vec<PyVariant> {
        self.0.all_variants().into_iter().map(PyVariant).collect()
    }

    /// One variant; without a name the one in which every parameter has its default.
    #[pyo3(signature = (name=None))]
    fn variant(&self, name: Option<&str>) -> Result<PyVariant> {
        Ok(PyVariant(self.0.variant(name.unwrap_or(DEFAULT_VARIANT))?))
    }
}

#[pymethods]
impl PyVariant {
    /// `task#variant`.
    #[getter]
    fn id(&self) -> String {
        self.0.id()
    }

    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    /// A hash of all that its worlds are made from.
    #[getter]
    fn hash(&self) -> String {
        self.0.hash()
    }

    /// The task that it is a variant of.
    #[getter]
    fn task(&self) -> PyTask {
        PyTask(Arc::clone(self.0.task()))
    }

    /// The JSON of world number `index` under a seed.
    fn sample(&self, py: Python<'_>, seed: u64, index: u64) -> Result<String> {
        Ok(py
            .detach(|| driftworld_generator::sample(&self.0, seed, index))?
            .to_json())
    }
}
