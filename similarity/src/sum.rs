//! [`sum`]: sums without accumulated rounding errors.

/// A sum whose error does not grow with the number of terms (Neumaier 1974): about one rounding of the sum of absolute values.
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
    fn small_terms_beside_large_ones_are_kept() {
        assert_eq!(sum([1.0, 1e100, 1.0, -1e100]), 2.0);
        let tenths = sum((0..1_000_000).map(|_| 0.1));
        assert!((tenths - 100_000.0).abs() < 1e-10, "{tenths}");
    }
}
