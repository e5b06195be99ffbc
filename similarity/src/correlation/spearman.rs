//! Spearman's rank correlation: whether one list rises with the other.

use super::{check, pearson};
use crate::SimilarityError;

/// Spearman's rank correlation: 1 if one list rises whenever the other does, −1 if it falls, 0 if neither helps to predict the
/// other's order.
///
/// Pearson's correlation of the [`ranks`]; equal numbers share the mean of their ranks. `a` and `b`: one number each per
/// observation, in any units, at least 3. Returns −1 to 1; symmetric; invariant under any increasing map of either list, so no
/// outlier and no choice of scale decides it. Numbers that differ only by rounding count as equal, as in [`ranks`]. Not a
/// distance. Time `O(n log n)`.
///
/// Source: Spearman 1904; the same numbers as `scipy.stats.spearmanr` within 1e-12.
///
/// # Errors
/// [`SimilarityError::CorrelationLengths`] for lists of different lengths, [`SimilarityError::CorrelationTooFew`] for fewer
/// than 3 numbers, [`SimilarityError::CorrelationNotFinite`] for a number that is not finite,
/// [`SimilarityError::CorrelationConstant`] for a list of equal numbers.
///
/// # Example
/// ```
/// let rho = driftworld_similarity::spearman(&[1.0, 2.0, 3.0, 40.0], &[0.1, 0.3, 0.2, 0.4])?;
/// assert!((rho - 0.8).abs() < 1e-15);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn spearman(a: &[f64], b: &[f64]) -> Result<f64, SimilarityError> {
    check(a, b)?;
    pearson(&ranks(a), &ranks(b))
}

/// The ranks of finite numbers, from 1 for the smallest; equal numbers share the mean of their ranks.
///
/// Numbers count as equal if they agree to twelve significant digits, or if they differ by less than the rounding of the
/// largest: equal distances may be sums in different orders, which must not break ties. Time `O(n log n)`.
///
/// # Example
/// ```
/// assert_eq!(driftworld_similarity::ranks(&[0.5, 9.0, 0.5, 2.0]), [1.5, 4.0, 1.5, 3.0]);
/// ```
pub fn ranks(values: &[f64]) -> Vec<f64> {
    let values = without_rounding(values);
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut below = 0;
    // `==` and not the total order: 0 and −0 are equal numbers.
    for equal in order.chunk_by(|a, b| values[*a] == values[*b]) {
        let rank = below as f64 + (equal.len() + 1) as f64 / 2.0;
        for item in equal {
            ranks[*item] = rank;
        }
        below += equal.len();
    }
    ranks
}

/// If the larger of two numbers exceeds the other by at most this share of it, they agree to twelve significant digits.
const TWELVE_DIGITS: f64 = 1e-12;

/// Rounding error of sums, as a share of the largest number.
const ROUNDING: f64 = 1e-15;

/// Replaces each number by the smallest of those that count as equal to it.
///
/// Numbers are compared with the smallest of their group, not with their neighbours, so that no chain of small steps makes
/// distant numbers equal. They are not rounded, which would separate neighbours on either side of a rounding edge.
pub(super) fn without_rounding(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let largest = values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    let mut merged = values.to_vec();
    let mut least = f64::NEG_INFINITY;
    for item in order {
        let value = values[item];
        let same = (TWELVE_DIGITS * value.abs().max(least.abs())).max(ROUNDING * largest);
        // Everything is infinitely far from negative infinity, and an infinite bound would include it.
        if least.is_infinite() || value - least > same {
            least = value;
        }
        merged[item] = least;
    }
    merged
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lists() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
        (3_usize..20).prop_flat_map(|n| {
            let list = || prop::collection::vec((-9_i32..9).prop_map(f64::from), n);
            (list(), list())
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn spearman_is_symmetric_bounded_and_invariant_under_increasing_maps((a, b) in lists()) {
            let Ok(rho) = spearman(&a, &b) else { return Ok(()) };
            prop_assert!((-1.0..=1.0).contains(&rho));
            prop_assert!((spearman(&b, &a).unwrap() - rho).abs() < 1e-12);
            let bent: Vec<f64> = a.iter().map(|value| value * value * value + 7.0).collect();
            prop_assert!((spearman(&bent, &b).unwrap() - rho).abs() < 1e-12);
        }

        #[test]
        fn ranks_have_the_sum_of_distinct_ones((a, _) in lists()) {
            let n = a.len() as f64;
            prop_assert_eq!(ranks(&a).iter().sum::<f64>(), n * (n + 1.0) / 2.0);
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// Ties do not depend on the order of additions, nor on the unit.
        #[test]
        fn rounding_neither_breaks_nor_makes_ties(
            (a, _) in lists(), noise in prop::collection::vec(-4_i32..=4, 20), power in -40..40_i32, unit in 0.1..10.0_f64,
        ) {
            let numbers: Vec<f64> = a.iter().map(|value| 0.1 * value + 2.0).collect();
            let noisy: Vec<f64> =
                numbers.iter().zip(&noise).map(|(number, noise)| number * (1.0 + f64::from(*noise) * 2.5e-16)).collect();
            prop_assert_eq!(ranks(&noisy), ranks(&numbers));
            // The integers have exact ties.
            prop_assert_eq!(ranks(&numbers), ranks(&a));
            let scaled: Vec<f64> = noisy.iter().map(|number| number * 2.0_f64.powi(power)).collect();
            prop_assert_eq!(ranks(&scaled), ranks(&numbers));
            let in_units: Vec<f64> = noisy.iter().map(|number| number * unit).collect();
            prop_assert_eq!(ranks(&in_units), ranks(&numbers));
        }
    }

    #[test]
    fn issue_16_rounding_broke_ties_of_distances() {
        let (sum, number) = (0.1 + 0.2, 0.3);
        assert_ne!(sum, number);
        assert_eq!(ranks(&[sum, number, 0.5]), [1.5, 1.5, 3.0]);
        assert_eq!(ranks(&[number, sum, 0.5]), [1.5, 1.5, 3.0]);
        assert_eq!(
            ranks(&[0.0, sum - number, 0.5]),
            [1.5, 1.5, 3.0],
            "the rounding error of a difference"
        );
        assert_eq!(
            ranks(&[0.3, 0.3 + 1e-11, 0.5]),
            [1.0, 2.0, 3.0],
            "a difference in the eleventh digit is not rounding"
        );
    }

    #[test]
    fn zero_and_minus_zero_are_equal() {
        assert_eq!(ranks(&[0.0, -0.0, 1.0]), [1.5, 1.5, 3.0]);
    }
}
