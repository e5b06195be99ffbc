//! Task specs and their variants, as Python holds them. What they say is `spec`'s, drawing their worlds is `generator`'s.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use driftworld::tasks;
use driftworld_generator::{GeneratorError, Sampler, Subject, at_distance};
use driftworld_similarity::{VariantMeasure, Weights};
use driftworld_spec::{DEFAULT_VARIANT, TaskSpec, Value, Variant, World};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use rayon::prelude::*;

use crate::distances::element;
use crate::document::{Whole, from_python, json_to_py, to_py};
use crate::errors::Result;
use crate::interruptible::{run_cancellable, run_detached};

/// Worlds that are drawn at once: between two such portions Ctrl-C is looked for.
const PORTION: u64 = 256;

/// The most worlds that may be asked for at once, and the most bytes of their texts.
const MOST_WORLDS: u64 = 10_000_000;
const MOST_BYTES: u128 = 16 << 30;
/// From so many worlds on, the first says how large all are.
const ESTIMATED: u64 = 10_000;

/// A task: what its worlds have in common, and exactly what varies between them.
///
/// Made by ``TaskSpec.load``, ``TaskSpec.from_json`` or ``TaskSpec.from_dict``. Never changes; equal when the documents say the
/// same. Pickles.
#[pyclass(name = "TaskSpec", module = "driftworld._native", frozen)]
pub(crate) struct PyTask(pub(crate) Arc<TaskSpec>);

/// One variant of a task, in which every parameter that is not drawn anew in each world has its value.
///
/// Never changes; equal when worlds and distances are the same. Pickles.
#[pyclass(name = "Variant", module = "driftworld._native", frozen)]
#[derive(Clone)]
pub(crate) struct PyVariant(pub(crate) Variant);

#[pymethods]
impl PyTask {
    /// The task of a built-in name, such as ``"find_objects"``, or of a path; a variant behind ``#`` is left aside.
    #[staticmethod]
    fn load(name_or_path: &Bound<'_, PyAny>) -> Result<Self> {
        Ok(Self(tasks::task(&name_of(name_or_path)?)?))
    }

    /// The task that a JSON text says; ``name`` is what messages call the text.
    #[staticmethod]
    fn from_json(name: &str, text: &str) -> Result<Self> {
        Ok(Self(TaskSpec::from_json(name, text)?))
    }

    /// The task that a dictionary says; ``name`` is what messages call it.
    #[staticmethod]
    #[pyo3(signature = (document, name="task spec"))]
    fn from_dict(document: &Bound<'_, PyDict>, name: &str) -> Result<Self> {
        Ok(Self(TaskSpec::from_json(name, &from_python(document)?.to_string())?))
    }

    /// The document as one line of JSON: ``from_json`` reads the same task from it.
    fn to_json(&self) -> String {
        self.0.to_json()
    }

