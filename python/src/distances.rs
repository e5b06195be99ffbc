//! Distances, matrices of distances, and orders.

use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::Ordering;

use driftworld::distances::{By, Sample, Scale, Side, between, variant_matrix_while};
use driftworld_similarity::{
    DistanceMatrix, Method, OrderOptions, SimilarityError, Weights, classical_map, order, share_of_shorter_orders,
};
use driftworld_spec::{Element, Variant, World};
use driftworld_text::{WordKind, removed};
use numpy::{PyArray2, PyReadonlyArray2, ToPyArray};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::json;

use crate::classes::catalogue;
use crate::document::Whole;
use crate::errors::{Result, wrong};
use crate::interruptible::{run_cancellable, run_detached};
use crate::json::to_py;
use crate::rounding::usually_rounded;
use crate::variant::PyVariant;

/// Weights of elements, by letter or name.
type Weighing = Option<BTreeMap<String, f64>>;

/// A variant, or the name and the text of a world.
#[derive(FromPyObject)]
pub(crate) enum Compared<'py> {
    Variant(Bound<'py, PyVariant>),
    World(String, String),
}

/// The distance between two variants or worlds: the JSON of `driftworld distance --json` as a dictionary.
#[pyfunction]
#[pyo3(signature = (a, b, weights, worlds, seed, index, by, scale, libraries))]
#[expect(clippy::too_many_arguments, reason = "they are the arguments of a Python function")]
pub(crate) fn distance<'py>(
    py: Python<'py>,
    a: Compared<'py>,
    b: Compared<'py>,
    weights: Weighing,
    worlds: Option<Whole>,
    seed: Whole,
    index: Whole,
    by: Option<&str>,
    scale: &str,
    libraries: Vec<Vec<u8>>,
) -> Result<Bound<'py, PyAny>> {
    let laid = laid(weights)?;
    let (a, b) = (a.side()?, b.side()?);
    let sample = Sample {
        seed: seed.0,
        index: index.0,
        ..sample(by, worlds, 100_000, scale, &libraries)?
    };
    let compared = run_detached(py, move || between(&a, &b, &sample, |declared| over(&laid, declared)))??;
    let found = to_py(py, &compared.distance)?;
    found.set_item("by", compared.by.name())?;
    found.set_item("compared", compared.description)?;
    Ok(found)
}

/// Names of the ways to compare variants and worlds.
#[pyfunction]
pub(crate) fn compared_by() -> Vec<&'static str> {
    By::names().to_vec()
}

/// The sampling options: way of comparing, number of worlds, and assets; with the usual defaults.
fn sample(by: Option<&str>, worlds: Option<Whole>, most: u64, scale: &str, libraries: &[Vec<u8>]) -> Result<Sample> {
    let worlds = worlds.map(|worlds| worlds.0);
    if let Some(worlds) = worlds.filter(|worlds| !(1..=most).contains(worlds)) {
        return Err(
            PyValueError::new_err(format!("worlds: found {worlds}, expected a number from 1 to {most}")).into(),
        );
    }
    let catalogue = catalogue(libraries)?;
    let by = by.map(|name| By::from_name(name).map_err(|said| wrong(format!("by: {said}"))));
    Ok(Sample {
        by: by.transpose()?,
        scale: Scale::from_name(scale).map_err(|said| wrong(format!("scale: {said}")))?,
        worlds,
        catalogue,
        ..Sample::default()
    })
}

impl Compared<'_> {
    fn side(self) -> Result<Side> {
        Ok(match self {
            Self::Variant(variant) => Side::Variant(variant.get().0.clone()),
            Self::World(name, text) => Side::World(Box::new(usually_rounded(|| World::from_json(&name, &text))?)),
        })
    }
}

/// All distances between some items.
#[pyclass(name = "Matrix", module = "driftworld._native", frozen)]
pub(crate) struct PyMatrix(Arc<DistanceMatrix>);

#[pymethods]
impl PyMatrix {
    /// Measures every pair of variants, each with its label.
    #[staticmethod]
    #[pyo3(signature = (labels, variants, weights, by, worlds, scale, libraries))]
    #[expect(clippy::too_many_arguments, reason = "they are the arguments of a Python function")]
    fn measure(
        py: Python<'_>,
        labels: Vec<String>,
        variants: Vec<Bound<'_, PyVariant>>,
        weights: Weighing,
        by: Option<&str>,
        worlds: Option<Whole>,
        scale: &str,
        libraries: Vec<Vec<u8>>,
    ) -> Result<Self> {
        let (laid, sample) = (laid(weights)?, sample(by, worlds, 10_000, scale, &libraries)?);
        let variants = variants.iter().map(|variant| variant.get().0.clone());
        let variants: Vec<(String, Variant)> = labels.into_iter().zip(variants).collect();
        let matrix = run_cancellable(py, |stop| {
            variant_matrix_while(
                &variants,
                &sample,
                |declared| over(&laid, declared),
                || !stop.load(Ordering::Relaxed),
            )
        })??;
        Ok(Self(Arc::new(matrix)))
    }

