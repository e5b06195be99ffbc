//! Sliced Wasserstein distance of two grids: the mean over directions of the work along a line. Of points it is in `transport/`.

use super::grid::Grid;
use crate::SimilarityError;
use crate::transport::{Units, directions};

/// Mean over `directions` of the work between the grids' shadows on a line in that direction, in mass times metres.
///
/// Masses and planes as in [`grid_earth_movers_distance`](crate::grid_earth_movers_distance), which it never exceeds; directions as
/// in [`sliced_wasserstein`](crate::sliced_wasserstein). A distance: symmetric, 0 on equal grids, and the triangle inequality holds,
/// but grids that differ may cast the same shadows. Time `directions · cells · log(cells)`.
///
/// # Errors
/// [`SimilarityError::GridsDiffer`] when the shapes do, [`SimilarityError::UnequalMasses`] when a plane's masses do,
/// [`SimilarityError::BadNumber`] for 0 or too many directions.
///
/// # Example
/// ```
/// use driftworld_similarity::{Grid, GridShape, grid_sliced_wasserstein};
/// let shape = GridShape::new(2, 1, 1, 10.0)?;
/// let (a, b) = (Grid::new(shape, vec![1.0, 0.0])?, Grid::new(shape, vec![0.0, 1.0])?);
/// assert!((grid_sliced_wasserstein(&a, &b, 64)? - 10.0 * 2.0 / std::f64::consts::PI).abs() < 1e-2);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Source: Rabin et al. 2011. Same numbers as `ot.sliced_wasserstein_distance` (POT 0.9, `p=1`), see `tests/oracle/occupancy.json`.
pub fn grid_sliced_wasserstein(a: &Grid, b: &Grid, directions: usize) -> Result<f64, SimilarityError> {
    let shape = a.shape();
    shape.check(b.shape())?;
    let lines = self::directions(directions)?;
    let mut work = 0.0;
    for (a, b) in a.planes().zip(b.planes()) {
        let units = Units::of(a, b)?;
        let change: Vec<(usize, i64)> = (units.from.iter().zip(&units.to).enumerate())
            .filter(|(_, (a, b))| a != b)
            .map(|(cell, (a, b))| (cell, a - b))
            .collect();
        let mut shadow: Vec<(f64, i64)> = Vec::with_capacity(change.len());
        let mut sum = 0.0;
        for [x, y] in &lines {
            shadow.clear();
            shadow.extend(change.iter().map(|&(cell, units)| {
                let (column, row) = (cell % shape.columns(), cell / shape.columns());
                (column as f64 * x + row as f64 * y, units)
            }));
            shadow.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            let mut carried = 0;
            for pair in shadow.windows(2) {
                carried += pair[0].1;
                sum += carried.abs() as f64 * (pair[1].0 - pair[0].0);
            }
        }
        work += sum * units.unit * shape.cell() / lines.len() as f64;
    }
    Ok(work)
}
