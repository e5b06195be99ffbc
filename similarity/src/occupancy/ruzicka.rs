//! Ruzicka distance of two grids: Jaccard for counts and masses. Whether cells are taken at all is compared in `jaccard.rs`.

use super::grid::Grid;
use crate::SimilarityError;

/// 1 − Σ min(a, b) / Σ max(a, b) over all cells.
///
/// A metric in `0..=1`; two empty grids are 0 apart. On masses of 0 and 1 it is Jaccard. Time: once over the cells.
///
/// # Errors
/// [`SimilarityError::GridsDiffer`] when the shapes do.
///
/// # Example
/// ```
/// use driftworld_similarity::{Grid, GridShape, grid_ruzicka_distance};
/// let shape = GridShape::new(2, 1, 1, 1.0)?;
/// let (a, b) = (Grid::new(shape, vec![3.0, 0.0])?, Grid::new(shape, vec![1.0, 1.0])?);
/// assert_eq!(grid_ruzicka_distance(&a, &b)?, 0.75);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Sources: Ružička 1958; Charikar 2002 for the triangle inequality. Same numbers as Bray–Curtis B of SciPy by 2B / (1 + B), see
/// `tests/oracle/occupancy.json`.
pub fn grid_ruzicka_distance(a: &Grid, b: &Grid) -> Result<f64, SimilarityError> {
    a.shape().check(b.shape())?;
    let (mut apart, mut most) = (0.0, 0.0);
    for (a, b) in a.masses().iter().zip(b.masses()) {
        let high = a.max(*b);
        apart += high - a.min(*b);
        most += high;
    }
    Ok(if most == 0.0 { 0.0 } else { apart / most })
}
