//! [`OccupancyMeasure`]: how far apart two worlds are by the cells that objects stand in. What is measured between
//! grids is in the crate's `occupancy/`.

use driftworld_spec::World;
use strum::VariantArray;

use crate::{
    Classes, Grid, GridShape, MetricProperties, Raster, SimilarityError, SinkhornSettings, grid_chamfer_distance,
    grid_dice_distance, grid_earth_movers_distance, grid_earth_movers_hat, grid_hamming_distance, grid_hausdorff_95,
    grid_hausdorff_distance, grid_jaccard_distance, grid_ruzicka_distance, grid_sinkhorn, grid_sliced_wasserstein,
};

/// Side of a cell in metres.
const CELL: f64 = 1.0;

/// What an object without a counterpart counts, as a share of the diameter.
const PENALTY: f64 = 1.0;

/// Metres of work that the plans of Sinkhorn trade for a unit of entropy.
const REGULARISATION: f64 = 0.5;

/// How many directions the shadows are cast in.
const DIRECTIONS: usize = 64;

/// A way to say how far apart two worlds are by where things stand, each class for itself.
///
/// Both worlds become grids of square cells that cover both arenas, so that the pair alone decides; what stands outside
/// of both is not seen. A cell is 1 m wide, or 2, 4, 8 m and so on where those of all classes would be more than
/// [`MAX_CELLS`](crate::MAX_CELLS). The *diameter* is the way between the centres of the outermost cells. Two empty
/// worlds are 0 apart by all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, strum::EnumString, strum::IntoStaticStr, strum::VariantArray)]
#[strum(serialize_all = "snake_case")]
pub enum OccupancyMeasure {
    /// [`grid_earth_movers_distance`]: the mean way in metres from where a class stands here to where it stands there,
    /// however many there are; exact. Classes are added up. A class that only one world has counts the diameter, so an
    /// empty world and another are that many diameters apart. In `0..=` diameter · classes.
    #[default]
    EarthMovers,
    /// [`grid_earth_movers_hat`]: the way of all objects together, in metres; each without a counterpart of its class
    /// counts the diameter, so an empty world and another are that many diameters apart. In `0..=` diameter · objects.
    EarthMoversHat,
    /// [`grid_sinkhorn`]: as `earth_movers`, by a plan with entropy (0.5 m) for what is not in both, whose cost is
    /// never below the exact one. A class that only one world has counts the diameter. In metres, in `0..=` diameter ·
    /// classes.
    Sinkhorn,
    /// [`grid_sliced_wasserstein`]: as `earth_movers`, of the shadows in 64 directions, so never above it. A class that
    /// only one world has counts the diameter. In metres, in `0..=` diameter · classes.
    SlicedWasserstein,
    /// [`grid_hamming_distance`]: cells that a class takes in one world only. From an empty world: the cells of the
    /// other.
    Hamming,
    /// [`grid_jaccard_distance`]: the share of taken cells that are not taken in both, in `0..=1`. From an empty world
    /// to another: 1.
    Jaccard,
    /// [`grid_ruzicka_distance`]: the share of objects, counted cell by cell, that are not in both, in `0..=1`. From an
    /// empty world to another: 1.
    Ruzicka,
    /// [`grid_dice_distance`]: as `jaccard`, with what is in both counted twice, in `0..=1`. From an empty world to
    /// another: 1.
    Dice,
    /// [`grid_hausdorff_distance`]: the largest way in metres from a taken cell to the nearest that the class takes in
    /// the other world, in `0..=` diameter; the diameter where a class is in one world only.
    Hausdorff,
    /// [`grid_hausdorff_95`]: the 95th percentile of such ways instead of the largest. From an empty world to another:
    /// the diameter.
    #[strum(serialize = "hausdorff_95")]
    Hausdorff95,
    /// [`grid_chamfer_distance`]: the mean of such ways. From an empty world to another: the diameter.
    Chamfer,
}

impl OccupancyMeasure {
    /// All of them.
    pub const ALL: &[Self] = Self::VARIANTS;

