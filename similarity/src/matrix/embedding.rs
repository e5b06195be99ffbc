//! [`Embedding`]: items as lists of numbers whose Euclidean distance is their own, so that very many can be compared at once.
//! How a document becomes such a list is not known here.

use ndarray::{Array1, Array2, ArrayView1, Axis, s};
use rayon::prelude::*;

use super::DistanceMatrix;
use crate::{MetricProperties, SimilarityError};

/// The most numbers that an item may have.
pub const MAX_FEATURES: usize = 4_096;
/// How many rows are multiplied at a time.
const BLOCK: usize = 256;
/// Below this share of the lengths' squares a squared distance has lost too many digits, and is summed up directly.
const CANCELLED: f64 = 1e-4;

/// Items as points of a Euclidean space.
///
/// All distances come from one matrix product, by `|a - b|² = |a|² + |b|² - 2 a·b`, block by block. That form loses digits
/// where two points lie close together but far from the origin: points are moved to their mean first, and pairs that still
/// lose more than four digits are summed up directly, so every distance is within 1e-11 of its value, relatively. The product
/// uses the processor's own instructions: its last bits may differ between kinds of processors.
///
/// # Example
/// ```
/// use driftworld_similarity::Embedding;
/// use ndarray::array;
/// let names = ["a", "b", "c"].map(String::from).to_vec();
/// let embedding = Embedding::new(names, array![[0.0, 0.0], [3.0, 4.0], [0.0, 1.0]])?;
/// assert!((embedding.distances().get(0, 1) - 5.0).abs() < 1e-12);
/// assert_eq!(embedding.nearest(&[0.0, 0.9], 2)?[0].0, 2);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Embedding {
    labels: Vec<String>,
    /// `(items, numbers)`, moved so that the mean is 0.
    points: Array2<f64>,
    /// What was taken from each number.
    mean: Array1<f64>,
    /// The square of each point's length.
    squares: Vec<f64>,
}

impl Embedding {
    /// The items with these points, `(items, numbers)`.
    ///
    /// # Errors
    /// [`SimilarityError::BadFeatures`] for a number that is not finite, rows that are not one for each label, or more than
    /// [`MAX_FEATURES`] numbers; [`SimilarityError::TooMany`] for more items than a matrix holds.
    pub fn new(labels: Vec<String>, mut points: Array2<f64>) -> Result<Self, SimilarityError> {
        let n = DistanceMatrix::bounded(labels.len())?;
        if points.nrows() != n || points.ncols() > MAX_FEATURES {
            return Err(SimilarityError::BadFeatures {
                place: "size".to_owned(),
                found: format!("{} × {}", points.nrows(), points.ncols()),
                expected: format!("{n} rows, one for each label, of at most {MAX_FEATURES} numbers"),
            });
        }
        for (label, row) in labels.iter().zip(points.rows()) {
            check_finite(&format!("item {label:?}"), &row)?;
        }
        let mean = points
            .mean_axis(Axis(0))
            .unwrap_or_else(|| Array1::zeros(points.ncols()));
        points -= &mean;
        let squares = points.rows().into_iter().map(|row| row.dot(&row)).collect();
        Ok(Self {
            labels,
            points,
            mean,
            squares,
        })
    }

    /// Every distance among the items, a metric. Time `O(n² · numbers)`, all of it one matrix product.
    pub fn distances(&self) -> DistanceMatrix {
        let n = self.labels.len();
        let mut values = Array2::zeros((n, n));
        values
            .axis_chunks_iter_mut(Axis(0), BLOCK)
            .into_par_iter()
            .enumerate()
            .for_each(|(block, mut rows)| {
                let begin = block * BLOCK;
                let products = self
                    .points
                    .slice(s![begin..begin + rows.nrows(), ..])
                    .dot(&self.points.slice(s![begin.., ..]).t());
                for (row, products) in products.rows().into_iter().enumerate() {
                    let a = begin + row;
                    for b in a + 1..n {
                        rows[[row, b]] = self.square(a, b, products[b - begin]).sqrt();
                    }
                }
            });
        DistanceMatrix::mirrored(self.labels.clone(), values).with_properties(MetricProperties::Metric)
    }

