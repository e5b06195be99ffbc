//! [`Grid`]: the mass in each cell.

use super::bit_grid::BitGrid;
use crate::SimilarityError;

/// Maximum number of cells in a grid, all planes together.
pub const MAX_CELLS: usize = 1 << 20;

/// Default side of a cell in metres, unless that makes too many cells.
pub(super) const DEFAULT_CELL: f64 = 1.0;

/// Number and size of the cells. Grids can be compared if their shapes are equal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridShape {
    columns: usize,
    rows: usize,
    planes: usize,
    cell: f64,
}

impl GridShape {
    /// `columns` from west to east, `rows` from south to north, `planes` one above the other (one for each class, or one for
    /// all), and the side of a cell in metres, 1e-6 to 1e6.
    ///
    /// # Errors
    /// [`SimilarityError::TooFine`] for more than [`MAX_CELLS`] cells, [`SimilarityError::BadNumber`] for a side out of range.
    pub fn new(columns: usize, rows: usize, planes: usize, cell: f64) -> Result<Self, SimilarityError> {
        if !(1e-6..=1e6).contains(&cell) {
            return Err(SimilarityError::BadNumber {
                of: "side of a cell",
                found: cell,
                expected: "a number of metres from 1e-6 to 1e6",
            });
        }
        let found = columns.saturating_mul(rows).saturating_mul(planes);
        if found > MAX_CELLS {
            let limit = MAX_CELLS;
            return Err(SimilarityError::TooFine { found, limit });
        }
        Ok(Self {
            columns,
            rows,
            planes,
            cell,
        })
    }

    /// Cells from west to east.
    pub fn columns(&self) -> usize {
        self.columns
    }

    /// Cells from south to north.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Layers of cells, one for each class.
    pub fn planes(&self) -> usize {
        self.planes
    }

    /// Side of a cell in metres.
    pub fn cell(&self) -> f64 {
        self.cell
    }

    /// Number of cells in all planes.
    pub fn num_cells(&self) -> usize {
        self.columns * self.rows * self.planes
    }

    /// Distance in metres between the centres of opposite corners: the largest between two cells.
    pub fn diameter(&self) -> f64 {
        let (x, y) = (self.columns.saturating_sub(1), self.rows.saturating_sub(1));
        ((x * x + y * y) as f64).sqrt() * self.cell
    }

    /// Fails if two shapes differ.
    pub(crate) fn check(self, other: Self) -> Result<(), SimilarityError> {
        if self == other {
            return Ok(());
        }
        let words = |shape: Self| {
            let Self {
                columns,
                rows,
                planes,
                cell,
            } = shape;
            format!("{columns} × {rows} × {planes} cells of {cell} m")
        };
        let (a, b) = (words(self), words(other));
        Err(SimilarityError::GridsDiffer { a, b })
    }
}

/// The mass in each cell: a number of objects, or any other mass.
///
/// # Example
/// ```
/// use driftworld_similarity::{Grid, GridShape};
/// let grid = Grid::new(GridShape::new(3, 2, 1, 1.0)?, vec![0.0, 2.0, 0.0, 0.0, 0.0, 1.0])?;
/// assert_eq!(grid.total(), 3.0);
/// assert_eq!(grid.taken().count(), 2);
/// assert_eq!(grid.normalised().masses()[1], 2.0 / 3.0);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Grid {
    shape: GridShape,
    masses: Vec<f64>,
}

impl Grid {
    /// `masses`: `(planes, rows, columns)`, at least 0, any unit; row 0 is the southernmost.
    ///
    /// # Errors
    /// [`SimilarityError::Shape`] if the number of masses differs from the number of cells,
    /// [`SimilarityError::BadMass`] for a mass that is negative, not finite or above 1e200.
    pub fn new(shape: GridShape, masses: Vec<f64>) -> Result<Self, SimilarityError> {
        SimilarityError::check_length("cells", masses.len(), shape.num_cells())?;
        crate::transport::sum_of_masses("cells", &masses)?;
        Ok(Self { shape, masses })
    }

    /// Number and size of the cells.
    pub fn shape(&self) -> GridShape {
        self.shape
    }

    /// The mass of each cell, `(planes, rows, columns)`.
    pub fn masses(&self) -> &[f64] {
        &self.masses
    }

    /// The mass of all cells together.
    pub fn total(&self) -> f64 {
        self.masses.iter().sum()
    }

    /// Scales each plane to a total of 1; empty planes stay empty. Makes grids of unequal masses comparable if only the
    /// positions matter, not the amounts.
    #[must_use]
    pub fn normalised(&self) -> Self {
        let mut masses = self.masses.clone();
        for plane in masses.chunks_mut(self.plane_len().max(1)) {
            let sum: f64 = plane.iter().sum();
            if sum > 0.0 {
                for mass in plane {
                    *mass /= sum;
                }
            }
        }
        Self { masses, ..*self }
    }

    /// Which cells have any mass.
    pub fn taken(&self) -> BitGrid {
        BitGrid::new(self.shape, self.masses.iter().map(|mass| *mass > 0.0))
    }

    /// Iterates over the planes.
    pub(super) fn planes(&self) -> impl Iterator<Item = &[f64]> {
        self.masses.chunks(self.plane_len().max(1))
    }

    fn plane_len(&self) -> usize {
        self.shape.columns * self.shape.rows
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mass_count_and_sign_are_checked() {
        let shape = GridShape::new(2, 2, 1, 1.0).unwrap();
        let code = |masses: Vec<f64>| Grid::new(shape, masses).unwrap_err().code();
        assert_eq!(code(vec![1.0; 3]), "similarity/shape");
        assert_eq!(code(vec![1.0, 0.0, -1.0, 0.0]), "similarity/bad-mass");
        assert_eq!(code(vec![1.0, 0.0, f64::NAN, 0.0]), "similarity/bad-mass");
    }

    #[test]
    fn too_many_cells_and_cells_without_size_are_refused() {
        let code = |columns, cell| GridShape::new(columns, 2000, 1, cell).unwrap_err().code();
        assert_eq!(code(2000, 1.0), "similarity/too-fine");
        assert_eq!(code(usize::MAX, 1.0), "similarity/too-fine");
        assert_eq!(code(2, 0.0), "similarity/bad-number");
        assert_eq!(code(2, f64::NAN), "similarity/bad-number");
    }

    #[test]
    fn each_plane_is_normalised_by_itself() {
        let shape = GridShape::new(2, 1, 3, 1.0).unwrap();
        let grid = Grid::new(shape, vec![1.0, 3.0, 0.0, 0.0, 0.0, 5.0]).unwrap();
        assert_eq!(grid.normalised().masses(), [0.25, 0.75, 0.0, 0.0, 0.0, 1.0]);
    }
}
