//! [`Raster`]: how worlds become grids. What is measured between grids is in the files of the measures.

use std::collections::BTreeSet;

use driftworld_spec::{Object, World};

use super::bit_grid::BitGrid;
use super::grid::{Grid, GridShape};
use crate::SimilarityError;

/// A rectangle on the ground, in metres: x east, y north.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// The south-western corner.
    pub low: [f64; 2],
    /// The north-eastern corner, above `low` in both.
    pub high: [f64; 2],
}

impl Extent {
    /// The arena of a world, which lies around the origin.
    pub fn of_arena(world: &World) -> Self {
        let [width, depth] = world.environment_params.arena_size();
        Self {
            low: [-width / 2.0, -depth / 2.0],
            high: [width / 2.0, depth / 2.0],
        }
    }

    /// The smallest that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        let pick = |f: fn(f64, f64) -> f64, a: [f64; 2], b: [f64; 2]| [f(a[0], b[0]), f(a[1], b[1])];
        Self {
            low: pick(f64::min, self.low, other.low),
            high: pick(f64::max, self.high, other.high),
        }
    }
}

/// Whether objects of different classes in one cell are the same to an occupancy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Classes {
    /// Each class has a grid of its own.
    Separate,
    /// All share one grid.
    Merged,
}

/// How worlds become grids: an extent, cut into square cells from its south-western corner on, and the classes that are told apart.
///
/// An object on the line between two cells belongs to that in the north or east, on the outer line of the extent to the last cell;
/// objects outside are not counted. Grids of one raster can be compared.
///
/// # Example
/// ```
/// use driftworld_similarity::{Classes, Raster, grid_jaccard_distance};
/// use driftworld_spec::{Object, World};
/// let world = |x| World::default().edit(|world| world.objects.push(Object::new("tree", [x, 1.0])));
/// let (a, b) = (world(3.0)?, world(4.0)?);
/// let raster = Raster::of_worlds([&a, &b], 2.0, Classes::Separate)?;
/// assert_eq!((raster.shape().columns(), raster.shape().rows()), (50, 50));
/// assert_eq!(grid_jaccard_distance(&raster.taken(&a)?, &raster.taken(&b)?)?, 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Raster {
    shape: GridShape,
    low: [f64; 2],
    high: [f64; 2],
    /// In lower case and alphabetical; `None` for one plane that holds all.
    classes: Option<Vec<String>>,
}

impl Raster {
    /// One plane for all classes. `cell`: side of a cell in metres; the last cells may reach beyond the extent.
    ///
    /// # Errors
    /// [`SimilarityError::BadNumber`] for an extent without area or a cell without size, [`SimilarityError::TooFine`] for too many
    /// cells.
    pub fn merged(extent: Extent, cell: f64) -> Result<Self, SimilarityError> {
        Self::new(extent, cell, None)
    }

