//! Hamming distance of two grids: how many cells differ. That of sets of cells without an extent is in `cells.rs`.

use super::bit_grid::BitGrid;
use crate::SimilarityError;

/// Number of cells that are taken in one grid only: |A ∪ B| − |A ∩ B|.
///
/// A metric in `0..=` the number of cells. Time: a word for 64 cells.
///
/// # Errors
/// [`SimilarityError::GridsDiffer`] when the shapes do.
///
/// # Example
/// ```
/// use driftworld_similarity::{BitGrid, GridShape, grid_hamming_distance};
/// let shape = GridShape::new(3, 1, 1, 1.0)?;
/// let (a, b) = (BitGrid::new(shape, [true, true, false]), BitGrid::new(shape, [false, true, true]));
/// assert_eq!(grid_hamming_distance(&a, &b)?, 2);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Source: Hamming 1950. SciPy's `hamming` is this over the number of cells; see `tests/oracle/occupancy.json`.
pub fn grid_hamming_distance(a: &BitGrid, b: &BitGrid) -> Result<usize, SimilarityError> {
    Ok(a.count() + b.count() - 2 * a.common(b)?)
}