    /// A matrix of given distances.
    #[staticmethod]
    fn from_values(labels: Vec<String>, values: PyReadonlyArray2<'_, f64>) -> Result<Self> {
        Ok(Self(Arc::new(DistanceMatrix::from_values(
            labels,
            values.as_array().to_owned(),
        )?)))
    }

    #[staticmethod]
    fn from_csv(text: &str) -> Result<Self> {
        Ok(Self(Arc::new(usually_rounded(|| DistanceMatrix::from_csv(text))?)))
    }

    #[staticmethod]
    fn from_json(text: &str) -> Result<Self> {
        Ok(Self(Arc::new(usually_rounded(|| DistanceMatrix::from_json(text))?)))
    }

    fn to_csv(&self) -> String {
        self.0.to_csv()
    }

    fn to_json(&self) -> String {
        self.0.to_json()
    }

    /// The items' names.
    #[getter]
    fn labels(&self) -> Vec<String> {
        self.0.labels().to_vec()
    }

    /// The distances, ``(items, items)``.
    fn values<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.0.values().to_pyarray(py)
    }

    /// Whether the triangle inequality holds, according to the measure's properties.
    #[getter]
    fn is_metric(&self) -> bool {
        self.0.properties().is_metric()
    }

    /// The items as points in a plane, ``(items, 2)``, and the share of the matrix that the plane represents.
    fn map<'py>(&self, py: Python<'py>) -> Result<(Bound<'py, PyArray2<f64>>, f64)> {
        let matrix = Arc::clone(&self.0);
        let map = run_detached(py, move || classical_map(&matrix))?;
        let flat: Vec<f64> = map.points.into_iter().flatten().collect();
        let points = numpy::ndarray::Array2::from_shape_vec((flat.len() / 2, 2), flat).map_err(wrong)?;
        Ok((points.to_pyarray(py), map.explained))
    }

    /// The items in an order: the JSON of ``driftworld order --json`` without the matrix, as a dictionary.
    #[pyo3(signature = (method, start, end, seed, target_step))]
    fn order<'py>(
        &self,
        py: Python<'py>,
        method: Option<&str>,
        start: Option<usize>,
        end: Option<usize>,
        seed: Whole,
        target_step: Option<f64>,
    ) -> Result<Bound<'py, PyAny>> {
        let matrix = &self.0;
        let method = method.map_or_else(|| Ok(Method::default_for(matrix.len())), str::parse)?;
        let options = OrderOptions {
            first: start,
            last: end,
            seed: seed.0,
            target_step,
        };
        let shared = Arc::clone(matrix);
        let found = run_detached(py, move || order(&shared, method, &options))??;
        let labels: Vec<&String> = found.indices.iter().map(|index| &matrix.labels()[*index]).collect();
        let found = json!({
            "method": method, "order": labels, "indices": found.indices, "steps": found.steps, "length": found.length,
            "largest_step": found.largest_step(), "mean_step": found.mean_step(),
            "anchor_correlation": found.anchor_correlation,
            "share_of_shorter_random_orders": share_of_shorter_orders(matrix, &found, seed.0),
        });
        Ok(to_py(py, &found)?)
    }

    fn __len__(&self) -> usize {
        self.0.len()
    }
}

/// The message about a file name extension of a removed format.
#[pyfunction]
pub(crate) fn removed_format(ending: &str) -> Option<String> {
    removed(WordKind::Format, ending)
}

/// The names of the ordering methods.
#[pyfunction]
pub(crate) fn order_methods() -> Vec<&'static str> {
    Method::ALL.iter().map(|method| method.name()).collect()
}

/// Parses an element of the decision process, given by letter or name.
pub(crate) fn element(word: &str) -> PyResult<Element> {
    let known = |known: &Element| known.letter().eq_ignore_ascii_case(word) || known.name() == word;
    Element::ALL.into_iter().find(known).ok_or_else(|| {
        let expected = "S, A, T, R or O, or state, action, transition, reward or observation";
        PyValueError::new_err(format!("element: found {word:?}, expected {expected}"))
    })
}

fn laid(weights: Weighing) -> PyResult<Vec<(Element, f64)>> {
    let weights = weights.unwrap_or_default().into_iter();
    weights.map(|(word, weight)| Ok((element(&word)?, weight))).collect()
}

/// Overrides some weights.
fn over(laid: &[(Element, f64)], declared: Weights) -> std::result::Result<Weights, SimilarityError> {
    laid.iter()
        .try_fold(declared, |weights, (element, weight)| weights.with(*element, *weight))
}
