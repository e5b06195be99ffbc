//! Earth mover's distance of two grids whose masses may differ. Of grids of the same mass it is in `earth_movers.rs`.

use super::earth_movers::least_work;
use super::grid::Grid;
use crate::SimilarityError;
use crate::transport::{Units, sum_of_masses};

/// Least work that turns the lighter grid into a part of the heavier, plus `penalty` · diameter for each unit of mass left over.
///
/// `penalty`: share of the grid's diameter, 0.5 to 1e6; with 1, mass that has no counterpart counts as the farthest there is. A metric
/// (that is what a penalty of at least a half is for), in mass times metres, at most `max(penalty, 1)` · diameter · the larger mass.
/// Equal to [`grid_earth_movers_distance`](crate::grid_earth_movers_distance) where masses are equal. Planes add up, each with
/// what it has left over. Exact, by the same means.
///
/// # Errors
/// [`SimilarityError::GridsDiffer`] when the shapes do, [`SimilarityError::BadNumber`] for a penalty out of range,
/// [`SimilarityError::TooMany`] when more than [`MAX_TRANSPORTED`](crate::MAX_TRANSPORTED) cells have to give, or take.
///
/// # Example
/// ```
/// use driftworld_similarity::{Grid, GridShape, grid_earth_movers_hat};
/// let shape = GridShape::new(3, 1, 1, 1.0)?;
/// let (a, b) = (Grid::new(shape, vec![1.0, 0.0, 2.0])?, Grid::new(shape, vec![0.0, 1.0, 0.0])?);
/// // One moves by 1 m; two are left over, and the diameter is 2 m.
/// assert_eq!(grid_earth_movers_hat(&a, &b, 0.5)?, 1.0 + 2.0 * 0.5 * 2.0);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Source: Pele and Werman 2008, where it is written with a circumflex over EMD. Checked with `ot.emd2` (POT 0.9) on grids with a cell
/// that takes what is left over, see `tests/oracle/occupancy.json`.
pub fn grid_earth_movers_hat(a: &Grid, b: &Grid, penalty: f64) -> Result<f64, SimilarityError> {
    let shape = a.shape();
    shape.check(b.shape())?;
    if !(0.5..=1e6).contains(&penalty) {
        return Err(SimilarityError::BadNumber {
            of: "penalty",
            found: penalty,
            expected: "a number from 0.5 to 1e6",
        });
    }
    let planes = a.planes().zip(b.planes());
    planes
        .map(|(a, b)| {
            let excess = sum_of_masses("cells", a)? - sum_of_masses("cells", b)?;
            // Beyond the last cell is where the excess goes for nothing.
            let with = |plane: &[f64], more: f64| [plane, &[more.max(0.0)]].concat();
            let units = Units::of(&with(a, -excess), &with(b, excess))?;
            Ok(least_work(shape, units)? + excess.abs() * penalty * shape.diameter())
        })
        .sum()
}
