//! Dice distance of two grids: what is not shared, of all that stands in both. For a metric take Jaccard, in `jaccard.rs`.

use super::bit_grid::BitGrid;
use crate::SimilarityError;

/// 1 − 2 |A ∩ B| / (|A| + |B|).
///
/// A distance in `0..=1`, not a metric: a detour can be shorter, by up to a quarter and more. Two empty grids are 0 apart. Orders
/// pairs as Jaccard J does: it is J / (2 − J). Time: a word for 64 cells.
///
/// # Errors
/// [`SimilarityError::GridsDiffer`] when the shapes do.
///
/// # Example
/// ```
/// use driftworld_similarity::{BitGrid, GridShape, grid_dice_distance};
/// let shape = GridShape::new(2, 1, 1, 1.0)?;
/// let grid = |west, east| BitGrid::new(shape, [west, east]);
/// let (west, both, east) = (grid(true, false), grid(true, true), grid(false, true));
/// // By way of both it is shorter than straight on.
/// assert_eq!(grid_dice_distance(&west, &east)?, 1.0);
/// assert!((grid_dice_distance(&west, &both)? + grid_dice_distance(&both, &east)? - 2.0 / 3.0).abs() < 1e-15);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Source: Dice 1945. Same numbers as SciPy's `dice`, see `tests/oracle/occupancy.json`.
pub fn grid_dice_distance(a: &BitGrid, b: &BitGrid) -> Result<f64, SimilarityError> {
    let (common, both) = (a.common(b)?, a.count() + b.count());
    Ok(if both == 0 {
        0.0
    } else {
        (both - 2 * common) as f64 / both as f64
    })
}
