//! [`DistanceMatrix`]: all distances among some items.

mod csv;
pub(crate) mod eigen;
mod json;
mod mds;

use ndarray::{Array2, Axis};
use rayon::prelude::*;
use serde::Serialize;

use crate::{MetricProperties, SimilarityError};

pub use mds::{PlanarMap, classical_map};

/// Maximum number of items in a matrix.
pub const MAX_ITEMS: usize = 20_000;

/// Largest distance allowed, so that sums over any matrix stay finite.
pub const MAX_DISTANCE: f64 = 1e100;

/// All distances among labelled items: symmetric, finite, at least 0, and 0 on the diagonal.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DistanceMatrix {
    labels: Vec<String>,
    #[serde(rename = "nature")]
    properties: MetricProperties,
    #[serde(serialize_with = "rows")]
    values: Array2<f64>,
}

fn rows<S: serde::Serializer>(values: &Array2<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(values.rows().into_iter().map(|row| row.to_vec()))
}

impl DistanceMatrix {
    /// Measures every pair once, in parallel; `measure` takes two indices, the first below the second.
    ///
    /// Declared as a mere [`MetricProperties::Distance`] unless [`DistanceMatrix::with_properties`] declares more.
    ///
    /// # Errors
    /// The error of `measure` for the first failing pair in row order; [`SimilarityError::NotADistance`] for an invalid number;
    /// [`SimilarityError::TooMany`] for more than [`MAX_ITEMS`] items.
    ///
    /// # Example
    /// ```
    /// use driftworld_similarity::{DistanceMatrix, SimilarityError};
    /// let heights = [1.5_f64, 1.0, 3.0];
    /// let names = ["a", "b", "c"].map(String::from).to_vec();
    /// let matrix = DistanceMatrix::measure(names, |a, b| Ok::<_, SimilarityError>((heights[a] - heights[b]).abs()))?;
    /// assert_eq!(matrix.get(2, 0), 1.5);
    /// # Ok::<(), SimilarityError>(())
    /// ```
    pub fn measure<E>(labels: Vec<String>, measure: impl Fn(usize, usize) -> Result<f64, E> + Sync) -> Result<Self, E>
    where
        E: From<SimilarityError> + Send,
    {
        let n = Self::bounded(labels.len())?;
        Self::distinct(&labels)?;
        let mut values = Array2::zeros((n, n));
        let row = |(a, mut row): (usize, ndarray::ArrayViewMut1<f64>)| -> Result<(), E> {
            for b in a + 1..n {
                let found = measure(a, b)?;
                row[b] = Self::check_distance(&labels, a, b, found)?;
            }
            Ok(())
        };
        let outcomes: Vec<Result<(), E>> = values
            .axis_iter_mut(Axis(0))
            .into_par_iter()
            .enumerate()
            .map(row)
            .collect();
        outcomes.into_iter().collect::<Result<(), E>>()?;
        Ok(Self::mirrored(labels, values))
    }

    /// A matrix of given distances: `(items, items)`, symmetric up to rounding, 0 on the diagonal. If the two halves differ by
    /// at most 1e-9 of the larger value, the upper one is kept.
    ///
    /// # Errors
    /// [`SimilarityError::BadMatrix`] for a different shape, a repeated label, a diagonal that is not 0, or halves that differ;
    /// [`SimilarityError::NotADistance`] for an invalid number; [`SimilarityError::TooMany`] for more than [`MAX_ITEMS`].
    pub fn from_values(labels: Vec<String>, values: Array2<f64>) -> Result<Self, SimilarityError> {
        let n = Self::bounded(labels.len())?;
        let bad =
            |place: String, found: String, expected: String| SimilarityError::BadMatrix { place, found, expected };
        Self::distinct(&labels)?;
        if values.dim() != (n, n) {
            let found = format!("{} × {}", values.nrows(), values.ncols());
            return Err(bad("size".to_owned(), found, format!("{n} × {n}, one for each label")));
        }
        for a in 0..n {
            if values[[a, a]] != 0.0 {
                let place = format!("distance of {:?} to itself", labels[a]);
                return Err(bad(place, values[[a, a]].to_string(), "0".to_owned()));
            }
            for b in a + 1..n {
                let there = Self::check_distance(&labels, a, b, values[[a, b]])?;
                let back = Self::check_distance(&labels, b, a, values[[b, a]])?;
                if (there - back).abs() > 1e-9 * there.max(back) {
                    let place = format!("distance of {:?} to {:?}", labels[a], labels[b]);
                    let found = format!("{there} in one direction and {back} in the other");
                    return Err(bad(place, found, "equal distances".to_owned()));
                }
            }
        }
        Ok(Self::mirrored(labels, values))
    }

    /// Checks the labels of a matrix before anything is measured.
    ///
    /// # Errors
    /// [`SimilarityError::TooMany`] for more than [`MAX_ITEMS`], [`SimilarityError::BadMatrix`] for a repeated label.
    pub fn check_labels(labels: &[String]) -> Result<(), SimilarityError> {
        Self::bounded(labels.len())?;
        Self::distinct(labels)
    }

