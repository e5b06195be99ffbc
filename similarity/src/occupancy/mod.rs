//! Distances between worlds by occupancy: as grids, and as sets of objects.

mod bit_grid;
mod chamfer;
mod distance_transform;
mod earth_movers;
mod grid;
mod hausdorff;
mod jaccard;
mod ospa;
mod raster;

pub use bit_grid::BitGrid;
pub use chamfer::grid_chamfer_distance;
pub use earth_movers::grid_earth_movers_distance;
pub use grid::{Grid, GridShape, MAX_CELLS};
pub use hausdorff::grid_hausdorff_distance;
pub use jaccard::grid_jaccard_distance;
pub use ospa::ospa;
pub(crate) use raster::Raster;
