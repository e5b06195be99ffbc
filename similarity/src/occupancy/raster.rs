//! [`Raster`]: turns worlds into grids.

use std::collections::BTreeSet;

use driftworld_spec::World;

use super::grid::{DEFAULT_CELL, Grid, GridShape};
use crate::SimilarityError;

/// A common raster for worlds: the smallest area around the origin that holds all their arenas, divided into square cells
/// starting at its south-western corner, with a plane for each class.
///
/// An object on the line between two cells belongs to the northern or eastern one, an object on the outer edge to the last cell;
/// objects outside are not counted. Grids of the same raster can be compared.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Raster {
    shape: GridShape,
    /// The north-eastern corner; the south-western corner is its negative.
    high: [f64; 2],
    /// In lower case, sorted.
    classes: Vec<String>,
}

impl Raster {
    /// A raster for these worlds, with cells of 1 m, or of 2, 4, 8 … m for arenas that are too large for that.
    ///
    /// # Errors
    /// As [`Raster::of_worlds`].
    pub(crate) fn fitting(worlds: &[&World]) -> Result<Self, SimilarityError> {
        let mut cell = DEFAULT_CELL;
        loop {
            match Self::of_worlds(worlds, cell) {
                // Large enough cells always fit: there are fewer classes than the limit of cells.
                Err(SimilarityError::TooFine { .. }) if cell < 1e6 => cell *= 2.0,
                result => return result,
            }
        }
    }

    /// A raster that holds the arenas and the classes of all these worlds. `cell`: side of a cell in metres; the last cells may
    /// reach beyond the arenas.
    ///
    /// # Errors
    /// [`SimilarityError::BadNumber`] for a cell without size, [`SimilarityError::TooFine`] for too many cells.
    pub(crate) fn of_worlds(worlds: &[&World], cell: f64) -> Result<Self, SimilarityError> {
        let mut high = [0.0_f64; 2];
        let mut classes = BTreeSet::new();
        for world in worlds {
            let [width, depth] = world.environment_params.arena_size();
            high = [high[0].max(width / 2.0), high[1].max(depth / 2.0)];
            classes.extend(world.objects.iter().map(|object| object.class.to_lowercase()));
        }
        let [columns, rows] = high.map(|high| (2.0 * high / cell).ceil() as usize);
        Ok(Self {
            shape: GridShape::new(columns, rows, classes.len(), cell)?,
            high,
            classes: classes.into_iter().collect(),
        })
    }

    /// Number and size of its grids' cells.
    pub(crate) fn shape(&self) -> GridShape {
        self.shape
    }

    /// Number of objects with their centre in each cell; objects of other classes are ignored.
    ///
    /// # Errors
    /// As [`Grid::new`].
    pub(crate) fn counts(&self, world: &World) -> Result<Grid, SimilarityError> {
        let (columns, rows) = (self.shape.columns(), self.shape.rows());
        let mut masses = vec![0.0; self.shape.num_cells()];
        for object in &world.objects {
            let plane = self.classes.binary_search(&object.class.to_lowercase()).ok();
            let [x, y] = object.coordinates;
            let (column, row) = (self.index(x, self.high[0], columns), self.index(y, self.high[1], rows));
            if let (Some(plane), Some(column), Some(row)) = (plane, column, row) {
                masses[(plane * rows + row) * columns + column] += 1.0;
            }
        }
        Grid::new(self.shape, masses)
    }

    /// The column or row of a coordinate, if it is inside.
    fn index(&self, metres: f64, high: f64, cells: usize) -> Option<usize> {
        let inside = -high <= metres && metres <= high;
        let index = ((metres + high) / self.shape.cell()).floor() as usize;
        inside.then(|| index.min(cells - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_spec::Object;

    fn world(places: &[(&str, f64, f64)]) -> World {
        let objects = places.iter().map(|&(class, x, y)| Object::new(class, [x, y]));
        let world = World::default().edit(|world| {
            world.environment_params.map_size = [4.0; 2];
            world.objects.extend(objects);
        });
        world.unwrap()
    }

    #[track_caller]
    fn check(places: &[(&str, f64, f64)], expected: &[usize]) {
        let world = world(places);
        let grid = Raster::of_worlds(&[&world], 1.0).unwrap().counts(&world).unwrap();
        let cells: Vec<usize> = (0..grid.masses().len())
            .flat_map(|cell| std::iter::repeat_n(cell, grid.masses()[cell] as usize))
            .collect();
        assert_eq!(cells, expected);
    }

    #[test]
    fn centres_fall_into_cells_from_the_south_west() {
        check(&[("a", -2.0, -2.0), ("a", -0.5, -1.5)], &[0, 1]);
        check(&[("on a line", 0.0, 0.0)], &[10]);
        check(&[("on the outer line", 2.0, 2.0)], &[15]);
        check(&[("outside", 2.1, 0.0), ("outside", 0.0, -3.0)], &[]);
        check(&[("twice", 0.5, 0.5), ("twice", 0.6, 0.6)], &[10, 10]);
    }

    #[test]
    fn each_class_has_a_plane_ignoring_case() {
        check(
            &[("TREE", 1.0, 1.0), ("rock", -2.0, -2.0), ("Tree", -2.0, -2.0)],
            &[0, 16, 31],
        );
    }

    #[test]
    fn raster_of_several_worlds_holds_the_largest_arena() {
        let small = world(&[("tree", 0.0, 0.0)]);
        let large = World::default()
            .edit(|world| world.environment_params.map_size = [120.0, 10.0])
            .unwrap();
        let shape = Raster::of_worlds(&[&small, &large], 7.0).unwrap().shape();
        assert_eq!((shape.columns(), shape.rows(), shape.planes()), (18, 2, 1));
        let error = Raster::of_worlds(&[&small], 1e-5).unwrap_err();
        assert_eq!(error.code(), "similarity/too-fine");
    }
}
