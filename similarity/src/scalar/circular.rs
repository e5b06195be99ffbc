//! Difference between two headings.

/// The smaller angle between two headings: min(t, 360 − t) with t = |a − b| mod 360.
///
/// A metric between headings within one turn, in degrees, in `0..=180`; 370° is the same heading as 10°. Headings must be
/// finite. Takes a few nanoseconds.
///
/// # Example
/// ```
/// use driftworld_similarity::scalar::circular_difference;
/// assert_eq!(circular_difference(350.0, 10.0), 20.0);
/// assert_eq!(circular_difference(0.0, 180.0), 180.0);
/// ```
pub fn circular_difference(a: f64, b: f64) -> f64 {
    // Each reduced first, because the difference of two large numbers may overflow; a tiny negative number becomes 360.
    let turn = (a.rem_euclid(360.0) - b.rem_euclid(360.0)).abs();
    turn.min((360.0 - turn).abs())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn headings_close_to_north_on_either_side_are_close() {
        assert!(circular_difference(-1e-20, 0.0) < 1e-12);
        assert!(circular_difference(359.999, 0.001) < 0.003);
        assert!(circular_difference(f64::MAX, -f64::MAX) <= 180.0);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn circular_difference_is_a_metric(a in -720.0..720.0, b in -720.0..720.0, c in -720.0..720.0, turns in -2i8..3) {
            let d = circular_difference;
            prop_assert_eq!(d(a, a), 0.0);
            prop_assert_eq!(d(a, b), d(b, a));
            prop_assert!(d(a, c) <= d(a, b) + d(b, c) + 1e-9);
            prop_assert!((0.0..=180.0).contains(&d(a, b)));
            prop_assert!((d(a + 360.0 * f64::from(turns), b) - d(a, b)).abs() < 1e-9);
        }
    }
}
