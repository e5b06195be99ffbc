//! Difference of two numbers as a share of their range. Differences of scales are in `log_ratio.rs`.

use crate::SimilarityError;

/// Difference of two numbers as a share of the range that they come from: |a − b| / (high − low).
///
/// A metric, in `0..=1` for numbers within the range, above 1 for others; all four in the same unit, the result without one.
/// The term for numbers in Gower's mix. A nanosecond.
///
/// Source: Gower 1971, "A general coefficient of similarity and some of its properties".
///
/// # Errors
/// [`SimilarityError::BadNumber`] when `high` is not above `low`, or when a number or the width of the range is not finite.
///
/// # Example
/// ```
/// use driftworld_similarity::scalar::range_difference;
/// assert_eq!(range_difference(2.0, 7.0, 0.0, 20.0)?, 0.25);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn range_difference(a: f64, b: f64, low: f64, high: f64) -> Result<f64, SimilarityError> {
    for (of, found) in [("the first number", a), ("the second number", b)] {
        if !found.is_finite() {
            let expected = "a finite number";
            return Err(SimilarityError::BadNumber { of, found, expected });
        }
    }
    let width = high - low;
    if width > 0.0 && width.is_finite() {
        Ok((a - b).abs() / width)
    } else {
        Err(SimilarityError::BadNumber {
            of: "the width of a range",
            found: width,
            expected: "a finite number above 0",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_range_has_a_width() {
        for (a, low, high) in [
            (0.0, 1.0, 1.0),
            (0.0, 2.0, 1.0),
            (0.0, 0.0, f64::NAN),
            (f64::INFINITY, 0.0, 1.0),
        ] {
            let error = range_difference(a, 1.0, low, high).unwrap_err();
            assert!(matches!(error, SimilarityError::BadNumber { .. }), "{error}");
        }
    }

    proptest! {
        #[test]
        fn it_is_a_metric_up_to_1(a in -5.0..=3.0, b in -5.0..=3.0, c in -5.0..=3.0) {
            let d = |a: f64, b: f64| range_difference(a, b, -5.0, 3.0).unwrap();
            prop_assert_eq!(d(a, a), 0.0);
            prop_assert_eq!(d(a, b), d(b, a));
            prop_assert!(d(a, c) <= d(a, b) + d(b, c) + 1e-12);
            prop_assert!((0.0..=1.0).contains(&d(a, b)));
            prop_assert!(a == b || d(a, b) > 0.0);
        }
    }
}