    /// A plane for each of these classes, whose case does not matter; worlds with other ones are refused.
    ///
    /// # Errors
    /// As [`Raster::merged`].
    pub fn by_class<'a>(
        extent: Extent,
        cell: f64,
        classes: impl IntoIterator<Item = &'a str>,
    ) -> Result<Self, SimilarityError> {
        let classes: BTreeSet<String> = classes.into_iter().map(str::to_lowercase).collect();
        Self::new(extent, cell, Some(classes.into_iter().collect()))
    }

    /// One that holds the arenas and the classes of all these worlds.
    ///
    /// # Errors
    /// As [`Raster::merged`]; [`SimilarityError::Empty`] without worlds.
    pub fn of_worlds<'a>(
        worlds: impl IntoIterator<Item = &'a World>,
        cell: f64,
        classes: Classes,
    ) -> Result<Self, SimilarityError> {
        let mut extent: Option<Extent> = None;
        let mut names = BTreeSet::new();
        for world in worlds {
            let arena = Extent::of_arena(world);
            extent = Some(extent.map_or(arena, |extent| extent.union(arena)));
            if classes == Classes::Separate {
                names.extend(world.objects.iter().map(|object| object.class.to_lowercase()));
            }
        }
        let extent = extent.ok_or(SimilarityError::Empty)?;
        let names = (classes == Classes::Separate).then(|| names.into_iter().collect());
        Self::new(extent, cell, names)
    }

    fn new(extent: Extent, cell: f64, classes: Option<Vec<String>>) -> Result<Self, SimilarityError> {
        let Extent { low, high } = extent;
        let side = |axis: usize| {
            let found = high[axis] - low[axis];
            if found > 0.0 && found <= 1e9 {
                // A few cells more or less than MAX_CELLS are told apart there; far more saturate.
                return Ok((found / cell).ceil() as usize);
            }
            Err(SimilarityError::BadNumber {
                of: "side of the extent",
                found,
                expected: "a number of metres above 0, up to 1e9",
            })
        };
        let planes = classes.as_ref().map_or(1, Vec::len);
        let shape = GridShape::new(side(0)?, side(1)?, planes, cell)?;
        Ok(Self {
            shape,
            low,
            high,
            classes,
        })
    }

    /// How many cells its grids have, and how large they are.
    pub fn shape(&self) -> GridShape {
        self.shape
    }

    /// The class of each plane, in lower case and alphabetical; nothing if classes are merged.
    pub fn classes(&self) -> &[String] {
        self.classes.as_deref().unwrap_or_default()
    }

    /// How many objects have their centre in each cell.
    ///
    /// # Errors
    /// [`SimilarityError::UnknownClass`] for an object whose class has no plane.
    pub fn counts(&self, world: &World) -> Result<Grid, SimilarityError> {
        self.counts_of_footprints(world, |_| 0.0)
    }

    /// How many objects cover each cell at least in part. `radius` tells how far an object reaches from its centre, in metres: what
    /// takes up the ground is known to the simulator, not here (`|object| 0.5 * object.scale` is a fair guess). An object covers
    /// the cell of its centre and every cell that its disc overlaps; one that reaches in from outside the extent counts.
    ///
    /// # Errors
    /// As [`Raster::counts`]; [`SimilarityError::BadNumber`] for a radius that is negative or not finite.
    pub fn counts_of_footprints(
        &self,
        world: &World,
        radius: impl Fn(&Object) -> f64,
    ) -> Result<Grid, SimilarityError> {
        let mut masses = vec![0.0; self.shape.num_cells()];
        self.cover(world, radius, |cell| masses[cell] += 1.0)?;
        Grid::new(self.shape, masses)
    }

    /// Which cells hold the centre of an object.
    ///
    /// # Errors
    /// As [`Raster::counts`].
    pub fn taken(&self, world: &World) -> Result<BitGrid, SimilarityError> {
        let mut taken = vec![false; self.shape.num_cells()];
        self.cover(world, |_| 0.0, |cell| taken[cell] = true)?;
        Ok(BitGrid::new(self.shape, taken))
    }

    /// Tells every cell that an object covers, object by object.
    fn cover(
        &self,
        world: &World,
        radius: impl Fn(&Object) -> f64,
        mut tell: impl FnMut(usize),
    ) -> Result<(), SimilarityError> {
        let (columns, rows) = (self.shape.columns(), self.shape.rows());
        for object in &world.objects {
            let plane = self.plane(object)?;
            let reach = radius(object);
            if !(0.0..=1e9).contains(&reach) {
                return Err(SimilarityError::BadNumber {
                    of: "radius of an object",
                    found: reach,
                    expected: "a number of metres from 0 to 1e9",
                });
            }
            let [x, y] = object.coordinates;
            let home = (self.index(x, 0), self.index(y, 1));
            let (east, north) = (self.range(x, reach, 0), self.range(y, reach, 1));
            for row in north {
                for column in east.clone() {
                    let overlaps = libm::hypot(self.gap(x, column, 0), self.gap(y, row, 1)) < reach;
                    if overlaps || home == (Some(column), Some(row)) {
                        tell((plane * rows + row) * columns + column);
                    }
                }
            }
        }
        Ok(())
    }

    fn plane(&self, object: &Object) -> Result<usize, SimilarityError> {
        let Some(classes) = &self.classes else {
            return Ok(0);
        };
        let class = object.class.to_lowercase();
        classes
            .binary_search(&class)
            .map_err(|_| SimilarityError::UnknownClass {
                found: class,
                expected: classes.join(", "),
            })
    }

    fn cells(&self, axis: usize) -> usize {
        if axis == 0 {
            self.shape.columns()
        } else {
            self.shape.rows()
        }
    }

    /// The column or row of a coordinate, if it is inside.
    fn index(&self, metres: f64, axis: usize) -> Option<usize> {
        let inside = self.low[axis] <= metres && metres <= self.high[axis];
        let index = ((metres - self.low[axis]) / self.shape.cell()).floor() as usize;
        inside.then(|| index.min(self.cells(axis) - 1))
    }

    /// The columns or rows that an object may reach: those of its outermost points, and none if it is outside.
    fn range(&self, metres: f64, reach: f64, axis: usize) -> std::ops::Range<usize> {
        let cell = |metres: f64| ((metres - self.low[axis]) / self.shape.cell()).floor();
        let last = self.cells(axis) as f64;
        let end = if metres == self.high[axis] {
            last
        } else {
            (cell(metres + reach) + 1.0).min(last)
        };
        // A saturating cast: what lies to the south or west of all cells is 0.
        let first = cell(metres - reach).min(last - 1.0) as usize;
        first..(end.max(0.0) as usize)
    }

    /// How far a coordinate is from a column or row; 0 within.
    fn gap(&self, metres: f64, index: usize, axis: usize) -> f64 {
        let low = self.low[axis] + index as f64 * self.shape.cell();
        (low - metres).max(metres - low - self.shape.cell()).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SQUARE: Extent = Extent {
        low: [-2.0, -2.0],
        high: [2.0, 2.0],
    };

    fn world(places: &[(&str, f64, f64)]) -> World {
        let objects = places.iter().map(|&(class, x, y)| Object::new(class, [x, y]));
        World::default().edit(|world| world.objects.extend(objects)).unwrap()
    }

    #[track_caller]
    fn check(raster: &Raster, places: &[(&str, f64, f64)], radius: f64, expected: &[usize]) {
        let grid = raster.counts_of_footprints(&world(places), |_| radius).unwrap();
        let cells: Vec<usize> = (0..grid.masses().len())
            .flat_map(|cell| std::iter::repeat_n(cell, grid.masses()[cell] as usize))
            .collect();
        assert_eq!(cells, expected);
    }

    #[test]
    fn centres_fall_into_cells_from_the_south_west() {
        let raster = Raster::merged(SQUARE, 1.0).unwrap();
        check(&raster, &[("a", -2.0, -2.0), ("b", -0.5, -1.5)], 0.0, &[0, 1]);
        check(&raster, &[("on a line", 0.0, 0.0)], 0.0, &[10]);
        check(&raster, &[("on the outer line", 2.0, 2.0)], 0.0, &[15]);
        check(&raster, &[("outside", 2.1, 0.0), ("outside", 0.0, -3.0)], 0.0, &[]);
        check(&raster, &[("twice", 0.5, 0.5), ("twice", 0.6, 0.6)], 0.0, &[10, 10]);
    }

    #[test]
    fn footprints_cover_what_their_disc_overlaps() {
        let raster = Raster::merged(SQUARE, 1.0).unwrap();
        check(&raster, &[("small", 0.5, 0.5)], 0.4, &[10]);
        check(&raster, &[("touching four", 0.5, 0.5)], 0.6, &[6, 9, 10, 11, 14]);
        check(
            &raster,
            &[("over corners", 0.5, 0.5)],
            0.8,
            &[5, 6, 7, 9, 10, 11, 13, 14, 15],
        );
        check(&raster, &[("from outside", 2.5, 0.5)], 0.6, &[11]);
        check(&raster, &[("far outside", 9.0, 9.0)], 0.6, &[]);
    }

    #[test]
    fn each_class_has_a_plane_whatever_its_case() {
        let raster = Raster::by_class(SQUARE, 2.0, ["Tree", "rock"]).unwrap();
        assert_eq!(raster.classes(), ["rock", "tree"]);
        check(&raster, &[("TREE", 1.0, 1.0), ("rock", -1.0, -1.0)], 0.0, &[0, 7]);
        let found = raster.counts(&world(&[("lamp", 0.0, 0.0)])).unwrap_err();
        assert_eq!(found.code(), "similarity/unknown-class");
    }

    #[test]
    fn a_raster_of_worlds_holds_the_largest_arena() {
        let small = world(&[("tree", 0.0, 0.0)]);
        let large = World::default()
            .edit(|world| world.environment_params.map_size = [120.0, 10.0])
            .unwrap();
        let raster = Raster::of_worlds([&small, &large], 7.0, Classes::Separate).unwrap();
        let shape = raster.shape();
        assert_eq!((shape.columns(), shape.rows(), shape.planes()), (18, 15, 1));
        let none = Raster::of_worlds([], 1.0, Classes::Merged).unwrap_err();
        assert_eq!(none.code(), "similarity/empty");
    }

    #[test]
    fn extents_and_radii_that_are_none_are_refused() {
        let flat = Extent {
            low: [0.0, 0.0],
            high: [0.0, 1.0],
        };
        assert_eq!(Raster::merged(flat, 1.0).unwrap_err().code(), "similarity/bad-number");
        assert_eq!(
            Raster::merged(SQUARE, -1.0).unwrap_err().code(),
            "similarity/bad-number"
        );
        assert_eq!(Raster::merged(SQUARE, 1e-5).unwrap_err().code(), "similarity/too-fine");
        let raster = Raster::merged(SQUARE, 1.0).unwrap();
        let found = raster.counts_of_footprints(&world(&[("tree", 0.0, 0.0)]), |_| f64::NAN);
        assert_eq!(found.unwrap_err().code(), "similarity/bad-number");
    }
}
