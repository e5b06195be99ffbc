//! Earth mover's distance between two sets of equally weighted points.

use super::exact::{MAX_TRANSPORTED, cheapest_moves};
use crate::{Assignment, SimilarityError};

/// Mean distance in metres from the points of one set to the points of the other under the cheapest pairing (Wasserstein-1 with
/// the Euclidean distance).
///
/// `a`, `b`: points `(x, y)` in metres; all points of a set have equal weight and each set has weight 1, so points are split if
/// the sets differ in size. In `0..=` the largest distance between two points. A metric between sets up to duplication: a set
/// and its doubling are 0 apart. Two empty sets are 0 apart.
///
/// Exact: an assignment for sets of equal size, network simplex otherwise. Time about `points³` at worst.
///
/// # Errors
/// [`SimilarityError::UnequalMasses`] if only one set is empty, [`SimilarityError::BadPoint`] for a coordinate that is not
/// within ±1e100,
/// [`SimilarityError::TooMany`] above [`MAX_TRANSPORTED`](crate::MAX_TRANSPORTED) points.
///
/// # Example
/// ```
/// use driftworld_similarity::earth_movers_distance;
/// let (a, b) = ([[0.0, 0.0], [1.0, 0.0]], [[1.0, 0.0], [0.0, 3.0]]);
/// assert_eq!(earth_movers_distance(&a, &b)?, 1.5);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Source: Rubner, Tomasi and Guibas 2000; same numbers as `ot.emd2` (POT 0.9), see `tests/oracle/transport.json`.
pub fn earth_movers_distance(a: &[[f64; 2]], b: &[[f64; 2]]) -> Result<f64, SimilarityError> {
    check(a, b)?;
    if a.is_empty() {
        return Ok(0.0);
    }
    let distance = |p: &[f64; 2], q: &[f64; 2]| ((p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2)).sqrt();
    if a.len() == b.len() {
        SimilarityError::check_count(a.len(), MAX_TRANSPORTED)?;
        let costs: Vec<f64> = a.iter().flat_map(|p| b.iter().map(|q| distance(p, q))).collect();
        return Ok(Assignment::new().solve(&costs, a.len(), b.len())? / a.len() as f64);
    }
    // Each point of one set holds as many units as the other has points: whole numbers with equal sums.
    let (from, to) = (vec![b.len() as i64; a.len()], vec![a.len() as i64; b.len()]);
    let moves = cheapest_moves(&from, &to, |p, q| distance(&a[p], &b[q]))?.into_iter();
    let total: f64 = moves.map(|(p, q, units)| units as f64 * distance(&a[p], &b[q])).sum();
    Ok(total / (a.len() * b.len()) as f64)
}

/// Refuses coordinates whose squares could not be added up, and an empty set next to a non-empty one.
fn check(a: &[[f64; 2]], b: &[[f64; 2]]) -> Result<(), SimilarityError> {
    for (side, points) in [("a", a), ("b", b)] {
        for (index, point) in points.iter().enumerate() {
            for &found in point {
                if !(-1e100..=1e100).contains(&found) {
                    return Err(SimilarityError::BadPoint { side, index, found });
                }
            }
        }
    }
    if a.is_empty() == b.is_empty() {
        return Ok(());
    }
    let weight = |points: &[[f64; 2]]| if points.is_empty() { 0.0 } else { 1.0 };
    let (from, to) = (weight(a), weight(b));
    Err(SimilarityError::UnequalMasses { from, to })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points() -> impl Strategy<Value = Vec<[f64; 2]>> {
        prop::collection::vec([-9.0f64..9.0, -9.0f64..9.0], 1..9)
    }

    #[test]
    fn point_is_split_among_several() {
        let found = earth_movers_distance(&[[0.0, 0.0]], &[[1.0, 0.0], [0.0, 3.0]]).unwrap();
        assert_eq!(found, 2.0);
        assert_eq!(earth_movers_distance(&[], &[]).unwrap(), 0.0);
    }

    #[test]
    fn one_empty_set_and_invalid_points_are_refused() {
        let code = |a: &[[f64; 2]], b: &[[f64; 2]]| earth_movers_distance(a, b).unwrap_err().code();
        assert_eq!(code(&[], &[[0.0, 0.0]]), "similarity/unequal-masses");
        assert_eq!(code(&[[f64::NAN, 0.0]], &[[0.0, 0.0]]), "similarity/bad-point");
        assert_eq!(code(&[[f64::INFINITY, 0.0]], &[[0.0, 0.0]; 2]), "similarity/bad-point");
        assert_eq!(code(&vec![[0.0; 2]; 4097], &[[0.0; 2]]), "similarity/too-many");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn earth_movers_distance_is_a_metric(a in points(), b in points(), c in points()) {
            let d = |a: &[[f64; 2]], b: &[[f64; 2]]| earth_movers_distance(a, b).unwrap();
            prop_assert!(d(&a, &a).abs() < 1e-12);
            prop_assert!((d(&a, &b) - d(&b, &a)).abs() < 1e-12);
            prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-12);
            prop_assert!(d(&a, &b) <= 18.0 * 2.0_f64.sqrt());
        }

        #[test]
        fn shifted_set_is_the_length_of_the_shift_away(a in points(), x in -5.0f64..5.0, y in -5.0f64..5.0) {
            let b: Vec<[f64; 2]> = a.iter().map(|p| [p[0] + x, p[1] + y]).collect();
            prop_assert!((earth_movers_distance(&a, &b).unwrap() - libm::hypot(x, y)).abs() < 1e-12);
        }

        #[test]
        fn doubling_every_point_changes_nothing(a in points(), b in points()) {
            let twice: Vec<[f64; 2]> = a.iter().chain(&a).copied().collect();
            let (once, twice) = (earth_movers_distance(&a, &b).unwrap(), earth_movers_distance(&twice, &b).unwrap());
            prop_assert!((once - twice).abs() < 1e-12);
        }
    }
}