    /// Its name in documents and on the command line.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// The measure of this name, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        name.parse().ok()
    }

    /// What its number is in.
    pub fn unit(self) -> &'static str {
        match self {
            Self::EarthMovers
            | Self::Sinkhorn
            | Self::SlicedWasserstein
            | Self::Hausdorff
            | Self::Hausdorff95
            | Self::Chamfer => "metres",
            Self::EarthMoversHat => "metres times objects",
            Self::Hamming => "cells",
            Self::Jaccard | Self::Dice => "share of taken cells",
            Self::Ruzicka => "share of objects",
        }
    }

    /// Which laws it keeps among worlds of one arena: what stands elsewhere in the same cells is 0 apart.
    pub fn properties(self) -> MetricProperties {
        match self {
            Self::EarthMovers
            | Self::EarthMoversHat
            | Self::SlicedWasserstein
            | Self::Hamming
            | Self::Jaccard
            | Self::Ruzicka
            | Self::Hausdorff => MetricProperties::Pseudometric,
            Self::Sinkhorn | Self::Dice | Self::Hausdorff95 | Self::Chamfer => MetricProperties::Distance,
        }
    }

    pub(super) fn label(self) -> &'static str {
        match self {
            Self::EarthMovers => "earth_movers in metres",
            Self::EarthMoversHat => "earth_movers_hat in metres times objects",
            Self::Sinkhorn => "sinkhorn in metres",
            Self::SlicedWasserstein => "sliced_wasserstein in metres",
            Self::Hamming => "hamming in cells",
            Self::Jaccard => "jaccard in shares of taken cells",
            Self::Ruzicka => "ruzicka in shares of objects",
            Self::Dice => "dice in shares of taken cells",
            Self::Hausdorff => "hausdorff in metres",
            Self::Hausdorff95 => "hausdorff_95 in metres",
            Self::Chamfer => "chamfer in metres",
        }
    }

    pub(super) fn between(self, a: &World, b: &World) -> Result<f64, SimilarityError> {
        let grids = grids(a, b)?;
        let [a, b] = &grids;
        let taken = [a.taken(), b.taken()];
        match self {
            Self::EarthMovers => over_classes(a, b, grid_earth_movers_distance),
            Self::EarthMoversHat => grid_earth_movers_hat(a, b, PENALTY),
            Self::Sinkhorn => over_classes(a, b, work_with_entropy),
            Self::SlicedWasserstein => over_classes(a, b, |a, b| grid_sliced_wasserstein(a, b, DIRECTIONS)),
            Self::Hamming => grid_hamming_distance(&taken[0], &taken[1]).map(|cells| cells as f64),
            Self::Jaccard => grid_jaccard_distance(&taken[0], &taken[1]),
            Self::Ruzicka => grid_ruzicka_distance(a, b),
            Self::Dice => grid_dice_distance(&taken[0], &taken[1]),
            Self::Hausdorff => grid_hausdorff_distance(&taken[0], &taken[1]),
            Self::Hausdorff95 => grid_hausdorff_95(&taken[0], &taken[1]),
            Self::Chamfer => grid_chamfer_distance(&taken[0], &taken[1]),
        }
    }
}

/// The raster of these worlds' arenas and classes.
pub(super) fn raster(worlds: &[&World]) -> Result<Raster, SimilarityError> {
    let mut cell = CELL;
    loop {
        match Raster::of_worlds(worlds.iter().copied(), cell, Classes::Separate) {
            // An arena has a cell at least, and fewer classes than there are cells in all.
            Err(SimilarityError::TooFine { .. }) if cell < 1e6 => cell *= 2.0,
            made => return made,
        }
    }
}

/// How many objects stand in each cell of both, the one or the other first whichever was named first, so that it is as
/// far there as back to the last bit.
fn grids(a: &World, b: &World) -> Result<[Grid; 2], SimilarityError> {
    let raster = raster(&[a, b])?;
    let mut grids = [raster.counts(a)?, raster.counts(b)?];
    if grids[0].masses() > grids[1].masses() {
        grids.swap(0, 1);
    }
    Ok(grids)
}

/// The sum over classes of the work that moves one from here to there, each class of mass 1; the diameter for a class
/// that stands in one world only. `work` gets whole masses, so that cells that hold equal shares of a class hold equal
/// masses.
fn over_classes(
    a: &Grid,
    b: &Grid,
    work: impl Fn(&Grid, &Grid) -> Result<f64, SimilarityError>,
) -> Result<f64, SimilarityError> {
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
                work(&a, &b)? / (of_a * of_b)
            }
            _ => shape.diameter(),
        };
    }
    Ok(sum)
}

/// The cost of a plan that leaves what is in both where it is, and moves the rest by Sinkhorn's iteration.
fn work_with_entropy(a: &Grid, b: &Grid) -> Result<f64, SimilarityError> {
    let rest = |of: &Grid, other: &Grid| {
        let masses = of.masses().iter().zip(other.masses());
        Grid::new(
            of.shape(),
            masses.map(|(mass, other)| (mass - other).max(0.0)).collect(),
        )
    };
    Ok(grid_sinkhorn(&rest(a, b)?, &rest(b, a)?, &SinkhornSettings::new(REGULARISATION))?.upper)
}
