//! [`SortedSamples`]: distances between numbers that were drawn. Those between declared distributions are beside.

use crate::SimilarityError;

/// Numbers that were drawn, in rising order: sorted once, compared with many.
///
/// Each measure takes the samples for the distribution that draws each of them alike, so it is as exact as the samples are
/// many. Total variation, Hellinger and the divergences are not offered: between samples of a density they are 1, or whatever
/// the width of a histogram's bars makes them.
///
/// # Example
/// ```
/// use driftworld_similarity::distribution::SortedSamples;
/// let (a, b) = (SortedSamples::new(&[3.0, 1.0])?, SortedSamples::new(&[2.0, 6.0])?);
/// assert_eq!(a.wasserstein_1(&b), 2.0);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SortedSamples {
    numbers: Vec<f64>,
    keys: Vec<i64>,
}

impl SortedSamples {
    /// Sorts a copy. Time `O(n log n)`: about a microsecond for 256.
    ///
    /// # Errors
    /// [`SimilarityError::NoSamples`] and [`SimilarityError::NotASample`].
    pub fn new(numbers: &[f64]) -> Result<Self, SimilarityError> {
        let mut samples = Self::default();
        samples.refill(numbers)?;
        Ok(samples)
    }

    /// Takes other numbers instead, in the memory that is there.
    ///
    /// # Errors
    /// [`SimilarityError::NoSamples`] and [`SimilarityError::NotASample`]; the samples are as before then.
    pub fn refill(&mut self, numbers: &[f64]) -> Result<(), SimilarityError> {
        if numbers.is_empty() {
            return Err(SimilarityError::NoSamples);
        }
        if let Some(index) = numbers.iter().position(|number| !number.is_finite()) {
            let found = numbers[index];
            return Err(SimilarityError::NotASample { index, found });
        }
        // Whole numbers in the same order sort faster, without a branch for each comparison. Adding 0 turns −0 into 0.
        let flip = |bits: i64| bits ^ (((bits >> 63) as u64) >> 1) as i64;
        self.keys.clear();
        let keys = numbers.iter().map(|number| flip((number + 0.0).to_bits() as i64));
        self.keys.extend(keys);
        self.keys.sort_unstable();
        self.numbers.clear();
        let sorted = self.keys.iter().map(|key| f64::from_bits(flip(*key) as u64));
        self.numbers.extend(sorted);
        Ok(())
    }

    /// The numbers in rising order.
    pub fn numbers(&self) -> &[f64] {
        &self.numbers
    }

    /// Least work that turns the one into the other, in the units of the numbers.
    ///
    /// A metric in `0..`. Time `O(n + m)`; for as many on both sides the mean of |x − y| over pairs of one rank. The same
    /// numbers as `scipy.stats.wasserstein_distance`.
    pub fn wasserstein_1(&self, other: &Self) -> f64 {
        if self.numbers.len() == other.numbers.len() {
            return mean_of_pairs(&self.numbers, &other.numbers, |gap| gap.abs());
        }
        over_ranks(&self.numbers, &other.numbers, f64::abs)
    }

    /// Root mean square of how far each number moves, in the units of the numbers.
    ///
    /// A metric in `0..`. Time `O(n + m)`. The root of `ot.wasserstein_1d(p=2)`.
    pub fn wasserstein_2(&self, other: &Self) -> f64 {
        if self.numbers.len() == other.numbers.len() {
            return mean_of_pairs(&self.numbers, &other.numbers, |gap| gap * gap).sqrt();
        }
        over_ranks(&self.numbers, &other.numbers, |gap| gap * gap).sqrt()
    }

    /// √(2 ∫ (F − G)²), in roots of the numbers' unit.
    ///
    /// A metric in `0..`. Time `O(n + m)`. The same numbers as `scipy.stats.energy_distance`.
    pub fn energy(&self, other: &Self) -> f64 {
        let (a, b) = (&self.numbers, &other.numbers);
        let (mut i, mut j, mut sum) = (0, 0, 0.0);
        let mut before = a[0].min(b[0]);
        while i < a.len() || j < b.len() {
            let here = match (a.get(i), b.get(j)) {
                (Some(x), Some(y)) => x.min(*y),
                (Some(only), None) | (None, Some(only)) => *only,
                (None, None) => break,
            };
            let gap = i as f64 / a.len() as f64 - j as f64 / b.len() as f64;
            sum += gap * gap * (here - before);
            before = here;
            while a.get(i) == Some(&here) {
                i += 1;
            }
            while b.get(j) == Some(&here) {
                j += 1;
            }
        }
        (2.0 * sum).sqrt()
    }

