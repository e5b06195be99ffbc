//! [`Assignment`]: the cheapest way to pair rows with columns.
//!
//! Implemented here, because no crate fits: `lapjv` takes square matrices only, compares costs with one absolute tolerance and
//! is no longer developed; `pathfinding::kuhn_munkres` needs `Ord` costs, which `f64` is not, panics if there are more rows than
//! columns, and allocates memory for every matrix.

use crate::SimilarityError;
use crate::transport::check_costs;

/// Maximum number of rows, and of columns, of an assignment.
pub const MAX_ASSIGNED: usize = 4096;

/// Marks an unpaired row or column in the buffers.
const NONE: usize = usize::MAX;

/// Pairs rows with columns so that the sum of the costs is minimal, and reuses its memory for the next matrix.
///
/// Each row and each column is in at most one pair, and the number of pairs is the length of the shorter side. Exact up to
/// the rounding of `f64`. Deterministic, even if several pairings are equally cheap. Time `O(rows · columns · shorter side)` at
/// worst and often far less; allocates nothing for sizes that it has handled before.
///
/// Source: Jonker and Volgenant 1987, "A shortest augmenting path algorithm for dense and sparse linear assignment problems"
/// (without column reduction, which is valid for square matrices only); the same sums as
/// `scipy.optimize.linear_sum_assignment`, see `tests/oracle/assignment.json`.
///
/// # Example
/// ```
/// use driftworld_similarity::Assignment;
/// let mut assignment = Assignment::new();
/// // Two rows, three columns.
/// let total = assignment.solve(&[1.0, 2.0, 9.0, 1.0, 4.0, 9.0], 2, 3)?;
/// assert_eq!(total, 3.0);
/// assert_eq!(assignment.partners(), [Some(1), Some(0)]);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct Assignment {
    partners: Vec<Option<usize>>,
    /// The transposed costs, if there are more rows than columns.
    transposed: Vec<f64>,
    column_of: Vec<usize>,
    row_of: Vec<usize>,
    /// The dual price of each column, at most 0; exactly 0 for unpaired columns.
    price: Vec<f64>,
    free: Vec<usize>,
    reach: Vec<f64>,
    predecessor: Vec<usize>,
    open: Vec<usize>,
    closed: Vec<usize>,
}

impl Assignment {
    /// Allocates no memory yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// The minimum sum of costs. `costs`: `(rows, columns)`, row after row, in any unit, possibly negative; the sum has the same
    /// unit. Without rows or columns it is 0.
    ///
    /// # Errors
    /// [`SimilarityError::Shape`] when the number of costs is not `rows · columns`, [`SimilarityError::TooMany`] above
    /// [`MAX_ASSIGNED`], [`SimilarityError::BadCost`] for a cost that is not finite or not within ±1e200.
    pub fn solve(&mut self, costs: &[f64], rows: usize, columns: usize) -> Result<f64, SimilarityError> {
        SimilarityError::check_count(rows.max(columns), MAX_ASSIGNED)?;
        check_costs(rows, columns, costs)?;
        self.partners.clear();
        self.partners.resize(rows, None);
        if rows <= columns {
            self.pair(costs, rows, columns);
            for (partner, &column) in self.partners.iter_mut().zip(&self.column_of) {
                *partner = Some(column);
            }
        } else {
            let mut transposed = std::mem::take(&mut self.transposed);
            transposed.clear();
            transposed.extend((0..columns).flat_map(|column| costs[column..].iter().step_by(columns).copied()));
            self.pair(&transposed, columns, rows);
            self.transposed = transposed;
            for (column, &row) in self.column_of.iter().enumerate() {
                self.partners[row] = Some(column);
            }
        }
        let paired = self.partners.iter().enumerate();
        Ok(paired
            .filter_map(|(row, partner)| partner.map(|column| costs[row * columns + column]))
            .sum())
    }

    /// For each row of the last matrix solved, the column it is paired with; `None` for unpaired rows.
    pub fn partners(&self) -> &[Option<usize>] {
        &self.partners
    }

