//! [`pearson_distance`]: how far two lists are from rising and falling together. What the numbers are is known elsewhere.

use crate::SimilarityError;
use crate::shares::{shares, sum};

/// How far two lists of numbers are from being one another moved and stretched: `√((1 − r) / 2)`, `r` Pearson's weighted correlation.
///
/// `a` and `b`: `(n,)`, any units, each number within ±1e100. `weights`: `(n,)`, at least 0, in any proportion; what weighs 0
/// has no say. Returns 0 to 1: 0 where one list is the other times a factor above 0 plus a number, √½ where they are
/// uncorrelated, 1 where one falls as the other rises. A pseudometric. A list that is all one number is ½ from any that is
/// not, and 0 from its like: it lies in the middle, as the zero reward does under the direct distance of the reference.
///
/// It is worked out as half the length between the two lists, centred and brought to length 1, which is the same and keeps
/// the digits that `1 − r` loses: within some 1e-15 times (largest number / standard deviation). A distance that is not above what
/// rounding of the numbers can make is given as 0: that is 4 · 2⁻⁵² · (largest number / standard deviation), both lists' added up.
/// Within 8 · 2⁻⁵² of 1 it is given as 1.
///
/// Source: Gleave, Dennis, Legg, Russell and Leike 2021, "Quantifying differences in reward functions", section 4.
///
/// # Errors
/// [`SimilarityError::Shape`] for lists that are not of one length, [`SimilarityError::BadReward`] for a number that is not
/// within ±1e100, [`SimilarityError::BadMass`] and [`SimilarityError::BadNumber`] for weights that are none.
///
/// # Example
/// ```
/// use driftworld_similarity::pearson_distance;
/// let even = [1.0; 3];
/// assert_eq!(pearson_distance(&[0.0, 1.0, 2.0], &[5.0, 7.0, 9.0], &even)?, 0.0);
/// assert_eq!(pearson_distance(&[0.0, 1.0, 2.0], &[2.0, 1.0, 0.0], &even)?, 1.0);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn pearson_distance(a: &[f64], b: &[f64], weights: &[f64]) -> Result<f64, SimilarityError> {
    if a.len() != b.len() {
        return Err(SimilarityError::Shape {
            of: "second list of rewards",
            found: b.len(),
            expected: a.len(),
        });
    }
    for list in [a, b] {
        check(list)?;
    }
    let weights = shares("weights of rewards", weights, a.len())?;
    let direction = |values: &[f64]| {
        Direction::of(
            values,
            &weights,
            4.0 * f64::EPSILON * largest(values, weights.iter().copied()),
        )
    };
    Ok(direction(a).distance(&direction(b), &weights))
}

/// Refuses numbers that cannot be rewards.
pub(super) fn check(values: &[f64]) -> Result<(), SimilarityError> {
    let bad = values.iter().position(|value| !super::table::is_reward(*value));
    bad.map_or(Ok(()), |index| {
        Err(SimilarityError::BadReward {
            place: format!("transition {index}"),
            found: values[index],
        })
    })
}

/// The largest size of a number that weighs anything, 0 without any.
pub(super) fn largest(values: &[f64], weights: impl IntoIterator<Item = f64>) -> f64 {
    let weighing = values.iter().zip(weights).filter(|(_, weight)| *weight > 0.0);
    weighing.fold(0.0, |largest: f64, (value, _)| largest.max(value.abs()))
}

/// Where a list points: centred and of length 1 under the weights.
#[derive(Clone, Debug)]
pub(super) struct Direction {
    /// `None` for a list that is all one number, within rounding.
    offsets: Option<Vec<f64>>,
    /// How far rounding may have turned it.
    rounding: f64,
}

