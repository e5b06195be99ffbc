//! Hausdorff distance between two grids: the largest distance from a taken cell to the nearest one of the other grid.

use super::bit_grid::BitGrid;
use super::chamfer::nearest;
use crate::SimilarityError;

/// The largest distance in metres from a taken cell of one grid to the nearest taken cell of the other:
/// max(max over A of d(a, B), max over B of d(b, A)).
///
/// Measured between cell centres within each plane; the result is the largest over all planes. A metric from 0 to the grid's
/// diameter. Two empty planes are 0 apart; an empty and a non-empty one are the diameter apart, which keeps it a metric. Time: a
/// few passes over the cells.
///
/// # Errors
/// [`SimilarityError::GridsDiffer`] if the shapes differ.
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
/// Source: Hausdorff 1914. Agrees with scikit-image's `hausdorff_distance`, except that scikit-image returns infinity if one grid
/// is empty; see `tests/oracle/occupancy.json`.
pub fn grid_hausdorff_distance(a: &BitGrid, b: &BitGrid) -> Result<f64, SimilarityError> {
    let distances = nearest(a, b)?;
    Ok(distances.into_iter().chain(nearest(b, a)?).fold(0.0, f64::max))
}