    /// Pairs every row; there are at most as many rows as columns.
    fn pair(&mut self, costs: &[f64], rows: usize, columns: usize) {
        for (buffer, length) in [(&mut self.column_of, rows), (&mut self.row_of, columns)] {
            buffer.clear();
            buffer.resize(length, NONE);
        }
        self.predecessor.resize(columns, NONE);
        self.reach.resize(columns, 0.0);
        self.price.clear();
        self.price.resize(columns, 0.0);
        self.free.clear();
        self.free.extend((0..rows).rev());
        if columns > 1 {
            self.bid(costs, columns);
        }
        while let Some(row) = self.free.pop() {
            let end = self.shortest_path(costs, columns, row);
            self.augment_along_path(row, end);
        }
    }

    /// Augmenting row reduction: each row takes its cheapest column and lowers that column's price until the second cheapest is
    /// as good; a displaced row bids again. Rows that are not settled soon are left to `shortest_path`, because with costs that
    /// are not whole numbers bidding may take very long.
    fn bid(&mut self, costs: &[f64], columns: usize) {
        let mut left_over = std::mem::take(&mut self.closed);
        left_over.clear();
        let mut bids = 3 * self.free.len();
        while let Some(row) = self.free.pop() {
            let [(best, at), (second, at_second)] = two_smallest(&costs[row * columns..][..columns], &self.price);
            let lower = self.price[at] - (second - best);
            let column = if lower < self.price[at] {
                self.price[at] = lower;
                at
            } else if self.row_of[at] == NONE {
                at
            } else {
                at_second
            };
            let displaced = std::mem::replace(&mut self.row_of[column], row);
            self.column_of[row] = column;
            bids = bids.saturating_sub(1);
            if displaced != NONE {
                self.column_of[displaced] = NONE;
                if bids > 0 && column == at {
                    self.free.push(displaced);
                } else {
                    left_over.push(displaced);
                }
            }
        }
        left_over.reverse();
        self.closed = std::mem::replace(&mut self.free, left_over);
    }

    /// Finds the cheapest augmenting path from a free row to a free column, and adjusts the prices.
    fn shortest_path(&mut self, costs: &[f64], columns: usize, start: usize) -> usize {
        self.open.clear();
        self.open.extend(0..columns);
        self.closed.clear();
        self.reach.fill(f64::INFINITY);
        // Path length to the current row, less the cost of its pair.
        let (mut row, mut so_far, mut least) = (start, 0.0, f64::NEG_INFINITY);
        loop {
            let line = &costs[row * columns..][..columns];
            let (mut nearest, mut nearest_at, mut nearest_is_free) = (f64::INFINITY, 0, false);
            for (position, &column) in self.open.iter().enumerate() {
                // Only rounding could make it smaller than `least`.
                let reach = (line[column] - self.price[column] + so_far).max(least);
                if reach < self.reach[column] {
                    self.reach[column] = reach;
                    self.predecessor[column] = row;
                }
                let reach = self.reach[column];
                if reach < nearest || (reach == nearest && !nearest_is_free && self.row_of[column] == NONE) {
                    (nearest, nearest_at) = (reach, position);
                    nearest_is_free = self.row_of[column] == NONE;
                }
            }
            least = nearest;
            let column = self.open.swap_remove(nearest_at);
            if nearest_is_free {
                for &column in &self.closed {
                    self.price[column] += self.reach[column] - least;
                }
                return column;
            }
            self.closed.push(column);
            row = self.row_of[column];
            so_far = least - (costs[row * columns + column] - self.price[column]);
        }
    }

    fn augment_along_path(&mut self, start: usize, end: usize) {
        let mut column = end;
        loop {
            let row = self.predecessor[column];
            self.row_of[column] = row;
            let next = std::mem::replace(&mut self.column_of[row], column);
            if row == start {
                return;
            }
            column = next;
        }
    }
}