impl Direction {
    /// `shares`: what each number weighs, of sum 1. `rounding`: how far off each may be.
    pub(super) fn of(values: &[f64], shares: &[f64], rounding: f64) -> Self {
        let mean = sum(values.iter().zip(shares).map(|(value, share)| value * share));
        let mut offsets: Vec<f64> = values.iter().map(|value| value - mean).collect();
        let weighing = offsets.iter().zip(shares).filter(|(_, share)| **share > 0.0);
        let widest = weighing.fold(0.0, |widest: f64, (offset, _)| widest.max(offset.abs()));
        if widest <= rounding {
            return Self {
                offsets: None,
                rounding: 0.0,
            };
        }
        // First by the widest, so that squares neither overflow nor vanish.
        let squares = offsets.iter().zip(shares).map(|(offset, share)| {
            let offset = if *share > 0.0 { offset / widest } else { 0.0 };
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

    /// Half the length between the two, 0 to 1.
    pub(super) fn distance(&self, other: &Self, shares: &[f64]) -> f64 {
        let (Some(a), Some(b)) = (&self.offsets, &other.offsets) else {
            return if self.offsets.is_none() && other.offsets.is_none() {
                0.0
            } else {
                0.5
            };
        };
        let square = |((a, b), share): ((&f64, &f64), &f64)| {
            if *share > 0.0 { share * (a - b) * (a - b) } else { 0.0 }
        };
        let half = sum(a.iter().zip(b).zip(shares).map(square)).sqrt() / 2.0;
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

    #[track_caller]
    fn check(a: &[f64], b: &[f64], weights: &[f64], expected: f64) {
        let found = pearson_distance(a, b, weights).unwrap();
        assert!((found - expected).abs() < 1e-15, "{found}, expected {expected}");
    }

    #[test]
    fn small_lists_have_their_known_distances() {
        check(&[1.0, 2.0, 3.0, 4.0], &[1.0, 3.0, 2.0, 4.0], &[1.0; 4], 0.1_f64.sqrt());
        check(
            &[1.0, -1.0, 1.0, -1.0],
            &[1.0, 1.0, -1.0, -1.0],
            &[1.0; 4],
            0.5_f64.sqrt(),
        );
        // What weighs nothing has no say, however large.
        check(&[1.0, 2.0, 1e99], &[1.0, 2.0, -7.0], &[1.0, 1.0, 0.0], 0.0);
        check(&[1.0, 2.0, 3.0], &[1.0, 2.0, 2.0], &[1.0, 1.0, 0.0], 0.0);
    }

    #[test]
    fn what_is_all_one_number_lies_in_the_middle() {
        check(&[3.0; 3], &[7.0; 3], &[1.0; 3], 0.0);
        check(&[3.0; 3], &[1.0, 2.0, 4.0], &[1.0; 3], 0.5);
        check(&[1.0, 2.0, 4.0], &[0.1; 3], &[1.0; 3], 0.5);
        check(&[3.0, 3.0, 9.0], &[1.0, 2.0, 4.0], &[1.0, 1.0, 0.0], 0.5);
    }

    #[test]
    fn huge_and_tiny_numbers_keep_their_distance() {
        for scale in [1e99, 1e-300] {
            let a = [1.0, 2.0, 3.0, 4.0].map(|value| value * scale);
            check(&a, &[1.0, 3.0, 2.0, 4.0], &[1.0; 4], 0.1_f64.sqrt());
        }
    }

    #[test]
    fn nearly_equal_lists_keep_their_digits() {
        // To first order half the sine of the angle between them; 1 − r would leave one digit of it.
        let found = pearson_distance(&[1.0, 0.0, -1.0], &[1.0, 3e-8, -1.0], &[1.0; 3]).unwrap();
        let expected = 3e-8 * (2.0_f64 / 3.0).sqrt() / 2.0_f64.sqrt() / 2.0;
        assert!((found / expected - 1.0).abs() < 1e-7, "{found}, expected {expected}");
    }

    #[test]
    fn lists_that_are_none_are_refused() {
        let code = |a: &[f64], b: &[f64], weights: &[f64]| pearson_distance(a, b, weights).unwrap_err().code();
        assert_eq!(code(&[1.0], &[1.0, 2.0], &[1.0]), "similarity/shape");
        assert_eq!(code(&[1.0], &[1.0], &[1.0, 2.0]), "similarity/shape");
        assert_eq!(code(&[f64::INFINITY], &[1.0], &[1.0]), "similarity/bad-reward");
        assert_eq!(code(&[], &[], &[]), "similarity/bad-number");
    }

    fn list() -> impl Strategy<Value = Vec<f64>> {
        prop::collection::vec((-20_i32..20).prop_map(|k| f64::from(k) / 4.0), 8)
    }

    proptest! {
        #[test]
        fn it_is_a_pseudometric(a in list(), b in list(), c in list(), weights in prop::collection::vec(0_u8..5, 8)) {
            let weights: Vec<f64> = weights.into_iter().map(f64::from).collect();
            prop_assume!(weights.iter().sum::<f64>() > 0.0);
            let apart = |a: &[f64], b: &[f64]| pearson_distance(a, b, &weights).unwrap();
            prop_assert_eq!(apart(&a, &a), 0.0);
            prop_assert_eq!(apart(&a, &b), apart(&b, &a));
            prop_assert!((0.0..=1.0).contains(&apart(&a, &b)));
            prop_assert!(apart(&a, &c) <= apart(&a, &b) + apart(&b, &c) + 1e-14);
        }

        #[test]
        fn moving_and_stretching_is_no_distance(a in list(), by in -1e3..1e3, times in 1e-3..1e3) {
            let moved: Vec<f64> = a.iter().map(|value| value * times + by).collect();
            prop_assert_eq!(pearson_distance(&a, &moved, &[1.0; 8]).unwrap(), 0.0);
        }
    }
}
