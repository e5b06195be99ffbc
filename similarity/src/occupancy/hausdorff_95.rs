//! The 95% Hausdorff distance of two grids, which a few stray objects do not decide. The plain one is in `hausdorff.rs`.

use super::bit_grid::BitGrid;
use super::chamfer::ways;
use crate::SimilarityError;

/// The 95th percentile instead of the largest distance in metres: max(P95 over A of d(a, B), P95 over B of d(b, A)).
///
/// The percentile lies between two distances as they do in NumPy (linear). A distance in `0..=` the grid's diameter, not a metric:
/// sets that differ in few cells can be 0 apart, and a detour can be shorter. Empty planes as in
/// [`grid_hausdorff_distance`](crate::grid_hausdorff_distance); with several planes the percentile is that of all cells together.
///
/// # Errors
/// [`SimilarityError::GridsDiffer`] when the shapes do.
///
/// # Example
/// ```
/// use driftworld_similarity::{BitGrid, GridShape, grid_hausdorff_95};
/// let shape = GridShape::new(5, 1, 1, 2.0)?;
/// let a = BitGrid::new(shape, [true, false, false, false, false]);
/// let b = BitGrid::new(shape, [true, false, false, true, false]);
/// // From b it is 0 and 6 m.
/// assert!((grid_hausdorff_95(&a, &b)? - 0.95 * 6.0).abs() < 1e-12);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Source: Huttenlocher, Klanderman and Rucklidge 1993. Checked with NumPy's `percentile`, see `tests/oracle/occupancy.json`.
pub fn grid_hausdorff_95(a: &BitGrid, b: &BitGrid) -> Result<f64, SimilarityError> {
    Ok(percentile_95(ways(a, b)?).max(percentile_95(ways(b, a)?)))
}

fn percentile_95(mut ways: Vec<f64>) -> f64 {
    ways.sort_unstable_by(f64::total_cmp);
    let Some(last) = ways.len().checked_sub(1) else {
        return 0.0;
    };
    let place = 0.95 * last as f64;
    let below = place.floor() as usize;
    let (low, high) = (ways[below], ways[(below + 1).min(last)]);
    low + (high - low) * (place - below as f64)
}