/// The two lowest costs less prices, and their columns; ties go to the first. There are at least two columns.
fn two_smallest(line: &[f64], price: &[f64]) -> [(f64, usize); 2] {
    let mut least = [(f64::INFINITY, 0), (f64::INFINITY, 0)];
    for (column, (cost, price)) in line.iter().zip(price).enumerate() {
        let reduced = cost - price;
        if reduced < least[0].0 {
            least = [(reduced, column), least[0]];
        } else if reduced < least[1].0 {
            least[1] = (reduced, column);
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[track_caller]
    fn check(costs: &[f64], rows: usize, columns: usize, expected: f64) {
        let mut assignment = Assignment::new();
        let found = assignment.solve(costs, rows, columns).unwrap();
        assert!(
            (found - expected).abs() < 1e-12,
            "{costs:?}: {found}, expected {expected}"
        );
    }

    #[test]
    fn small_matrices_have_known_sums() {
        check(&[], 0, 0, 0.0);
        check(&[], 0, 3, 0.0);
        check(&[7.0], 1, 1, 7.0);
        check(&[4.0, 1.0, 3.0, 2.0, 0.0, 5.0, 3.0, 2.0, 2.0], 3, 3, 5.0);
        check(&[3.0, -2.0, 1.0], 1, 3, -2.0);
        check(&[3.0, -2.0, 1.0], 3, 1, -2.0);
        check(&[5.0; 16], 4, 4, 20.0);
    }

    #[test]
    fn invalid_matrices_are_refused() {
        let mut assignment = Assignment::new();
        let bad = [1.0, 2.0, f64::NAN, 4.0];
        let error = assignment.solve(&bad, 2, 2).unwrap_err();
        assert!(
            matches!(error, SimilarityError::BadCost { row: 1, column: 0, .. }),
            "{error}"
        );
        let error = assignment.solve(&[1.0], 2, 2).unwrap_err();
        assert!(
            matches!(
                error,
                SimilarityError::Shape {
                    found: 1,
                    expected: 4,
                    ..
                }
            ),
            "{error}"
        );
        let error = assignment.solve(&[], 0, MAX_ASSIGNED + 1).unwrap_err();
        assert!(matches!(error, SimilarityError::TooMany { .. }), "{error}");
    }

    /// The minimum sum, found by trying all pairings.
    fn brute_force(costs: &[f64], rows: usize, columns: usize) -> f64 {
        fn from(costs: &[f64], columns: usize, row: usize, rows: usize, spare: usize, taken: u32) -> f64 {
            if row == rows {
                return 0.0;
            }
            let mut least = f64::INFINITY;
            if spare > 0 {
                least = from(costs, columns, row + 1, rows, spare - 1, taken);
            }
            for column in (0..columns).filter(|column| taken & (1 << column) == 0) {
                let rest = from(costs, columns, row + 1, rows, spare, taken | 1 << column);
                least = least.min(costs[row * columns + column] + rest);
            }
            least
        }
        from(costs, columns, 0, rows, rows.saturating_sub(columns), 0)
    }

    fn matrix() -> impl Strategy<Value = (Vec<f64>, usize, usize)> {
        // Whole numbers from a short range produce many ties.
        let cost = prop_oneof![(-3i8..4).prop_map(f64::from), -5.0..5.0];
        (1usize..6, 1usize..6).prop_flat_map(move |(rows, columns)| {
            (
                prop::collection::vec(cost.clone(), rows * columns),
                Just(rows),
                Just(columns),
            )
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn solution_is_as_cheap_as_the_best_by_brute_force(first in matrix(), second in matrix()) {
            // One workspace for both: nothing of the first solution may remain in the second.
            let mut assignment = Assignment::new();
            for (costs, rows, columns) in [first, second] {
                let total = assignment.solve(&costs, rows, columns).unwrap();
                prop_assert!((total - brute_force(&costs, rows, columns)).abs() < 1e-9);
                let mut columns_used: Vec<usize> = assignment.partners().iter().copied().flatten().collect();
                prop_assert_eq!(columns_used.len(), rows.min(columns));
                columns_used.sort_unstable();
                columns_used.dedup();
                prop_assert_eq!(columns_used.len(), rows.min(columns), "a column is used twice");
                let fresh = Assignment::new().solve(&costs, rows, columns).unwrap();
                prop_assert_eq!(total.to_bits(), fresh.to_bits());
            }
        }
    }
}
