//! Sliced Wasserstein distance of point sets: the mean over directions of their distance along a line. Of grids it is in
//! `occupancy/sliced.rs`.

use std::f64::consts::PI;

use super::points;
use crate::SimilarityError;

/// Most directions.
pub const MAX_DIRECTIONS: usize = 10_000;

/// Mean over `directions` of the Wasserstein-1 distance between the points' shadows on a line in that direction.
///
/// `a`, `b`: points `(x, y)` in metres, all of a set weigh the same and each set weighs 1 as a whole. The directions are the
/// angles (k + ½)·π / `directions`: fixed, so that equal inputs give equal numbers. Returns metres, never more than
/// [`earth_movers_distance`](crate::earth_movers_distance), and 2/π of it for a set moved as a whole (within π² / (24 directions²)
/// of that share). Symmetric, 0 on equal sets, and the triangle inequality holds, but sets that differ may cast the same shadows
/// in finitely many directions: a distance. 32 directions are enough to compare, in time `directions · points · log(points)`.
///
/// # Errors
/// [`SimilarityError::BadNumber`] for 0 or more than [`MAX_DIRECTIONS`] directions, [`SimilarityError::UnequalMasses`] when one set
/// is empty, [`SimilarityError::BadPoint`] for a coordinate that is not within ±1e100.
///
/// # Example
/// ```
/// use driftworld_similarity::sliced_wasserstein;
/// let found = sliced_wasserstein(&[[0.0, 0.0]], &[[3.0, 4.0]], 64)?;
/// assert!((found - 5.0 * 2.0 / std::f64::consts::PI).abs() < 1e-3);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
/// Source: Rabin et al. 2011; same numbers as `ot.sliced_wasserstein_distance` (POT 0.9, `p=1`) with these directions, see
/// `tests/oracle/transport.json`.
pub fn sliced_wasserstein(a: &[[f64; 2]], b: &[[f64; 2]], directions: usize) -> Result<f64, SimilarityError> {
    let lines = self::directions(directions)?;
    points::check(a, b)?;
    let (mut shadow_a, mut shadow_b) = (Vec::with_capacity(a.len()), Vec::with_capacity(b.len()));
    let mut sum = 0.0;
    for line in &lines {
        for (shadow, points) in [(&mut shadow_a, a), (&mut shadow_b, b)] {
            shadow.clear();
            shadow.extend(points.iter().map(|p| p[0] * line[0] + p[1] * line[1]));
            shadow.sort_unstable_by(f64::total_cmp);
        }
        sum += apart(&shadow_a, &shadow_b);
    }
    Ok(sum / lines.len() as f64)
}

/// Unit vectors over half a turn.
pub(crate) fn directions(number: usize) -> Result<Vec<[f64; 2]>, SimilarityError> {
    if !(1..=MAX_DIRECTIONS).contains(&number) {
        return Err(SimilarityError::BadNumber {
            of: "directions",
            found: number as f64,
            expected: "from 1 to 10000",
        });
    }
    let angle = |k: usize| (k as f64 + 0.5) * PI / number as f64;
    Ok((0..number)
        .map(|k| [libm::cos(angle(k)), libm::sin(angle(k))])
        .collect())
}

/// The area between the step functions of two sorted lists.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    if a.len() == b.len() {
        let ways: f64 = a.iter().zip(b).map(|(a, b)| (a - b).abs()).sum();
        return ways / a.len().max(1) as f64;
    }
    // Steps are counted in units of 1 / (a.len() · b.len()), so that both end at the same height exactly.
    let (mut next_a, mut next_b, mut area) = (0, 0, 0.0);
    let mut here = a[0].min(b[0]);
    while next_a < a.len() || next_b < b.len() {
        let from_a = next_b >= b.len() || (next_a < a.len() && a[next_a] <= b[next_b]);
        let there = if from_a { a[next_a] } else { b[next_b] };
        area += (next_a * b.len()).abs_diff(next_b * a.len()) as f64 * (there - here);
        here = there;
        if from_a {
            next_a += 1;
        } else {
            next_b += 1;
        }
    }
    area / (a.len() * b.len()) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::earth_movers_distance;
    use proptest::prelude::*;

    fn points() -> impl Strategy<Value = Vec<[f64; 2]>> {
        prop::collection::vec([-9.0f64..9.0, -9.0f64..9.0], 1..9)
    }

    #[test]
    fn a_point_among_two_goes_to_both() {
        assert_eq!(apart(&[0.0], &[-1.0, 3.0]), 2.0);
        assert_eq!(apart(&[0.0, 1.0, 2.0], &[1.0]), 2.0 / 3.0);
    }

    #[test]
    fn settings_and_points_that_are_none_are_refused() {
        let code = |a: &[[f64; 2]], b: &[[f64; 2]], n| sliced_wasserstein(a, b, n).unwrap_err().code();
        assert_eq!(code(&[], &[], 0), "similarity/bad-number");
        assert_eq!(code(&[], &[], MAX_DIRECTIONS + 1), "similarity/bad-number");
        assert_eq!(code(&[[0.0; 2]], &[], 8), "similarity/unequal-masses");
        assert_eq!(code(&[[0.0, f64::NAN]], &[[0.0; 2]], 8), "similarity/bad-point");
        assert_eq!(sliced_wasserstein(&[], &[], 8).unwrap(), 0.0);
    }

    proptest! {
        #[test]
        fn it_keeps_the_laws_and_stays_below_the_whole(a in points(), b in points(), c in points()) {
            let d = |a: &[[f64; 2]], b: &[[f64; 2]]| sliced_wasserstein(a, b, 16).unwrap();
            prop_assert_eq!(d(&a, &a), 0.0);
            prop_assert!((d(&a, &b) - d(&b, &a)).abs() < 1e-12);
            prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-12);
            prop_assert!(d(&a, &b) <= earth_movers_distance(&a, &b).unwrap() + 1e-12);
        }
    }
}
