//! Entropic earth mover's distance of two grids, with bounds. The exact one is in `earth_movers.rs`.

use super::earth_movers::distances;
use super::grid::Grid;
use crate::transport::{Units, taken};
use crate::{SimilarityError, Sinkhorn, SinkhornSettings, sinkhorn};

/// Work that turns one grid into the other by a plan with an entropic regularisation, and bounds of the least work.
///
/// Masses, planes and units as in [`grid_earth_movers_distance`](crate::grid_earth_movers_distance); the regularisation is in
/// metres. Over several planes costs and bounds are added up, the marginal error is that of the whole mass, the steps are the
/// most of any plane. Not a distance, see [`sinkhorn`].
///
/// # Errors
/// As [`grid_earth_movers_distance`](crate::grid_earth_movers_distance) and [`sinkhorn`].
///
/// # Example
/// ```
/// use driftworld_similarity::{Grid, GridShape, SinkhornSettings, grid_sinkhorn};
/// let shape = GridShape::new(2, 1, 1, 10.0)?;
/// let (a, b) = (Grid::new(shape, vec![3.0, 1.0])?, Grid::new(shape, vec![1.0, 3.0])?);
/// let found = grid_sinkhorn(&a, &b, &SinkhornSettings::new(0.1))?;
/// assert!((found.upper - 20.0).abs() < 1e-3 && (found.lower - 20.0).abs() < 1e-3);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn grid_sinkhorn(a: &Grid, b: &Grid, settings: &SinkhornSettings) -> Result<Sinkhorn, SimilarityError> {
    let shape = a.shape();
    shape.check(b.shape())?;
    let (mut whole, mut mass) = (sinkhorn(&[], &[], &[], settings)?, 0.0);
    for (a, b) in a.planes().zip(b.planes()) {
        let units = Units::of(a, b)?;
        let (from, to) = (taken(&units.from)?, taken(&units.to)?);
        let pick = |plane: &[f64], cells: &[usize]| cells.iter().map(|&cell| plane[cell]).collect::<Vec<f64>>();
        let found = sinkhorn(&pick(a, &from), &pick(b, &to), &distances(shape, &from, &to), settings)?;
        let of_plane: f64 = a.iter().sum();
        whole.cost += found.cost;
        whole.lower += found.lower;
        whole.upper += found.upper;
        whole.marginal_error += found.marginal_error * of_plane;
        whole.steps = whole.steps.max(found.steps);
        mass += of_plane;
    }
    if mass > 0.0 {
        whole.marginal_error /= mass;
    }
    Ok(whole)
}
