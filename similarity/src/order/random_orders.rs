//! Compares an order's length with the lengths of random orders.

use super::ordering::Ordering;
use crate::DistanceMatrix;
use crate::split_mix::SplitMix64;

/// Number of random orders in a comparison.
pub const NUM_RANDOM_ORDERS: u32 = 1000;

/// The share of [`NUM_RANDOM_ORDERS`] random orders of all items that are shorter than this one, in 0..=1.
///
/// `seed` is the seed of the random orders. Near 0 for a short path, near 1 for a long one, around 0.5 for a random one;
/// lengths that agree to twelve digits are not shorter. Time `O(n)` per order.
///
/// # Example
/// ```
/// use driftworld_similarity::{DistanceMatrix, Ordering, SimilarityError, share_of_shorter_orders};
/// let at = [0.0_f64, 1.0, 2.0, 3.0, 4.0];
/// let names = ["a", "b", "c", "d", "e"].map(String::from).to_vec();
/// let matrix = DistanceMatrix::measure(names, |a, b| Ok::<_, SimilarityError>((at[a] - at[b]).abs()))?;
/// let straight = Ordering::given(&matrix, vec![0, 1, 2, 3, 4]);
/// assert_eq!(share_of_shorter_orders(&matrix, &straight, 0), 0.0);
/// # Ok::<(), SimilarityError>(())
/// ```
pub fn share_of_shorter_orders(matrix: &DistanceMatrix, ordering: &Ordering, seed: u64) -> f64 {
    let mut rng = SplitMix64(seed);
    let mut items: Vec<usize> = (0..matrix.len()).collect();
    let below = ordering.length * (1.0 - 1e-12);
    let mut shorter = 0_u32;
    for _ in 0..NUM_RANDOM_ORDERS {
        // Fisher and Yates: every order is equally likely.
        for index in (1..items.len()).rev() {
            items.swap(index, rng.below(index as u64 + 1) as usize);
        }
        let length: f64 = items.windows(2).map(|pair| matrix.get(pair[0], pair[1])).sum();
        shorter += u32::from(length < below);
    }
    f64::from(shorter) / f64::from(NUM_RANDOM_ORDERS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SimilarityError;

    #[test]
    fn share_matches_the_exact_share_within_sampling_error() {
        // Of the six orders of 0, 1 and 3, two have length 3, two 4 and two 5.
        let at = [0.0_f64, 1.0, 3.0];
        let names = ["a", "b", "c"].map(str::to_owned).to_vec();
        let matrix = DistanceMatrix::measure(names, |a, b| Ok::<_, SimilarityError>((at[a] - at[b]).abs())).unwrap();
        for (order, expected) in [
            (vec![0, 1, 2], 0.0),
            (vec![1, 0, 2], 1.0 / 3.0),
            (vec![0, 2, 1], 2.0 / 3.0),
        ] {
            let share = share_of_shorter_orders(&matrix, &Ordering::given(&matrix, order), 7);
            assert!((share - expected).abs() < 0.06, "{share} for {expected}");
        }
    }
}
