//! Earth mover's distance between two grids of equal mass.

use super::grid::{Grid, GridShape};
use crate::SimilarityError;
use crate::transport::{Units, cheapest_moves};

/// Minimum work that turns one grid into the other: mass times metres, between the centres of cells (Wasserstein-1 with the
/// Euclidean distance).
///
/// Both grids must hold the same mass in each plane: use [`Grid::normalised`] if only the positions matter. In `0..=` the
/// diameter times the mass, metres for a mass of 1. A metric. Mass does not move between planes; the work of all planes
/// is added up.
///
/// Exact: mass that both grids have in a cell stays (with a metric no plan is better than one that leaves it), the rest is
/// moved by network simplex. Two grids of 25 × 25 random masses take a few milliseconds.
///
/// # Errors
/// [`SimilarityError::GridsDiffer`] if the shapes differ, [`SimilarityError::UnequalMasses`] if the two masses of a plane
/// differ by a share of more than 1e-9, [`SimilarityError::TooMany`] if more than [`MAX_TRANSPORTED`](crate::MAX_TRANSPORTED)
/// cells must send or receive mass.
///
/// # Example
/// ```
/// use driftworld_similarity::{Grid, GridShape, grid_earth_movers_distance};
/// let shape = GridShape::new(2, 2, 1, 10.0)?;
/// let (a, b) = (Grid::new(shape, vec![3.0, 0.0, 0.0, 1.0])?, Grid::new(shape, vec![1.0, 2.0, 0.0, 1.0])?);
/// assert_eq!(grid_earth_movers_distance(&a, &b)?, 20.0);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Source: Rubner, Tomasi and Guibas 2000. Same numbers as `ot.emd2` (POT 0.9), see `tests/oracle/occupancy.json`.
pub fn grid_earth_movers_distance(a: &Grid, b: &Grid) -> Result<f64, SimilarityError> {
    let shape = a.shape();
    shape.check(b.shape())?;
    let planes = a.planes().zip(b.planes());
    planes.map(|(a, b)| least_work(shape, Units::of(a, b)?)).sum()
}

/// The work between the cells of a plane.
fn least_work(shape: GridShape, mut units: Units) -> Result<f64, SimilarityError> {
    for (a, b) in units.from.iter_mut().zip(&mut units.to) {
        let stays = (*a).min(*b);
        *a -= stays;
        *b -= stays;
    }
    let columns = shape.columns();
    let distance = |a: usize, b: usize| {
        let (x, y) = ((a % columns).abs_diff(b % columns), (a / columns).abs_diff(b / columns));
        ((x * x + y * y) as f64).sqrt() * shape.cell()
    };
    let moves = cheapest_moves(&units.from, &units.to, distance)?.into_iter();
    let work = moves.map(|(from, to, flow)| flow as f64 * distance(from, to));
    // Gives 0, not −0, if nothing moves.
    Ok(work.fold(0.0, |sum, work| sum + work) * units.unit)
}
