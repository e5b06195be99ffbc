//! Distances between worlds by the cells that objects occupy.

use driftworld_spec::World;

use crate::{BitGrid, Grid, GridShape, Raster, SimilarityError, grid_earth_movers_distance};

/// A distance between the cells that are taken in two worlds.
pub(super) fn between_taken_cells(
    a: &World,
    b: &World,
    distance: impl Fn(&BitGrid, &BitGrid) -> Result<f64, SimilarityError>,
) -> Result<f64, SimilarityError> {
    let [a, b] = grids(a, b)?;
    distance(&a.taken(), &b.taken())
}

/// Number of objects in each cell of both worlds, in a canonical order of the two, so that the result is symmetric to the last
/// bit.
fn grids(a: &World, b: &World) -> Result<[Grid; 2], SimilarityError> {
    let raster = Raster::fitting(&[a, b])?;
    let mut grids = [raster.counts(a)?, raster.counts(b)?];
    if grids[0].masses() > grids[1].masses() {
        grids.swap(0, 1);
    }
    Ok(grids)
}

/// The sum over classes of the work that turns one world into the other, each class with mass 1; the diameter for a class in
/// one world only. Masses are whole numbers, so cells with equal shares of a class have equal masses.
pub(super) fn earth_movers(a: &World, b: &World) -> Result<f64, SimilarityError> {
    let [a, b] = &grids(a, b)?;
    let shape = a.shape();
    let plane = GridShape::new(shape.columns(), shape.rows(), 1, shape.cell())?;
    let planes = [a, b].map(|grid| grid.masses().chunks(plane.num_cells()));
    let [planes_of_a, planes_of_b] = planes;
    let mut sum = 0.0;
    for (a, b) in planes_of_a.zip(planes_of_b) {
        let [of_a, of_b]: [f64; 2] = [a, b].map(|masses| masses.iter().sum());
        sum += match (of_a > 0.0, of_b > 0.0) {
            (false, false) => 0.0,
            (true, true) => {
                let times = |masses: &[f64], factor: f64| masses.iter().map(|mass| mass * factor).collect();
                let (a, b) = (Grid::new(plane, times(a, of_b))?, Grid::new(plane, times(b, of_a))?);
                grid_earth_movers_distance(&a, &b)? / (of_a * of_b)
            }
            _ => shape.diameter(),
        };
    }
    Ok(sum)
}
