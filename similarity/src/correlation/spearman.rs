//! Spearman's rank correlation: whether one list rises where the other does. That of the numbers themselves is in
//! `pearson.rs`.

use super::{check, pearson};
use crate::SimilarityError;

/// Spearman's rank correlation: 1 where one list rises whenever the other does, −1 where it falls, 0 where neither helps to
/// guess the other's order.
///
/// Pearson's correlation of the [`ranks`]; equal numbers share the mean of their ranks. `a` and `b`: one number each per
/// observation, in any units, at least 3. Returns −1 to 1; symmetric; the same under any rising map of either list, so that no
/// far-off point and no choice of scale decides it. Numbers count as equal only where all their bits do: round beforehand what
/// differs by rounding alone. Not a distance. Time `O(n log n)`.
///
/// Source: Spearman 1904; the same numbers as `scipy.stats.spearmanr` within 1e-12.
///
/// # Errors
/// [`SimilarityError::CorrelationLengths`], [`SimilarityError::CorrelationTooFew`],
/// [`SimilarityError::CorrelationNotFinite`], [`SimilarityError::CorrelationConstant`].
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

/// The ranks of finite numbers, from 1 for the least; equal numbers share the mean of their ranks.
///
/// Time `O(n log n)`.
///
/// # Example
/// ```
/// assert_eq!(driftworld_similarity::ranks(&[0.5, 9.0, 0.5, 2.0]), [1.5, 4.0, 1.5, 3.0]);
/// ```
pub fn ranks(values: &[f64]) -> Vec<f64> {
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
        #[test]
        fn it_is_symmetric_bounded_and_blind_to_rising_maps((a, b) in lists()) {
            let Ok(rho) = spearman(&a, &b) else { return Ok(()) };
            prop_assert!((-1.0..=1.0).contains(&rho));
            prop_assert!((spearman(&b, &a).unwrap() - rho).abs() < 1e-12);
            let bent: Vec<f64> = a.iter().map(|value| value * value * value + 7.0).collect();
            prop_assert!((spearman(&bent, &b).unwrap() - rho).abs() < 1e-12);
        }

        #[test]
        fn ranks_add_up_as_if_none_were_equal((a, _) in lists()) {
            let n = a.len() as f64;
            prop_assert_eq!(ranks(&a).iter().sum::<f64>(), n * (n + 1.0) / 2.0);
        }
    }

    #[test]
    fn zero_and_minus_zero_are_equal() {
        assert_eq!(ranks(&[0.0, -0.0, 1.0]), [1.5, 1.5, 3.0]);
    }
}
