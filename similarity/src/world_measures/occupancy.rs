//! [`OccupancyMeasure`]: how far apart two worlds are by the cells that objects stand in. What is measured between
//! grids is in the crate's `occupancy/`.

use driftworld_spec::World;
use strum::VariantArray;

use crate::{
    Grid, GridShape, MetricProperties, Raster, SimilarityError, grid_chamfer_distance, grid_earth_movers_distance,
    grid_hausdorff_distance, grid_jaccard_distance,
};

/// Side of a cell in metres.
const CELL: f64 = 1.0;

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
    /// [`grid_jaccard_distance`]: the share of taken cells that are not taken in both, in `0..=1`. From an empty world
    /// to another: 1.
    Jaccard,
    /// [`grid_hausdorff_distance`]: the largest way in metres from a taken cell to the nearest that the class takes in
    /// the other world, in `0..=` diameter; the diameter where a class is in one world only.
    Hausdorff,
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
            Self::EarthMovers | Self::Hausdorff | Self::Chamfer => "metres",
            Self::Jaccard => "share of taken cells",
        }
    }

    /// Which laws it keeps among worlds of one arena: what stands elsewhere in the same cells is 0 apart.
    pub fn properties(self) -> MetricProperties {
        match self {
            Self::EarthMovers | Self::Jaccard | Self::Hausdorff => MetricProperties::Pseudometric,
            Self::Chamfer => MetricProperties::Distance,
        }
    }

    pub(super) fn label(self) -> &'static str {
        match self {
            Self::EarthMovers => "earth_movers in metres",
            Self::Jaccard => "jaccard in shares of taken cells",
            Self::Hausdorff => "hausdorff in metres",
            Self::Chamfer => "chamfer in metres",
        }
    }

    pub(super) fn between(self, a: &World, b: &World) -> Result<f64, SimilarityError> {
        let grids = grids(a, b)?;
        let [a, b] = &grids;
        let taken = [a.taken(), b.taken()];
        match self {
            Self::EarthMovers => over_classes(a, b),
            Self::Jaccard => grid_jaccard_distance(&taken[0], &taken[1]),
            Self::Hausdorff => grid_hausdorff_distance(&taken[0], &taken[1]),
            Self::Chamfer => grid_chamfer_distance(&taken[0], &taken[1]),
        }
    }
}

/// The raster of these worlds' arenas and classes.
pub(super) fn raster(worlds: &[&World]) -> Result<Raster, SimilarityError> {
    let mut cell = CELL;
    loop {
        match Raster::of_worlds(worlds, cell) {
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
/// that stands in one world only. Masses are whole, so that cells that hold equal shares of a class hold equal masses.
fn over_classes(a: &Grid, b: &Grid) -> Result<f64, SimilarityError> {
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
