//! OSPA: distance between sets of objects, of equal or different size.

use std::collections::BTreeMap;

use crate::SimilarityError;
use crate::assignment::{Assignment, MAX_ASSIGNED};

/// Optimal sub-pattern assignment (OSPA) of order 1: how far objects have to be moved to match, where a missing object counts
/// as one moved by the cut-off.
///
/// `a`, `b`: a class and a position in metres for each object. `cut_off`: metres above 0. With n objects in the larger set, m
/// in the smaller, and the cut-off c: (min Σ min(c, dᵢ) + c (n − m)) / n, where the sum is over the best pairing and d is in
/// metres. Two empty sets are 0 apart, an empty set is c away from any other. Objects of different classes are c apart,
/// wherever they are.
///
/// A metric between multisets of objects, in metres, in `0..=c`. Time `O(n³)` at worst, class by class; up to [`MAX_ASSIGNED`]
/// objects per set.
///
/// Source: Schuhmacher, Vo and Vo 2008, "A consistent metric for performance evaluation of multi-object filters"; the same numbers as
/// `scipy.optimize.linear_sum_assignment` with the formula around it within 1e-9, see `tests/oracle/ospa.json`.
///
/// # Errors
/// [`SimilarityError::TooMany`] above [`MAX_ASSIGNED`] objects, [`SimilarityError::BadNumber`] for a coordinate that is
/// not finite.
///
/// # Example
/// ```
/// use driftworld_similarity::ospa;
/// // One tree is 3 m off, one is missing.
/// let distance = ospa(&[("tree", [0.0, 0.0]), ("tree", [40.0, 0.0])], &[("tree", [0.0, 3.0])], 10.0)?;
/// assert_eq!(distance, (3.0 + 10.0) / 2.0);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn ospa<C: Ord + Clone>(a: &[(C, [f64; 2])], b: &[(C, [f64; 2])], cut_off: f64) -> Result<f64, SimilarityError> {
    let larger = check(a)?.max(check(b)?);
    if larger == 0 {
        return Ok(0.0);
    }
    let (a, b) = (by_class(a), by_class(b));
    let mut assignment = Assignment::new();
    let (mut sum, mut pairs) = (0.0, 0);
    // As many pairs as possible within each class, because no pair costs more than two unmatched objects.
    for (class, from) in &a {
        let Some(to) = b.get(class) else { continue };
        let cost = |x: f64, y: f64, to: &[f64; 2]| libm::hypot(x - to[0], y - to[1]).min(cut_off);
        let costs = from.iter().flat_map(|&[x, y]| to.iter().map(move |to| cost(x, y, to)));
        sum += assignment.solve(&costs.collect::<Vec<f64>>(), from.len(), to.len())?;
        pairs += from.len().min(to.len());
    }
    let missing = (larger - pairs) as f64;
    Ok(((sum + cut_off * missing) / larger as f64).min(cut_off))
}

fn by_class<C: Ord + Clone>(objects: &[(C, [f64; 2])]) -> BTreeMap<C, Vec<[f64; 2]>> {
    let mut classes = BTreeMap::<C, Vec<[f64; 2]>>::new();
    for (class, place) in objects {
        classes.entry(class.clone()).or_default().push(*place);
    }
    classes
}

/// Checks the coordinates, and returns the number of objects.
fn check<C>(objects: &[(C, [f64; 2])]) -> Result<usize, SimilarityError> {
    let found = objects.len();
    SimilarityError::check_count(found, MAX_ASSIGNED)?;
    let mut metres = objects.iter().flat_map(|(_, place)| place);
    match metres.find(|metres| !metres.is_finite()) {
        Some(&found) => Err(SimilarityError::BadNumber {
            of: "coordinate of an object in metres",
            found,
            expected: "a finite number",
        }),
        None => Ok(found),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn objects() -> impl Strategy<Value = Vec<(u8, [f64; 2])>> {
        prop::collection::vec((0u8..3, prop::array::uniform2(-10.0..10.0)), 0..6)
    }

    #[test]
    fn non_finite_coordinates_are_refused() {
        let error = ospa(&[((), [f64::NAN, 0.0])], &[], 1.0).unwrap_err();
        assert!(matches!(error, SimilarityError::BadNumber { .. }), "{error}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn ospa_is_a_metric(a in objects(), b in objects(), c in objects(), cut_off in 0.5..15.0) {
            let mut turned = a.clone();
            turned.reverse();
            let d = |a: &[_], b: &[_]| ospa(a, b, cut_off).unwrap();
            prop_assert_eq!(d(&a, &turned), 0.0);
            prop_assert!((d(&a, &b) - d(&b, &a)).abs() < 1e-9);
            prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-9);
            prop_assert!((0.0..=cut_off).contains(&d(&a, &b)));
        }

        #[test]
        fn surplus_object_costs_the_same_at_any_distance(a in objects(), x in 50.0..100.0) {
            let with = |x: f64| [a.clone(), vec![(0, [x, 0.0])]].concat();
            let (near, far) = (ospa(&a, &with(30.0), 2.0).unwrap(), ospa(&a, &with(x), 2.0).unwrap());
            prop_assert!((near - far).abs() < 1e-12);
        }
    }
}