    /// The document as a dictionary.
    fn to_dict<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        let value = serde_json::from_str(&self.0.to_json()).map_err(wrong)?;
        Ok(json_to_py(py, &value)?)
    }

    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        self.0.name()
    }

    /// What it is, in its author's words.
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

    /// The names of the variants that it declares, families unfolded; ``["default"]`` if it declares none.
    fn variant_names(&self) -> Vec<&str> {
        self.0.variant_names()
    }

    /// The same as `variants`.
    fn all_variants(&self) -> Vec<PyVariant> {
        self.variants()
    }

    /// All variants that it declares, in the order of the document.
    #[getter]
    fn variants(&self) -> Vec<PyVariant> {
        self.0.all_variants().into_iter().map(PyVariant).collect()
    }

    /// One variant; without a name the one in which every parameter has its default.
    #[pyo3(signature = (name=None))]
    fn variant(&self, name: Option<&str>) -> Result<PyVariant> {
        Ok(PyVariant(self.0.variant(name.unwrap_or(DEFAULT_VARIANT))?))
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
        let again = py.import("driftworld.specs")?.getattr("_task_again")?;
        Ok((again, (self.0.name().to_owned(), self.0.to_json())))
    }
}

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

    /// What its author says of it, if anything.
    #[getter]
    fn description(&self) -> Option<&str> {
        self.0.task().variant_description(self.0.name())
    }

    /// The values of all parameters that are the same in every world, by name.
    #[getter]
    fn values<'py>(&self, py: Python<'py>) -> Result<Bound<'py, PyAny>> {
        Ok(to_py(py, self.0.values())?)
    }

    /// A hash of everything that its worlds and its distances are made from: 64 hexadecimal digits.
    #[getter]
    fn hash(&self) -> String {
        self.0.hash()
    }

    /// A variant like this one under another name, with some parameters at other values: ``with_values("dim", light=0.5)``.
    #[pyo3(signature = (name, /, **changes))]
    fn with_values(&self, name: &str, changes: Option<&Bound<'_, PyDict>>) -> Result<Self> {
        let mut values: Vec<(String, Value)> = Vec::new();
        for (parameter, value) in changes.into_iter().flatten() {
            let parameter: String = parameter.extract()?;
            let value = value_of(&parameter, &value)?;
            values.push((parameter, value));
        }
        sound_name(name)?;
        Ok(Self(self.0.with(name, values)?))
    }

    /// A variant at a wanted distance, in 0..=1, from this one: what may change is an element of the decision process
    /// (``"reward"`` or ``"R"``, and the distance is the one in it), or a list of parameters (and the distance is the whole one).
    /// Returns the variant and its distance.
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
            if !(0.0..=1.0).contains(&number) {
                let message = format!("{option}: found {number}, expected a number in 0..1");
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
                // Distributions of numbers beyond all bounds have no finite distance: farther than any that is asked for.
                let Ok(distance) = measured.between(&from, other) else {
                    return f64::INFINITY;
                };
                element.map_or(distance.total, |element| distance.element(element).unwrap_or(0.0))
            };
            at_distance(&from, &subject, distance, tolerance, measure)
        })??;
        Ok((Self(found.variant.with(name, [])?), found.distance))
    }

    /// World number ``index`` under a seed, as a dictionary.
    #[pyo3(signature = (seed=Whole(0), index=Whole(0)), text_signature = "($self, seed=0, index=0)")]
    fn sample<'py>(&self, py: Python<'py>, seed: Whole, index: Whole) -> Result<Bound<'py, PyAny>> {
        let world = py.detach(|| driftworld_generator::sample(&self.0, seed.0, index.0))?;
        Ok(to_py(py, &world)?)
    }

    /// The same as one line of JSON.
    #[pyo3(signature = (seed=Whole(0), index=Whole(0)), text_signature = "($self, seed=0, index=0)")]
    fn sample_json(&self, py: Python<'_>, seed: Whole, index: Whole) -> Result<String> {
        let world = py.detach(|| driftworld_generator::sample(&self.0, seed.0, index.0))?;
        Ok(world.to_json())
    }

    /// ``count`` worlds from number ``start`` on, as dictionaries, drawn by several threads: 0 for one on each processor.
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
        let drawn = PyList::empty(py);
        let value = |world: World| serde_json::to_value(&world).unwrap_or_default();
        self.draw(py, seed.0, numbers(start.0, count.0)?, threads.0, value, |value| {
            drawn.append(json_to_py(py, &value)?)
        })?;
        Ok(drawn)
    }

    /// The same, each world as one line of JSON.
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
        let drawn = PyList::empty(py);
        let text = |world: World| world.to_json();
        self.draw(py, seed.0, numbers(start.0, count.0)?, threads.0, text, |text| {
            drawn.append(text)
        })?;
        Ok(drawn)
    }

    /// Draws the first ``count`` worlds under a seed, and says how often that fails, and why.
    #[pyo3(signature = (count, *, seed=Whole(0)), text_signature = "($self, count, *, seed=0)")]
    fn try_worlds<'py>(&self, py: Python<'py>, count: Whole, seed: Whole) -> Result<Bound<'py, PyAny>> {
        let trial = py.detach(|| driftworld_curriculum::try_worlds(&self.0, seed.0, count.0));
        Ok(crate::document::to_py(py, &trial)?)
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
        let again = py.import("driftworld.specs")?.getattr("_variant_again")?;
        let values = serde_json::to_string(self.0.values()).map_err(wrong)?;
        Ok((again, (self.task(), self.0.name().to_owned(), values)))
    }
}

impl PyVariant {
    /// Draws worlds a portion at a time without the interpreter's lock, and hands each over as `make` makes it.
    fn draw<T: Send>(
        &self,
        py: Python<'_>,
        seed: u64,
        mut numbers: Range<u64>,
        threads: u64,
        make: impl Fn(World) -> T + Sync,
        mut take: impl FnMut(T) -> PyResult<()>,
    ) -> Result<()> {
        let pool = pool(threads)?;
        let sampler = py.detach(|| Sampler::new(&self.0, seed));
        if numbers.end - numbers.start > ESTIMATED {
            expect_room(&numbers, sampler.world(numbers.start)?.to_json().len())?;
        }
        while !numbers.is_empty() {
            let portion = numbers.start..numbers.end.min(numbers.start + PORTION);
            numbers.start = portion.end;
            let draw = |stop: &AtomicBool| {
                let world = |index: u64| {
                    let wanted = !stop.load(Ordering::Relaxed);
                    wanted.then(|| sampler.world(index).map(&make)).transpose()
                };
                let all = || {
                    portion
                        .into_par_iter()
                        .map(world)
                        .collect::<std::result::Result<Vec<_>, GeneratorError>>()
                };
                match &pool {
                    Some(pool) => pool.install(all),
                    None => all(),
                }
            };
            // Before a portion that is quickly drawn ends, nobody has looked.
            py.check_signals()?;
            for made in run_cancellable(py, draw)??.into_iter().flatten() {
                take(made)?;
            }
        }
        Ok(())
    }
}

