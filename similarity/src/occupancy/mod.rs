//! Distances between what stands where: worlds as grids, and as sets of objects.

mod bit_grid;
mod chamfer;
mod dice;
mod distance_transform;
mod earth_movers;
mod earth_movers_hat;
mod grid;
mod hamming;
mod hausdorff;
mod hausdorff_95;
mod jaccard;
mod ospa;
mod raster;
mod ruzicka;
mod sinkhorn;
mod sliced;

pub use bit_grid::BitGrid;
pub use chamfer::grid_chamfer_distance;
pub use dice::grid_dice_distance;
pub use earth_movers::grid_earth_movers_distance;
pub use earth_movers_hat::grid_earth_movers_hat;
pub use grid::{Grid, GridShape, MAX_CELLS};
pub use hamming::grid_hamming_distance;
pub use hausdorff::grid_hausdorff_distance;
pub use hausdorff_95::grid_hausdorff_95;
pub use jaccard::grid_jaccard_distance;
pub use ospa::Ospa;
pub use raster::{Classes, Extent, Raster};
pub use ruzicka::grid_ruzicka_distance;
pub use sinkhorn::grid_sinkhorn;
pub use sliced::grid_sliced_wasserstein;
