//! How many times one scale is another, as a logarithm. Plain differences are in `range.rs` and `relative.rs`.

use crate::SimilarityError;

/// Size of the natural logarithm of the ratio of two scales: |ln(a / b)|. Twice as large is as far as half as large.
///
/// A metric on numbers above 0, from 0 without bound, no unit; divide by ln 2 for doublings, or by ln(high / low) for a share of a
/// range. Unchanged when both are measured in another unit. Some 20 nanoseconds.
///
/// # Errors
/// [`SimilarityError::BadNumber`] for a scale that is not finite and above 0.
///
/// # Example
/// ```
/// use driftworld_similarity::scalar::log_ratio;
/// assert_eq!(log_ratio(1.0, 2.0)?, log_ratio(8.0, 4.0)?);
/// assert!((log_ratio(1.0, 2.0)? - 0.6931).abs() < 1e-4);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn log_ratio(a: f64, b: f64) -> Result<f64, SimilarityError> {
    for found in [a, b] {
        if !(found.is_finite() && found > 0.0) {
            return Err(SimilarityError::BadNumber {
                of: "a scale",
                found,
                expected: "a finite number above 0",
            });
        }
    }
    // The quotient may leave the range of numbers where the logarithms do not.
    let ratio = a / b;
    let log = if ratio.is_normal() {
        libm::log(ratio)
    } else {
        libm::log(a) - libm::log(b)
    };
    Ok(log.abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn scales_are_above_0() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(log_ratio(1.0, bad).is_err(), "{bad}");
            assert!(log_ratio(bad, 1.0).is_err(), "{bad}");
        }
    }

    #[test]
    fn the_largest_and_the_smallest_scale_are_finitely_far_apart() {
        let found = log_ratio(1e300, 1e-300).unwrap();
        assert!((found - 600.0 * std::f64::consts::LN_10).abs() < 1e-9, "{found}");
    }

    proptest! {
        #[test]
        fn it_is_a_metric_without_a_unit(a in 0.01..50.0, b in 0.01..50.0, c in 0.01..50.0, unit in 0.01..50.0) {
            let d = |a: f64, b: f64| log_ratio(a, b).unwrap();
            prop_assert_eq!(d(a, a), 0.0);
            prop_assert!((d(a, b) - d(b, a)).abs() < 1e-12);
            prop_assert!(d(a, c) <= d(a, b) + d(b, c) + 1e-12);
            prop_assert!((d(a * unit, b * unit) - d(a, b)).abs() < 1e-12);
            prop_assert!((a - b).abs() < 1e-12 || d(a, b) > 0.0);
        }
    }
}
