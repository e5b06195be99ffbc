//! Chamfer distance between two grids: the mean distance to the nearest taken cell.

use super::bit_grid::BitGrid;
use super::distance_transform::nearest_squared;
use crate::SimilarityError;

/// Mean distance in metres from a taken cell to the nearest that is taken in the other grid, averaged over both directions: ½
/// (mean over A of d(a, B) + mean over B of d(b, A)). Uses means and unsquared distances.
///
/// Between the centres of cells, within a plane. A distance in `0..=` the grid's diameter, not a metric: the triangle
/// inequality may fail. Two empty planes are 0 apart; if only one is empty, each taken cell of the other counts as the diameter
/// in its own direction, and the empty plane counts as the diameter once in the other. Time: a few passes over the cells.
///
/// # Errors
/// [`SimilarityError::GridsDiffer`] if the shapes differ.
///
/// # Example
/// ```
/// use driftworld_similarity::{BitGrid, GridShape, grid_chamfer_distance};
/// let shape = GridShape::new(5, 1, 1, 2.0)?;
/// let a = BitGrid::new(shape, [true, false, false, false, false]);
/// let b = BitGrid::new(shape, [true, false, false, true, false]);
/// // From a: 0 m; from b: 0 m and 6 m.
/// assert_eq!(grid_chamfer_distance(&a, &b)?, 1.5);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Source: Barrow et al. 1977, symmetric as in Fan, Su and Guibas 2017 but not squared. Checked with scipy's `cdist`, see
/// `tests/oracle/occupancy.json`.
pub fn grid_chamfer_distance(a: &BitGrid, b: &BitGrid) -> Result<f64, SimilarityError> {
    Ok(f64::midpoint(mean(&nearest(a, b)?), mean(&nearest(b, a)?)))
}

/// The distance in metres from each taken cell of `a` to the nearest of `b`. If only the plane of `b` is empty, each
/// cell counts as the diameter; if only the plane of `a` is empty, the plane adds the diameter once.
pub(super) fn nearest(a: &BitGrid, b: &BitGrid) -> Result<Vec<f64>, SimilarityError> {
    let shape = a.shape();
    shape.check(b.shape())?;
    let size = shape.columns() * shape.rows();
    let mut distances = Vec::with_capacity(a.count());
    for plane in 0..shape.planes() {
        let num_taken = (plane * size..(plane + 1) * size)
            .filter(|&cell| a.is_taken(cell))
            .count();
        match nearest_squared(a, b, plane) {
            Some(_) if num_taken == 0 => distances.push(shape.diameter()),
            Some(squared) => distances.extend(squared.iter().map(|&squared| (squared as f64).sqrt() * shape.cell())),
            None => distances.extend(std::iter::repeat_n(shape.diameter(), num_taken)),
        }
    }
    Ok(distances)
}

fn mean(distances: &[f64]) -> f64 {
    distances.iter().sum::<f64>() / distances.len().max(1) as f64
}
