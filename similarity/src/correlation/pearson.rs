//! Pearson's correlation: how closely points follow a straight line.

use super::check;
use crate::SimilarityError;

/// Pearson's product-moment correlation: 1 on a rising straight line, −1 on a falling one, 0 if one number does not help to
/// predict the other linearly.
///
/// `r = Σ (aᵢ − ā)(bᵢ − b̄) / √(Σ (aᵢ − ā)² · Σ (bᵢ − b̄)²)`. `a` and `b`: one number each per observation, in any units, at
/// least 3. Returns −1 to 1; symmetric; the same when a list is shifted or scaled by a factor above 0. One outlier can
/// make or break it: compare with [`spearman`](crate::spearman). Not a distance. Time `O(n)`.
///
/// Source: Pearson 1895; the same numbers as `scipy.stats.pearsonr` within 1e-12.
///
/// # Errors
/// [`SimilarityError::CorrelationLengths`] for lists of different lengths, [`SimilarityError::CorrelationTooFew`] for fewer
/// than 3 numbers, [`SimilarityError::CorrelationNotFinite`] for a number that is not finite,
/// [`SimilarityError::CorrelationConstant`] for a list of equal numbers.
///
/// # Example
/// ```
/// let r = driftworld_similarity::pearson(&[1.0, 2.0, 3.0, 4.0], &[1.0, 3.0, 2.0, 4.0])?;
/// assert!((r - 0.8).abs() < 1e-15);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn pearson(a: &[f64], b: &[f64]) -> Result<f64, SimilarityError> {
    check(a, b)?;
    // Numbers that differ by less than the precision of the arithmetic count as equal.
    let constant = |list, values: &[f64]| SimilarityError::CorrelationConstant { list, found: values[0] };
    let (from_a, from_b) = (
        centred(a).ok_or_else(|| constant("first", a))?,
        centred(b).ok_or_else(|| constant("second", b))?,
    );
    Ok(cosine(&from_a, &from_b))
}

/// The correlation of checked lists; `None` if one is constant.
pub(super) fn of_checked(a: &[f64], b: &[f64]) -> Option<f64> {
    Some(cosine(&centred(a)?, &centred(b)?))
}

/// The cosine of the angle between two lists taken as directions.
fn cosine(a: &[f64], b: &[f64]) -> f64 {
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    (sum(a, b) / (sum(a, a).sqrt() * sum(b, b).sqrt())).clamp(-1.0, 1.0)
}

/// The numbers minus their mean, scaled so that the largest is 1: squares neither overflow nor vanish. `None` if all are equal.
fn centred(values: &[f64]) -> Option<Vec<f64>> {
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    if largest == 0.0 {
        return None;
    }
    // Scaled by a power of two, which loses no digit: the information of numbers far from 0 is in their differences.
    let exponent = libm::ilogb(largest);
    let scaled: Vec<f64> = values.iter().map(|value| libm::scalbn(*value, -exponent)).collect();
    let mean = scaled.iter().sum::<f64>() / scaled.len() as f64;
    let mut offsets: Vec<f64> = scaled.iter().map(|value| value - mean).collect();
    let widest = offsets.iter().fold(0.0, |widest: f64, offset| widest.max(offset.abs()));
    if widest == 0.0 || values.iter().all(|value| *value == values[0]) {
        return None;
    }
    for offset in &mut offsets {
        *offset /= widest;
    }
    Some(offsets)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lists() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
        (3_usize..20).prop_flat_map(|n| {
            let list = || prop::collection::vec((-50_i32..50).prop_map(|k| f64::from(k) / 4.0), n);
            (list(), list())
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn pearson_is_symmetric_bounded_and_invariant_to_shift_and_scale((a, b) in lists(), shift in -9.0..9.0, scale in 0.1..9.0) {
            let Ok(r) = pearson(&a, &b) else { return Ok(()) };
            prop_assert!((-1.0..=1.0).contains(&r));
            prop_assert!((pearson(&b, &a).unwrap() - r).abs() < 1e-12);
            let moved: Vec<f64> = a.iter().map(|value| shift + scale * value).collect();
            prop_assert!((pearson(&moved, &b).unwrap() - r).abs() < 1e-9);
            let turned: Vec<f64> = a.iter().map(|value| -value).collect();
            prop_assert!((pearson(&turned, &b).unwrap() + r).abs() < 1e-12);
            prop_assert!((pearson(&a, &a).unwrap() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn huge_and_tiny_numbers_neither_overflow_nor_vanish() {
        for scale in [1e300, 1e-300] {
            let a = [1.0, 2.0, 3.0, 4.0].map(|value| value * scale);
            assert!((pearson(&a, &[1.0, 3.0, 2.0, 4.0]).unwrap() - 0.8).abs() < 1e-12);
        }
    }
}
