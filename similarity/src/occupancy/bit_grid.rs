//! [`BitGrid`]: which cells are taken, a bit for each. How much stands in them is in `grid.rs`.

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
    /// Cells in the order `(planes, rows, columns)`; cells that are not told of are free, what is beyond the last is left out.
    pub fn new(shape: GridShape, taken: impl IntoIterator<Item = bool>) -> Self {
        let mut words = vec![0u64; shape.num_cells().div_ceil(64)];
        for (index, taken) in taken.into_iter().take(shape.num_cells()).enumerate() {
            words[index / 64] |= u64::from(taken) << (index % 64);
        }
        let count = words.iter().map(|word| word.count_ones() as usize).sum();
        Self { shape, words, count }
    }

    /// How many cells there are, and how large they are.
    pub fn shape(&self) -> GridShape {
        self.shape
    }

    /// How many cells are taken.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Whether a cell is taken, by its number in the order `(planes, rows, columns)`; what is beyond the last is not.
    pub fn is_taken(&self, cell: usize) -> bool {
        self.words
            .get(cell / 64)
            .is_some_and(|word| word >> (cell % 64) & 1 == 1)
    }

    /// How many cells are taken in both.
    ///
    /// # Errors
    /// [`SimilarityError::GridsDiffer`] when the shapes do.
    pub fn common(&self, other: &Self) -> Result<usize, SimilarityError> {
        self.shape.check(other.shape)?;
        Ok(ones_in_both(&self.words, &other.words))
    }
}

const PAIRS: u64 = 0x5555_5555_5555_5555;
const FOURS: u64 = 0x3333_3333_3333_3333;
const BYTES: u64 = 0x0f0f_0f0f_0f0f_0f0f;

/// Bits set in both lists. Bytes are summed within their words over a stretch before the words are summed up: without a popcount
/// instruction, which the oldest processors lack, this takes half the time of `count_ones` word by word.
fn ones_in_both(a: &[u64], b: &[u64]) -> usize {
    // 31 words add up to at most 31 · 8 = 248 in each byte.
    let mut total = 0;
    for (a, b) in a.chunks(31).zip(b.chunks(31)) {
        let mut bytes = 0u64;
        for (a, b) in a.iter().zip(b) {
            let word = a & b;
            let pairs = word - (word >> 1 & PAIRS);
            let fours = (pairs & FOURS) + (pairs >> 2 & FOURS);
            bytes += (fours + (fours >> 4)) & BYTES;
        }
        total += bytes.to_le_bytes().iter().map(|&byte| usize::from(byte)).sum::<usize>();
    }
    total
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn full_words_do_not_overflow_their_bytes() {
        let full = vec![u64::MAX; 100];
        assert_eq!(ones_in_both(&full, &full), 6400);
    }

    #[test]
    fn what_lies_beyond_the_last_cell_is_free() {
        let grid = BitGrid::new(GridShape::new(3, 1, 1, 1.0).unwrap(), [true; 9]);
        assert_eq!(
            (grid.count(), grid.is_taken(2), grid.is_taken(3), grid.is_taken(999)),
            (3, true, false, false)
        );
    }

    proptest! {
        #[test]
        fn bits_in_both_are_counted_one_by_one(a in prop::collection::vec(any::<u64>(), 0..80), b in prop::collection::vec(any::<u64>(), 80)) {
            let expected: u32 = a.iter().zip(&b).map(|(a, b)| (a & b).count_ones()).sum();
            prop_assert_eq!(ones_in_both(&a, &b[..a.len()]), expected as usize);
        }
    }
}
