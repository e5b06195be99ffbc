//! Chamfer distance of two grids: how far it is to the nearest on the mean. The farthest is in `hausdorff.rs`.

use super::bit_grid::BitGrid;
use super::distance_transform::nearest_squared;
use crate::SimilarityError;

/// Mean distance in metres from a taken cell to the nearest that is taken in the other grid, the mean of both ways:
/// ½ (mean over A of d(a, B) + mean over B of d(b, A)). The form of means, of distances that are not squared.
///
/// Between the centres of cells, within a plane. A distance in `0..=` the grid's diameter, not a metric: a detour can be shorter.
/// Two empty planes are 0 apart; where only one is empty, each cell of the other is the diameter away, and likewise back. Time: a few
/// times over the cells.
///
/// # Errors
/// [`SimilarityError::GridsDiffer`] when the shapes do.
///
/// # Example
/// ```
/// use driftworld_similarity::{BitGrid, GridShape, grid_chamfer_distance};
/// let shape = GridShape::new(5, 1, 1, 2.0)?;
/// let a = BitGrid::new(shape, [true, false, false, false, false]);
/// let b = BitGrid::new(shape, [true, false, false, true, false]);
/// // From a no way, from b 0 and 6 m.
/// assert_eq!(grid_chamfer_distance(&a, &b)?, 1.5);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Source: Barrow et al. 1977, symmetric as in Fan, Su and Guibas 2017 but not squared. Checked with SciPy's `cdist`, see
/// `tests/oracle/occupancy.json`.
pub fn grid_chamfer_distance(a: &BitGrid, b: &BitGrid) -> Result<f64, SimilarityError> {
    Ok(f64::midpoint(mean(&ways(a, b)?), mean(&ways(b, a)?)))
}

/// The distance in metres from each taken cell of `a` to the nearest of `b`. Where a plane of `b` is empty and that of `a` is not,
/// the diameter; where it is the other way round, the diameter once.
pub(super) fn ways(a: &BitGrid, b: &BitGrid) -> Result<Vec<f64>, SimilarityError> {
    let shape = a.shape();
    shape.check(b.shape())?;
    let size = shape.columns() * shape.rows();
    let mut ways = Vec::with_capacity(a.count());
    for plane in 0..shape.planes() {
        let held = (plane * size..(plane + 1) * size)
            .filter(|&cell| a.is_taken(cell))
            .count();
        match nearest_squared(a, b, plane) {
            Some(_) if held == 0 => ways.push(shape.diameter()),
            Some(squared) => ways.extend(squared.iter().map(|&squared| (squared as f64).sqrt() * shape.cell())),
            None => ways.extend(std::iter::repeat_n(shape.diameter(), held)),
        }
    }
    Ok(ways)
}

fn mean(ways: &[f64]) -> f64 {
    ways.iter().sum::<f64>() / ways.len().max(1) as f64
}