    /// Maximum mean discrepancy with the kernel exp(−(x − y)² / 2 bandwidth²).
    ///
    /// A metric in `0..√2` for one bandwidth, which is above 0 and in the units of the numbers. The biased estimate, which
    /// counts each number with itself: never below 0, and 0 for the same samples. Time `O((n + m)²)`.
    ///
    /// Source: Gretton et al. 2012, "A kernel two-sample test", equation 5.
    pub fn maximum_mean_discrepancy(&self, other: &Self, bandwidth: f64) -> f64 {
        if self == other {
            return 0.0;
        }
        let mean = |a: &[f64], b: &[f64]| {
            let row = |x: &f64| -> f64 {
                let each = b.iter().map(|y| (x - y) / bandwidth);
                each.map(|z| libm::exp(-0.5 * z * z)).sum()
            };
            a.iter().map(row).sum::<f64>() / (a.len() as f64 * b.len() as f64)
        };
        let (a, b) = (&self.numbers, &other.numbers);
        (mean(a, a) + mean(b, b) - 2.0 * mean(a, b)).max(0.0).sqrt()
    }
}

/// The mean over pairs, in eight sums at a time, always the same way.
fn mean_of_pairs(a: &[f64], b: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    let mut sums = [0.0; 8];
    let (a_eights, a_rest) = a.as_chunks::<8>();
    let (b_eights, b_rest) = b.as_chunks::<8>();
    for (x, y) in a_eights.iter().zip(b_eights) {
        for k in 0..8 {
            sums[k] += of(x[k] - y[k]);
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| of(x - y)).sum();
    (sums.iter().sum::<f64>() + rest) / a.len() as f64
}

/// The mean over all chances, where one list may be longer than the other.
fn over_ranks(a: &[f64], b: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    // Chance is counted in whole steps of 1 / (n m), so that no rounding shifts a rank.
    let (n, m) = (a.len() as u64, b.len() as u64);
    let (mut i, mut j, mut from, mut sum) = (0, 0, 0, 0.0);
    while i < n && j < m {
        let (a_end, b_end) = ((i + 1) * m, (j + 1) * n);
        let to = a_end.min(b_end);
        sum += (to - from) as f64 * of(a[i as usize] - b[j as usize]);
        from = to;
        i += u64::from(a_end == to);
        j += u64::from(b_end == to);
    }
    sum / (n * m) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution;
    use driftworld_spec::{Distribution, Value};
    use proptest::prelude::*;

    fn declared(numbers: &[f64]) -> Distribution {
        Distribution::Choice {
            values: numbers.iter().map(|number| Value::Number(*number)).collect(),
            weights: None,
        }
    }

    #[test]
    fn what_is_no_number_is_refused() {
        assert!(SortedSamples::new(&[]).is_err());
        assert!(SortedSamples::new(&[1.0, f64::NAN]).is_err());
        let zeros = SortedSamples::new(&[0.0, -0.0, -1.0]).unwrap();
        assert_eq!(zeros.numbers(), [-1.0, 0.0, 0.0]);
    }

    proptest! {
        #[test]
        fn samples_are_as_far_as_the_choices_of_them(
            a in prop::collection::vec(-9.0..9.0, 1..40), b in prop::collection::vec(-9.0..9.0, 1..40)
        ) {
            let (x, y) = (SortedSamples::new(&a).unwrap(), SortedSamples::new(&b).unwrap());
            let (p, q) = (declared(&a), declared(&b));
            let near = |found: f64, expected: f64| (found - expected).abs() < 1e-9;
            prop_assert!(near(x.wasserstein_1(&y), distribution::wasserstein_1(&p, &q).unwrap().value));
            prop_assert!(near(x.wasserstein_2(&y), distribution::wasserstein_2(&p, &q).unwrap().value));
            prop_assert!(near(x.energy(&y), distribution::energy(&p, &q).unwrap().value));
            prop_assert!(near(
                x.maximum_mean_discrepancy(&y, 1.5),
                distribution::maximum_mean_discrepancy(&p, &q, 1.5).unwrap().value
            ));
            prop_assert_eq!(x.wasserstein_1(&y), y.wasserstein_1(&x));
        }
    }
}
