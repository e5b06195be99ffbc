//! [`BitGrid`]: which cells are taken, one bit each.

use super::grid::GridShape;
use crate::SimilarityError;

/// Which cells are taken. 64 cells are compared at once.
///
/// # Example
/// ```
/// use driftworld_similarity::{BitGrid, GridShape, grid_jaccard_distance};
/// let shape = GridShape::new(4, 1, 1, 1.0)?;
/// let a = BitGrid::new(shape, [true, true, false, false]);
/// let b = BitGrid::new(shape, [false, true, true, false]);
/// assert_eq!(a.count(), 2);
/// assert_eq!(grid_jaccard_distance(&a, &b)?, 2.0 / 3.0);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct BitGrid {
    shape: GridShape,
    words: Vec<u64>,
    count: usize,
}

impl BitGrid {
    /// Cells in the order `(planes, rows, columns)`; missing cells are free, extra ones are ignored.
    pub fn new(shape: GridShape, taken: impl IntoIterator<Item = bool>) -> Self {
        let mut words = vec![0u64; shape.num_cells().div_ceil(64)];
        for (index, taken) in taken.into_iter().take(shape.num_cells()).enumerate() {
            words[index / 64] |= u64::from(taken) << (index % 64);
        }
        let count = words.iter().map(|word| word.count_ones() as usize).sum();
        Self { shape, words, count }
    }

    /// Number and size of the cells.
    pub fn shape(&self) -> GridShape {
        self.shape
    }

    /// Number of taken cells.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether a cell is taken, by its index in the order `(planes, rows, columns)`; cells beyond the last are free.
    pub fn is_taken(&self, cell: usize) -> bool {
        self.words
            .get(cell / 64)
            .is_some_and(|word| word >> (cell % 64) & 1 == 1)
    }

    /// Number of cells taken in both.
    ///
    /// # Errors
    /// [`SimilarityError::GridsDiffer`] if the shapes differ.
    pub fn common(&self, other: &Self) -> Result<usize, SimilarityError> {
        self.shape.check(other.shape)?;
        let both = self.words.iter().zip(&other.words).map(|(a, b)| a & b);
        Ok(both.map(|word| word.count_ones() as usize).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_beyond_the_last_are_free() {
        let grid = BitGrid::new(GridShape::new(3, 1, 1, 1.0).unwrap(), [true; 9]);
        assert_eq!(
            (grid.count(), grid.is_taken(2), grid.is_taken(3), grid.is_taken(999)),
            (3, true, false, false)
        );
    }
}