    /// The squared distance of two items whose product is known.
    fn square(&self, a: usize, b: usize, product: f64) -> f64 {
        let lengths = self.squares[a] + self.squares[b];
        let square = lengths - 2.0 * product;
        if square > CANCELLED * lengths {
            square
        } else {
            square_between(&self.points.row(a), &self.points.row(b))
        }
    }

    /// The `k` items nearest to a point, with their distances, the nearest first; of equal ones those that come first. Exact.
    ///
    /// # Errors
    /// [`SimilarityError::BadFeatures`] for a number that is not finite, or another count of them than the items have.
    pub fn nearest(&self, point: &[f64], k: usize) -> Result<Vec<(usize, f64)>, SimilarityError> {
        if point.len() != self.points.ncols() {
            return Err(SimilarityError::BadFeatures {
                place: "point".to_owned(),
                found: format!("{} numbers", point.len()),
                expected: format!("{}, as the items have", self.points.ncols()),
            });
        }
        check_finite("point", &ArrayView1::from(point))?;
        let point = &ArrayView1::from(point) - &self.mean;
        let rows: Vec<ArrayView1<f64>> = self.points.rows().into_iter().collect();
        let squares = rows
            .into_par_iter()
            .map(|row| square_between(&row, &point.view()))
            .collect();
        Ok(least(squares, None, k))
    }

    /// For each item the `k` others that are nearest to it, as [`Embedding::nearest`] gives them. Exact, by blocks: it never
    /// holds the whole matrix.
    pub fn neighbours(&self, k: usize) -> Vec<Vec<(usize, f64)>> {
        let n = self.labels.len();
        let blocks: Vec<usize> = (0..n).step_by(BLOCK).collect();
        let block = |begin: usize| -> Vec<Vec<(usize, f64)>> {
            let end = n.min(begin + BLOCK);
            let products = self.points.slice(s![begin..end, ..]).dot(&self.points.t());
            let of = |(row, products): (usize, ArrayView1<f64>)| {
                let a = begin + row;
                let squares = products
                    .iter()
                    .enumerate()
                    .map(|(b, product)| self.square(a, b, *product));
                least(squares.collect(), Some(a), k)
            };
            products.rows().into_iter().enumerate().map(of).collect()
        };
        blocks
            .into_par_iter()
            .map(block)
            .collect::<Vec<_>>()
            .into_iter()
            .flatten()
            .collect()
    }
}

fn check_finite(whose: &str, row: &ArrayView1<f64>) -> Result<(), SimilarityError> {
    match row.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(index) => Err(SimilarityError::BadFeatures {
            place: format!("{whose}, number {}", index + 1),
            found: row[index].to_string(),
            expected: "a finite number".to_owned(),
        }),
    }
}

fn square_between(a: &ArrayView1<f64>, b: &ArrayView1<f64>) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum()
}

