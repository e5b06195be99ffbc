//! Hausdorff distance of two grids: how far it is to the nearest at most. On the mean it is in `chamfer.rs`.

use super::bit_grid::BitGrid;
use super::chamfer::ways;
use crate::SimilarityError;

/// The largest distance in metres from a taken cell to the nearest that is taken in the other grid:
/// max(max over A of d(a, B), max over B of d(b, A)).
///
/// Between the centres of cells, within a plane; of several planes the largest. A metric in `0..=` the grid's diameter. Two empty
/// planes are 0 apart, one that is empty and one that is not the diameter, which keeps it a metric. Time: a few times over the
/// cells.
///
/// # Errors
/// [`SimilarityError::GridsDiffer`] when the shapes do.
///
/// # Example
/// ```
/// use driftworld_similarity::{BitGrid, GridShape, grid_hausdorff_distance};
/// let shape = GridShape::new(5, 1, 1, 2.0)?;
/// let a = BitGrid::new(shape, [true, false, false, false, false]);
/// let b = BitGrid::new(shape, [true, false, false, true, false]);
/// assert_eq!(grid_hausdorff_distance(&a, &b)?, 6.0);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Source: Hausdorff 1914. Same numbers as scikit-image's `hausdorff_distance`, which says infinity where one grid is empty, see
/// `tests/oracle/occupancy.json`.
pub fn grid_hausdorff_distance(a: &BitGrid, b: &BitGrid) -> Result<f64, SimilarityError> {
    let there = ways(a, b)?;
    Ok(there.into_iter().chain(ways(b, a)?).fold(0.0, f64::max))
}
