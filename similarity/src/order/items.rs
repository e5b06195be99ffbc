//! [`Items`]: the items of a matrix, numbered by name for the ordering methods.

use super::options::OrderOptions;
use crate::{DistanceMatrix, SimilarityError};

/// The fixed ends of a path.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Ends {
    pub(super) first: Option<usize>,
    pub(super) last: Option<usize>,
}

/// The items of a matrix, numbered by name: ties go to the lowest number, so the order of items in the matrix does not matter.
pub(super) struct Items<'a> {
    pub(super) matrix: &'a DistanceMatrix,
    /// The fixed ends, as ranks.
    pub(super) ends: Ends,
    by_name: Vec<usize>,
}

impl<'a> Items<'a> {
    pub(super) fn new(matrix: &'a DistanceMatrix, options: &OrderOptions) -> Result<Self, SimilarityError> {
        let n = matrix.len();
        if n == 0 {
            return Err(SimilarityError::Empty);
        }
        for (end, item) in [("first", options.first), ("last", options.last)] {
            if let Some(found) = item.filter(|item| *item >= n) {
                return Err(SimilarityError::NoSuchEnd {
                    end,
                    found,
                    most: n - 1,
                });
            }
        }
        if let (Some(first), Some(last)) = (options.first, options.last)
            && first == last
            && n > 1
        {
            let label = matrix.labels()[first].clone();
            return Err(SimilarityError::EqualEnds { label });
        }
        let mut by_name: Vec<usize> = (0..n).collect();
        by_name.sort_by(|a, b| matrix.labels()[*a].cmp(&matrix.labels()[*b]));
        let rank = |index: usize| by_name.iter().position(|item| *item == index);
        // A single item is already the first, so it is not fixed as the last as well.
        let last = if n == 1 { None } else { options.last.and_then(rank) };
        let first = options.first.and_then(rank);
        Ok(Self {
            matrix,
            ends: Ends { first, last },
            by_name,
        })
    }

    /// Number of items.
    pub(super) fn len(&self) -> usize {
        self.by_name.len()
    }

    /// The distance between two items, by rank.
    pub(super) fn gap(&self, a: usize, b: usize) -> f64 {
        self.matrix.get(self.by_name[a], self.by_name[b])
    }

    /// The largest distance.
    pub(super) fn largest_gap(&self) -> f64 {
        self.matrix.values().iter().copied().fold(0.0, f64::max)
    }

    /// Maps ranks to indices in the matrix.
    pub(super) fn indices(&self, ranks: &[usize]) -> Vec<usize> {
        ranks.iter().map(|rank| self.by_name[*rank]).collect()
    }

    /// The ranks of the items in the matrix's order.
    pub(super) fn as_given(&self) -> Vec<usize> {
        let mut ranks = vec![0; self.len()];
        for (rank, index) in self.by_name.iter().enumerate() {
            ranks[*index] = rank;
        }
        ranks
    }

    /// The same order, with the fixed first and last items moved to the ends.
    pub(super) fn with_fixed_ends(&self, mut ranks: Vec<usize>) -> Vec<usize> {
        let Ends { first, last } = self.ends;
        ranks.retain(|rank| Some(*rank) != first && Some(*rank) != last);
        first.into_iter().chain(ranks).chain(last).collect()
    }
}

/// Ranks in order of increasing value. Values are compared in steps of 1e-9 of their span, so that rounding errors do not decide ties;
/// the names decide between equal values.
pub(super) fn ascending_ranks(values: &[f64]) -> Vec<usize> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let span = if high > low { high - low } else { 1.0 };
    let key = |rank: usize| ((values[rank] - low) / span * 1e9).round() as i64;
    let mut ranks: Vec<usize> = (0..values.len()).collect();
    ranks.sort_by_key(|rank| key(*rank));
    ranks
}
