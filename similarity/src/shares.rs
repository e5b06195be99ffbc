//! [`shares`]: weights as shares of their sum, and sums that do not gather rounding. What is weighted is known elsewhere.

use crate::SimilarityError;

/// Weights divided by their sum. They are at least 0, finite, as many as `count`, and one is above 0.
pub(crate) fn shares(of: &'static str, weights: &[f64], count: usize) -> Result<Vec<f64>, SimilarityError> {
    if weights.len() != count {
        return Err(SimilarityError::Shape {
            of,
            found: weights.len(),
            expected: count,
        });
    }
    for (index, &found) in weights.iter().enumerate() {
        if !(0.0..=1e200).contains(&found) {
            return Err(SimilarityError::BadMass { side: of, index, found });
        }
    }
    let sum = sum(weights.iter().copied());
    if sum < 1e-200 {
        return Err(SimilarityError::BadNumber {
            of,
            found: sum,
            expected: "weights whose sum is at least 1e-200",
        });
    }
    Ok(weights.iter().map(|weight| weight / sum).collect())
}

/// As many equal shares as there are places.
pub(crate) fn equal_shares(count: usize) -> Vec<f64> {
    vec![1.0 / count as f64; count]
}

/// A sum whose error does not grow with the number of terms (Neumaier 1974): about one rounding of the sum of their sizes.
pub(crate) fn sum(terms: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut lost) = (0.0_f64, 0.0);
    for term in terms {
        let next = sum + term;
        lost += if sum.abs() >= term.abs() {
            (sum - next) + term
        } else {
            (term - next) + sum
        };
        sum = next;
    }
    sum + lost
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_add_up_to_1_and_keep_their_proportions() {
        assert_eq!(shares("weights", &[1.0, 0.0, 3.0], 3).unwrap(), [0.25, 0.0, 0.75]);
        assert_eq!(equal_shares(4), [0.25; 4]);
    }

    #[test]
    fn weights_that_are_none_are_refused() {
        let code = |weights: &[f64]| shares("weights", weights, 2).unwrap_err().code();
        assert_eq!(code(&[1.0]), "similarity/shape");
        assert_eq!(code(&[1.0, -1.0]), "similarity/bad-mass");
        assert_eq!(code(&[1.0, f64::NAN]), "similarity/bad-mass");
        assert_eq!(code(&[0.0, 0.0]), "similarity/bad-number");
    }

    #[test]
    fn small_terms_beside_large_ones_are_not_lost() {
        assert_eq!(sum([1.0, 1e100, 1.0, -1e100]), 2.0);
        let tenths = sum((0..1_000_000).map(|_| 0.1));
        assert!((tenths - 100_000.0).abs() < 1e-10, "{tenths}");
    }
}
