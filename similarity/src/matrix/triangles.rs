//! How far a matrix is from keeping the triangle inequality. What needs it to be kept is in `order/`.

use rayon::prelude::*;
use serde::Serialize;

use super::DistanceMatrix;

/// A detour that is shorter than the straight way, by the items' indices in the matrix.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Violation {
    /// One item.
    pub a: usize,
    /// Another, after it in the matrix.
    pub b: usize,
    /// The one between, by way of which it is shorter.
    pub by: usize,
    /// The distance of the two.
    pub straight: f64,
    /// The distances to the one between and from there, together: less.
    pub detour: f64,
}

impl Violation {
    /// How much the straight way is longer, as a share of the detour; infinite where the detour is 0.
    pub fn excess(&self) -> f64 {
        (self.straight - self.detour) / self.detour
    }
}

/// What came of looking at every three items of a matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Triangles {
    /// How many ways by way of a third item were compared with the straight one: `n (n - 1) (n - 2) / 2`.
    pub compared: u64,
    /// How many of them were shorter.
    pub broken: u64,
    /// The one that is worst: of largest [`Violation::excess`]; of equal ones the first.
    pub worst: Option<Violation>,
}

/// Differences below this share of the straight way are rounding.
const ROUNDING: f64 = 1e-9;

impl DistanceMatrix {
    /// Compares every straight way with every detour. Time `O(n³)`, in parallel: a thousand items take about a second.
    ///
    /// # Example
    /// ```
    /// use driftworld_similarity::{DistanceMatrix, SimilarityError};
    /// let at = [0.0_f64, 1.0, 2.0];
    /// let squared = |a: usize, b: usize| Ok::<_, SimilarityError>((at[a] - at[b]).powi(2));
    /// let matrix = DistanceMatrix::measure(["a", "b", "c"].map(String::from).to_vec(), squared)?;
    /// let found = matrix.triangle_violations();
    /// assert_eq!((found.compared, found.broken), (3, 1));
    /// assert_eq!(found.worst.map(|worst| worst.excess()), Some(1.0));
    /// # Ok::<(), SimilarityError>(())
    /// ```
    pub fn triangle_violations(&self) -> Triangles {
        let rows: Vec<Triangles> = (0..self.len())
            .into_par_iter()
            .map(|a| self.triangles_from(a))
            .collect();
        rows.into_iter().fold(Triangles::default(), |all, row| Triangles {
            compared: all.compared + row.compared,
            broken: all.broken + row.broken,
            worst: worse(all.worst, row.worst),
        })
    }

    fn triangles_from(&self, a: usize) -> Triangles {
        let mut found = Triangles::default();
        let from_a = self.values().row(a);
        for b in a + 1..self.len() {
            let straight = from_a[b];
            let bound = straight * (1.0 - ROUNDING);
            let from_b = self.values().row(b);
            found.compared += self.len() as u64 - 2;
            for (by, (there, onwards)) in from_a.iter().zip(from_b).enumerate() {
                let detour = there + onwards;
                // Neither end lies between: by way of them it is never shorter.
                if detour < bound {
                    found.broken += 1;
                    let violation = Violation {
                        a,
                        b,
                        by,
                        straight,
                        detour,
                    };
                    found.worst = worse(found.worst, Some(violation));
                }
            }
        }
        found
    }
}

fn worse(one: Option<Violation>, other: Option<Violation>) -> Option<Violation> {
    match (one, other) {
        (Some(one), Some(other)) if other.excess() > one.excess() => Some(other),
        (None, other) => other,
        (one, _) => one,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SimilarityError;
    use proptest::prelude::*;

    fn matrix(n: usize, measure: impl Fn(usize, usize) -> f64 + Sync) -> DistanceMatrix {
        let labels = (0..n).map(|k| k.to_string()).collect();
        DistanceMatrix::measure(labels, |a, b| Ok::<_, SimilarityError>(measure(a, b))).unwrap()
    }

    proptest! {
        #[test]
        fn points_on_a_plane_break_nothing(points in prop::collection::vec(prop::array::uniform2(-9.0..9.0_f64), 0..20)) {
            let n = points.len() as u64;
            let gap = |a: usize, b: usize| libm::hypot(points[a][0] - points[b][0], points[a][1] - points[b][1]);
            let found = matrix(points.len(), gap).triangle_violations();
            prop_assert_eq!((found.broken, found.worst), (0, None));
            prop_assert_eq!(found.compared, n * n.saturating_sub(1) * n.saturating_sub(2) / 2);
        }
    }

    #[test]
    fn the_worst_is_the_largest_share() {
        // 0 to 3 is 9 where 1 + 4 or 4 + 1 would do (80 %); 0 to 2 is 4 where 1 + 1 would do (100 %), and so is 1 to 3.
        let found = matrix(4, |a, b| (b as f64 - a as f64).powi(2)).triangle_violations();
        let worst = found.worst.unwrap();
        assert_eq!((found.compared, found.broken), (12, 4));
        assert_eq!((worst.a, worst.b, worst.by, worst.excess()), (0, 2, 1, 1.0));
    }

    #[test]
    fn equals_that_lie_apart_from_others_differently_are_infinitely_wrong() {
        let found = matrix(3, |a, b| if (a, b) == (0, 1) { 1.0 } else { 0.0 }).triangle_violations();
        assert_eq!(found.worst.map(|worst| worst.excess()), Some(f64::INFINITY));
    }
}