    fn bounded(found: usize) -> Result<usize, SimilarityError> {
        SimilarityError::check_count(found, MAX_ITEMS).map(|()| found)
    }

    fn distinct(labels: &[String]) -> Result<(), SimilarityError> {
        let mut sorted: Vec<&String> = labels.iter().collect();
        sorted.sort_unstable();
        let twice = sorted.array_windows().find(|[a, b]| a == b);
        twice.map_or(Ok(()), |[label, _]| {
            Err(SimilarityError::BadMatrix {
                place: "labels".to_owned(),
                found: format!("{label:?} twice"),
                expected: "each label once".to_owned(),
            })
        })
    }

    fn check_distance(labels: &[String], a: usize, b: usize, found: f64) -> Result<f64, SimilarityError> {
        if (0.0..=MAX_DISTANCE).contains(&found) {
            return Ok(found);
        }
        let (a, b) = (labels[a].clone(), labels[b].clone());
        Err(SimilarityError::NotADistance { a, b, found })
    }

    /// Completes a matrix from its upper triangle.
    fn mirrored(labels: Vec<String>, mut values: Array2<f64>) -> Self {
        let n = labels.len();
        for a in 0..n {
            for b in a + 1..n {
                values[[b, a]] = values[[a, b]];
            }
        }
        Self {
            labels,
            properties: MetricProperties::default(),
            values,
        }
    }

    /// The same matrix, declared to have these metric properties, which are not checked.
    #[must_use]
    pub fn with_properties(self, properties: MetricProperties) -> Self {
        Self { properties, ..self }
    }

    /// The metric properties that its measure is declared to have.
    pub fn properties(&self) -> MetricProperties {
        self.properties
    }

    /// The items' names, in order.
    pub fn labels(&self) -> &[String] {
        &self.labels
    }

    /// The distances, `(items, items)`.
    pub fn values(&self) -> &Array2<f64> {
        &self.values
    }

    /// Number of items.
    pub fn len(&self) -> usize {
        self.labels.len()
    }

    /// Whether there are no items.
    pub fn is_empty(&self) -> bool {
        self.labels.is_empty()
    }

    /// The distance between two items.
    pub fn get(&self, a: usize, b: usize) -> f64 {
        self.values[[a, b]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(n: usize) -> Vec<String> {
        (0..n).map(|k| format!("item {k}")).collect()
    }

    #[test]
    fn every_pair_is_measured_once_and_mirrored() {
        let matrix = DistanceMatrix::measure(labels(4), |a, b| {
            assert!(a < b);
            Ok::<_, SimilarityError>((b - a) as f64)
        })
        .unwrap();
        for (a, b) in (0..4).flat_map(|a| (0..4).map(move |b| (a, b))) {
            assert_eq!(matrix.get(a, b), a.abs_diff(b) as f64);
        }
    }

    #[test]
    fn invalid_distances_are_refused_by_name() {
        let found = DistanceMatrix::measure(labels(3), |a, _| {
            Ok::<_, SimilarityError>(if a == 1 { f64::NAN } else { 1.0 })
        });
        assert_eq!(
            found.unwrap_err().to_string(),
            "distance of \"item 1\" to \"item 2\": found NaN, expected a number from 0 to 1e100"
        );
        let many = DistanceMatrix::measure(labels(MAX_ITEMS + 1), |_, _| Ok::<_, SimilarityError>(0.0));
        assert_eq!(
            many.unwrap_err().to_string(),
            "found 20001 items, expected at most 20000; compare fewer at a time"
        );
    }

    #[test]
    fn values_that_are_not_a_distance_matrix_are_refused() {
        let result = |numbers: [f64; 4]| {
            let values = Array2::from_shape_vec((2, 2), numbers.to_vec()).unwrap();
            DistanceMatrix::from_values(labels(2), values).map_err(|error| error.to_string())
        };
        assert_eq!(result([0.0, 3.0, 3.0, 0.0]).unwrap().get(1, 0), 3.0);
        assert_eq!(result([0.0, 3.0, 3.0 + 1e-12, 0.0]).unwrap().get(1, 0), 3.0);
        assert_eq!(
            result([0.0, 3.0, 2.0, 0.0]).unwrap_err(),
            "matrix, distance of \"item 0\" to \"item 1\": found 3 in one direction and 2 in the other, expected equal distances"
        );
        assert_eq!(
            result([0.0, 3.0, 3.0, 1.0]).unwrap_err(),
            "matrix, distance of \"item 1\" to itself: found 1, expected 0"
        );
        assert_eq!(
            result([0.0, f64::INFINITY, 3.0, 0.0]).unwrap_err(),
            "distance of \"item 0\" to \"item 1\": found inf, expected a number from 0 to 1e100"
        );
        let twice = DistanceMatrix::from_values(vec!["a".to_owned(); 2], Array2::zeros((2, 2)));
        assert_eq!(
            twice.unwrap_err().to_string(),
            "matrix, labels: found \"a\" twice, expected each label once"
        );
        let narrow = DistanceMatrix::from_values(labels(2), Array2::zeros((2, 3)));
        assert_eq!(
            narrow.unwrap_err().to_string(),
            "matrix, size: found 2 × 3, expected 2 × 2, one for each label"
        );
    }
}
