//! Maps of a matrix: items as points in a plane that approximate the distances.

use rayon::prelude::*;
use serde::Serialize;

use super::{DistanceMatrix, eigen};

/// Items as points in a plane.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PlanarMap {
    /// Each item's position, in the distances' own unit; the mean is 0, and the first axis is the longer one.
    pub points: Vec<[f64; 2]>,
    /// The share of the matrix that the plane explains, in 0..=1: the squares of the two eigenvalues used, as a share of all
    /// squares (Mardia 1978). 1 if the points reproduce all distances exactly, or all distances are 0.
    pub explained: f64,
}

/// Classical scaling (Torgerson 1952): the plane that keeps most of the doubly centred squared distances. Distances that are
/// not Euclidean are approximated; `explained` says how well. Signs are fixed: on each axis, the item farthest from 0 (the
/// first of several) is on the positive side. Time `O(n²)` for each of a few dozen steps.
///
/// Matches the points from `numpy.linalg.eigh` up to signs, within 1e-9; see `tests/oracle/mds.json`.
///
/// # Example
/// ```
/// use driftworld_similarity::{DistanceMatrix, SimilarityError, classical_map};
/// let at = [0.0_f64, 1.0, 5.0];
/// let names = ["a", "b", "c"].map(String::from).to_vec();
/// let matrix = DistanceMatrix::measure(names, |a, b| Ok::<_, SimilarityError>((at[a] - at[b]).abs()))?;
/// let map = classical_map(&matrix);
/// assert!((map.points[2][0] - 3.0).abs() < 1e-9);
/// assert!((map.explained - 1.0).abs() < 1e-9);
/// # Ok::<(), SimilarityError>(())
/// ```
pub fn classical_map(matrix: &DistanceMatrix) -> PlanarMap {
    let n = matrix.len();
    let means: Vec<f64> = (0..n)
        .into_par_iter()
        .map(|a| matrix.values().row(a).iter().map(|d| d * d).sum::<f64>() / n as f64)
        .collect();
    let mean = means.iter().sum::<f64>() / n as f64;
    let product = |a: usize, b: usize| -0.5 * (matrix.get(a, b).powi(2) - means[a] - means[b] + mean);
    let multiply = |x: &[f64], y: &mut [f64]| {
        y.par_iter_mut().enumerate().for_each(|(a, y)| {
            *y = (0..n).map(|b| product(a, b) * x[b]).sum();
        });
    };
    let mut axes: Vec<Vec<f64>> = Vec::new();
    let mut points = vec![[0.0; 2]; n];
    let mut kept = 0.0;
    for axis in 0..2 {
        let Some((value, vector)) = eigen::largest(n, &multiply, &axes) else {
            break;
        };
        let length = value.max(0.0).sqrt();
        points
            .iter_mut()
            .zip(&vector)
            .for_each(|(point, part)| point[axis] = part * length);
        kept += value.max(0.0).powi(2);
        axes.push(vector);
    }
    let rows: Vec<f64> = (0..n)
        .into_par_iter()
        .map(|a| (0..n).map(|b| product(a, b).powi(2)).sum())
        .collect();
    let all: f64 = rows.iter().sum();
    let explained = if all > 0.0 { (kept / all).min(1.0) } else { 1.0 };
    PlanarMap { points, explained }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SimilarityError;
    use ndarray::Array2;
    use proptest::prelude::*;

    #[derive(serde::Deserialize)]
    struct Golden {
        distances: Vec<Vec<f64>>,
        sizes: Vec<[f64; 2]>,
        explained: f64,
    }

    #[test]
    fn map_matches_numpy_eigenvectors() {
        let text = include_str!("../../tests/oracle/mds.json");
        let golden: serde_json::Value = serde_json::from_str(text).unwrap();
        for case in ["euclidean", "not_euclidean"] {
            let golden: Golden = serde_json::from_value(golden[case].clone()).unwrap();
            let n = golden.distances.len();
            let values = Array2::from_shape_fn((n, n), |(a, b)| golden.distances[a][b]);
            let labels = (0..n).map(|k| k.to_string()).collect();
            let map = classical_map(&DistanceMatrix::from_values(labels, values).unwrap());
            assert!(
                (map.explained - golden.explained).abs() < 1e-9,
                "{case}: {}",
                map.explained
            );
            for (point, sizes) in map.points.iter().zip(&golden.sizes) {
                for axis in 0..2 {
                    assert!(
                        (point[axis].abs() - sizes[axis]).abs() < 1e-9,
                        "{case}: {point:?} for {sizes:?}"
                    );
                }
            }
            for axis in 0..2 {
                let farthest = map
                    .points
                    .iter()
                    .map(|point| point[axis])
                    .fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a });
                assert!(farthest > 0.0, "{case}: the farthest is on the positive side");
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 32)))]

        #[test]
        fn distances_of_planar_points_are_kept(points in prop::collection::vec(prop::array::uniform2(-9.0..9.0_f64), 1..30)) {
            let gap = |a: [f64; 2], b: [f64; 2]| libm::hypot(a[0] - b[0], a[1] - b[1]);
            let labels = (0..points.len()).map(|k| k.to_string()).collect();
            let measure = |a: usize, b: usize| Ok::<_, SimilarityError>(gap(points[a], points[b]));
            let matrix = DistanceMatrix::measure(labels, measure).unwrap();
            let map = classical_map(&matrix);
            prop_assert!(map.explained > 1.0 - 1e-9);
            for a in 0..points.len() {
                for b in 0..points.len() {
                    prop_assert!((gap(map.points[a], map.points[b]) - matrix.get(a, b)).abs() < 1e-6);
                }
            }
        }
    }

    #[test]
    fn equal_items_are_at_the_same_point() {
        let matrix =
            DistanceMatrix::measure(vec!["a".into(), "b".into()], |_, _| Ok::<_, SimilarityError>(0.0)).unwrap();
        let map = classical_map(&matrix);
        assert_eq!((map.points, map.explained), (vec![[0.0; 2]; 2], 1.0));
        let none = DistanceMatrix::measure(Vec::new(), |_, _| Ok::<_, SimilarityError>(0.0)).unwrap();
        assert_eq!(classical_map(&none).points.len(), 0);
    }
}