/// A variant in another process.
#[pyfunction]
pub(crate) fn variant_again(task: &Bound<'_, PyTask>, name: &str, values: &str) -> Result<PyVariant> {
    let task = &task.get().0;
    let wanted: indexmap::IndexMap<String, Value> = serde_json::from_str(values).map_err(wrong)?;
    if let Ok(declared) = task.variant(name)
        && *declared.values() == wanted
    {
        return Ok(PyVariant(declared));
    }
    // Values that are as in the variant begun with are left as they are: they may be ones that nothing can be set to.
    let mut bases = task.all_variants().into_iter().map(Ok).collect::<Vec<_>>();
    bases.push(task.variant(DEFAULT_VARIANT));
    let mut refused = None;
    for base in bases.into_iter().flatten() {
        let changes = wanted.iter().filter(|(name, value)| base.value(name) != Some(*value));
        match base.with(name, changes.map(|(name, value)| (name.clone(), value.clone()))) {
            Ok(variant) => return Ok(PyVariant(variant)),
            Err(error) => refused = Some(error),
        }
    }
    Err(refused.map_or_else(|| wrong("the task has no variant").into(), Into::into))
}

/// A variant by its name: built in, or a path; with `#` before the variant's own name.
#[pyfunction]
pub(crate) fn load_variant(name: &str) -> Result<PyVariant> {
    Ok(PyVariant(tasks::variant(name)?))
}

/// The variants that a name stands for: one, a family, or all of a task.
#[pyfunction]
pub(crate) fn load_variants(name: &str) -> Result<Vec<PyVariant>> {
    Ok(tasks::variants(name)?.into_iter().map(PyVariant).collect())
}

/// The names of the built-in tasks.
#[pyfunction]
pub(crate) fn built_in_names() -> Vec<&'static str> {
    tasks::built_in_names()
}

/// A name, or a path of any of Python's kinds.
fn name_of(name_or_path: &Bound<'_, PyAny>) -> PyResult<String> {
    let path = name_or_path
        .py()
        .import("os")?
        .call_method1("fspath", (name_or_path,))?;
    path.extract()
        .map_err(|_| PyTypeError::new_err(format!("found {name_or_path}, expected a name or a path as text")))
}

/// A value of a parameter, as a task spec writes it.
fn value_of(parameter: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    let expected =
        "expected a value as a task spec writes it: a finite number, a word, a truth value, a list or a dictionary";
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

/// Checks the name of a variant that is made: it stands behind the `#` of its id.
fn sound_name(name: &str) -> PyResult<()> {
    if name.is_empty() || name.contains('#') {
        let message = format!("name: found {name:?}, expected a variant's name of at least one letter, without #");
        return Err(PyValueError::new_err(message));
    }
    Ok(())
}

/// Refuses what would take more memory than it is likely meant to: all worlds are held at once.
fn expect_room(numbers: &Range<u64>, first_bytes: usize) -> PyResult<()> {
    let count = numbers.end - numbers.start;
    let bytes = u128::from(count) * first_bytes as u128;
    if bytes <= MOST_BYTES {
        return Ok(());
    }
    let gib = bytes as f64 / f64::from(1 << 30);
    Err(PyValueError::new_err(format!(
        "count: found {count} worlds of about {first_bytes} bytes, {gib:.0} GiB as text, expected at most 16 GiB at once; ask for them \
         in portions, with start"
    )))
}

fn numbers(start: u64, count: u64) -> PyResult<Range<u64>> {
    if count > MOST_WORLDS {
        return Err(PyValueError::new_err(format!(
            "count: found {count}, expected at most {MOST_WORLDS} worlds at once; ask for them in portions, with start"
        )));
    }
    let end = start.checked_add(count).ok_or_else(|| {
        PyValueError::new_err(format!(
            "start: found {start}, expected room for {count} worlds below 2^64"
        ))
    })?;
    Ok(start..end)
}

/// The most threads that may be asked for.
const MOST_THREADS: u64 = 1024;

/// Threads to draw by; none where those of all long work are meant.
fn pool(threads: u64) -> PyResult<Option<rayon::ThreadPool>> {
    if threads == 0 {
        return Ok(None);
    }
    if threads > MOST_THREADS {
        return Err(PyValueError::new_err(format!(
            "threads: found {threads}, expected at most {MOST_THREADS}; 0 for one on each processor"
        )));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads as usize).build();
    pool.map(Some)
        .map_err(|error| PyValueError::new_err(format!("threads: found {threads}: {error}")))
}

fn hash_of(text: &str) -> u64 {
    let mut hasher = DefaultHasher::new();
    text.hash(&mut hasher);
    hasher.finish()
}

fn wrong(error: impl std::fmt::Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}
