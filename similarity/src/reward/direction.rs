//! [`Direction`]: a list of numbers up to shift and scale.

use crate::sum::sum;

/// The direction of a list: centred and of length 1, every number with equal weight.
#[derive(Clone, Debug)]
pub(super) struct Direction {
    /// `None` for a list that is constant within rounding.
    offsets: Option<Vec<f64>>,
    /// Maximum rotation of the direction due to rounding.
    rounding: f64,
}

impl Direction {
    /// `values`: at least one. `rounding`: the largest error of each.
    pub(super) fn of(values: &[f64], rounding: f64) -> Self {
        let share = 1.0 / values.len() as f64;
        let mean = sum(values.iter().map(|value| value * share));
        let mut offsets: Vec<f64> = values.iter().map(|value| value - mean).collect();
        let widest = offsets.iter().fold(0.0, |widest: f64, offset| widest.max(offset.abs()));
        if widest <= rounding {
            return Self {
                offsets: None,
                rounding: 0.0,
            };
        }
        // Divided by the largest first, so that squares neither overflow nor vanish.
        let squares = offsets.iter().map(|offset| {
            let offset = offset / widest;
            share * offset * offset
        });
        let length = widest * sum(squares).sqrt();
        for offset in &mut offsets {
            *offset /= length;
        }
        Self {
            offsets: Some(offsets),
            rounding: rounding / length,
        }
    }

    /// Half the distance between the two, which is `√((1 − r) / 2)` with Pearson's correlation `r`, but keeps the digits
    /// that `1 − r` loses.
    ///
    /// 0 to 1: 0 if one list is the other times a factor above 0 plus a constant, 1 if one falls exactly as the other rises. A
    /// constant list is ½ from any that is not, and 0 from another constant one. Distances within rounding are returned as 0,
    /// those within 8 · 2⁻⁵² of 1 as 1.
    pub(super) fn distance(&self, other: &Self) -> f64 {
        let (Some(a), Some(b)) = (&self.offsets, &other.offsets) else {
            return if self.offsets.is_none() && other.offsets.is_none() {
                0.0
            } else {
                0.5
            };
        };
        let share = 1.0 / a.len() as f64;
        let squares = a.iter().zip(b).map(|(a, b)| share * (a - b) * (a - b));
        let half = sum(squares).sqrt() / 2.0;
        if half <= self.rounding + other.rounding {
            0.0
        } else if half >= 1.0 - 8.0 * f64::EPSILON {
            1.0
        } else {
            half
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn distance(a: &[f64], b: &[f64]) -> f64 {
        let direction = |values: &[f64]| {
            let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
            Direction::of(values, 4.0 * f64::EPSILON * largest)
        };
        direction(a).distance(&direction(b))
    }

    #[track_caller]
    fn check(a: &[f64], b: &[f64], expected: f64) {
        let found = distance(a, b);
        assert!((found - expected).abs() < 1e-15, "{found}, expected {expected}");
    }

    #[test]
    fn small_lists_have_known_distances() {
        check(&[1.0, 2.0, 3.0, 4.0], &[1.0, 3.0, 2.0, 4.0], 0.1_f64.sqrt());
        check(&[1.0, -1.0, 1.0, -1.0], &[1.0, 1.0, -1.0, -1.0], 0.5_f64.sqrt());
    }

    #[test]
    fn constant_list_is_halfway() {
        check(&[3.0; 3], &[7.0; 3], 0.0);
        check(&[3.0; 3], &[1.0, 2.0, 4.0], 0.5);
        check(&[1.0, 2.0, 4.0], &[0.1; 3], 0.5);
    }

    #[test]
    fn huge_and_tiny_numbers_keep_their_distance() {
        for scale in [1e99, 1e-300] {
            let a = [1.0, 2.0, 3.0, 4.0].map(|value| value * scale);
            check(&a, &[1.0, 3.0, 2.0, 4.0], 0.1_f64.sqrt());
        }
    }

    #[test]
    fn nearly_equal_lists_keep_their_digits() {
        // To first order half the sine of the angle between them; 1 − r would keep only one digit of it.
        let found = distance(&[1.0, 0.0, -1.0], &[1.0, 3e-8, -1.0]);
        let expected = 3e-8 * (2.0_f64 / 3.0).sqrt() / 2.0_f64.sqrt() / 2.0;
        assert!((found / expected - 1.0).abs() < 1e-7, "{found}, expected {expected}");
    }

    fn list() -> impl Strategy<Value = Vec<f64>> {
        prop::collection::vec((-20_i32..20).prop_map(|k| f64::from(k) / 4.0), 8)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn direction_distance_is_a_pseudometric(a in list(), b in list(), c in list()) {
            prop_assert_eq!(distance(&a, &a), 0.0);
            prop_assert_eq!(distance(&a, &b), distance(&b, &a));
            prop_assert!((0.0..=1.0).contains(&distance(&a, &b)));
            prop_assert!(distance(&a, &c) <= distance(&a, &b) + distance(&b, &c) + 1e-14);
        }

        #[test]
        fn shift_and_scale_give_distance_0(a in list(), by in -1e3..1e3, times in 1e-3..1e3) {
            let moved: Vec<f64> = a.iter().map(|value| value * times + by).collect();
            prop_assert_eq!(distance(&a, &moved), 0.0);
        }
    }
}