/// The `k` least of some squares, but for one, with their roots.
fn least(squares: Vec<f64>, but: Option<usize>, k: usize) -> Vec<(usize, f64)> {
    let mut all: Vec<(usize, f64)> = squares
        .into_iter()
        .enumerate()
        .filter(|(index, _)| Some(*index) != but)
        .collect();
    let order = |a: &(usize, f64), b: &(usize, f64)| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0));
    if k < all.len() {
        all.select_nth_unstable_by(k, order);
        all.truncate(k);
    }
    all.sort_unstable_by(order);
    all.into_iter().map(|(index, square)| (index, square.sqrt())).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn embedding(points: &[[f64; 3]]) -> Embedding {
        let labels = (0..points.len()).map(|k| k.to_string()).collect();
        let flat: Vec<f64> = points.iter().flatten().copied().collect();
        Embedding::new(labels, Array2::from_shape_vec((points.len(), 3), flat).unwrap()).unwrap()
    }

    fn straight(a: [f64; 3], b: [f64; 3]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 32)))]

        /// Wherever the points lie, and however close together.
        #[test]
        fn distances_are_those_of_the_plain_sum(
            points in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 1..40),
            far in -1e3..1e3_f64,
            scale in 1e-3..1e3_f64,
            twin in 0.0..1e-3_f64,
        ) {
            let mut points: Vec<[f64; 3]> = points.iter().map(|p| p.map(|x| x * scale + far)).collect();
            let first = points[0];
            points.push([first[0] + twin, first[1], first[2]]);
            let matrix = embedding(&points).distances();
            for a in 0..points.len() {
                for b in 0..points.len() {
                    let expected = straight(points[a], points[b]);
                    // What moving to the mean rounds is of the size of the numbers moved.
                    let rounding = 1e-11 * expected + 1e-15 * (far.abs() + scale) * 8.0;
                    prop_assert!((matrix.get(a, b) - expected).abs() <= rounding, "{} for {}", matrix.get(a, b), expected);
                }
            }
            prop_assert_eq!(matrix.properties(), MetricProperties::Metric);
        }

        #[test]
        fn neighbours_are_the_least_of_the_matrix(points in prop::collection::vec(prop::array::uniform3(-1.0..1.0_f64), 1..40), k in 0_usize..6) {
            let embedding = embedding(&points);
            let matrix = embedding.distances();
            for (a, found) in embedding.neighbours(k).into_iter().enumerate() {
                let mut expected: Vec<f64> = (0..points.len()).filter(|b| *b != a).map(|b| matrix.get(a, b)).collect();
                expected.sort_by(f64::total_cmp);
                prop_assert_eq!(found.len(), k.min(points.len() - 1));
                for ((b, distance), expected) in found.iter().zip(expected) {
                    prop_assert!(*b != a && (distance - expected).abs() < 1e-12);
                }
            }
            let found = embedding.nearest(&points[0], points.len()).unwrap();
            prop_assert!(found[0].1 < 1e-15 && found.is_sorted_by(|a, b| a.1 <= b.1));
        }
    }

    #[test]
    fn more_items_than_a_block_holds_meet_all_the_same() {
        let points: Vec<[f64; 3]> = (0..BLOCK + 50).map(|k| [k as f64, 0.0, 1.0]).collect();
        let embedding = embedding(&points);
        let matrix = embedding.distances();
        for (a, b) in [(0, BLOCK + 49), (BLOCK - 1, BLOCK), (BLOCK + 3, 2)] {
            assert!((matrix.get(a, b) - a.abs_diff(b) as f64).abs() < 1e-9);
        }
        let near: Vec<usize> = embedding.neighbours(2)[BLOCK].iter().map(|(item, _)| *item).collect();
        assert_eq!(near, [BLOCK - 1, BLOCK + 1]);
    }

    #[test]
    fn what_is_no_point_says_whose() {
        let said = |points: Array2<f64>| {
            let labels = vec!["one".to_owned(), "two".to_owned()];
            Embedding::new(labels, points).unwrap_err().to_string()
        };
        assert_eq!(
            said(ndarray::array![[0.0, 1.0], [0.0, f64::NAN]]),
            "features, item \"two\", number 2: found NaN, expected a finite number"
        );
        assert_eq!(
            said(Array2::zeros((3, 2))),
            "features, size: found 3 × 2, expected 2 rows, one for each label, of at most 4096 numbers"
        );
        assert_eq!(
            embedding(&[[0.0; 3]]).nearest(&[1.0], 1).unwrap_err().to_string(),
            "features, point: found 1 numbers, expected 3, as the items have"
        );
    }
}
