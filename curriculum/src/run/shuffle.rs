//! [`Shuffle`]: the order of the experiences of a shuffled block.

use crate::hash::number_of;

/// Rounds of the network; four turn a pseudorandom function into a pseudorandom permutation (Luby and Rackoff 1988).
const ROUNDS: u64 = 4;

/// A keyed permutation of a range of numbers that needs no memory: a Feistel network over the smallest even number of bits
/// that holds the range, iterated until the result is in the range.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Shuffle {
    first: u64,
    count: u64,
    key: u64,
    half_bits: u32,
}

impl Shuffle {
    /// A permutation of `first..first + count`.
    pub(super) fn new(first: u64, count: u64, key: u64) -> Self {
        let bits = u64::BITS - count.saturating_sub(1).leading_zeros();
        Self {
            first,
            count,
            key,
            half_bits: bits.div_ceil(2).max(1),
        }
    }

    /// The position, in the list of regimes, of the experience that is run at this number.
    pub(super) fn position(&self, number: u64) -> u64 {
        self.walk(number, |shuffle, x| {
            (0..ROUNDS).fold(x, |x, round| shuffle.mix(x, round))
        })
    }

    /// The number at which the experience at this position in the list of regimes is run.
    pub(super) fn number(&self, position: u64) -> u64 {
        self.walk(position, |shuffle, x| {
            (0..ROUNDS).rev().fold(x, |x, round| shuffle.unmix(x, round))
        })
    }

    fn walk(&self, from: u64, step: impl Fn(&Self, u64) -> u64) -> u64 {
        let mut x = step(self, from - self.first);
        // A permutation returns to its start, which is in the range.
        while x >= self.count {
            x = step(self, x);
        }
        self.first + x
    }

    fn mix(&self, x: u64, round: u64) -> u64 {
        let (left, right) = (x >> self.half_bits, x & self.mask());
        right << self.half_bits | (left ^ self.hash(right, round))
    }

    fn unmix(&self, x: u64, round: u64) -> u64 {
        let (right, mixed) = (x >> self.half_bits, x & self.mask());
        (mixed ^ self.hash(right, round)) << self.half_bits | right
    }

    fn hash(&self, half: u64, round: u64) -> u64 {
        number_of([self.key, round, half].map(u64::to_le_bytes)) & self.mask()
    }

    fn mask(&self) -> u64 {
        (1 << self.half_bits) - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn every_experience_occurs_once(first in 0..1_000_000_u64, count in 1..300_u64, key in any::<u64>()) {
            let shuffle = Shuffle::new(first, count, key);
            let mut positions: Vec<u64> = (first..first + count).map(|number| shuffle.position(number)).collect();
            for (number, position) in (first..).zip(&positions) {
                prop_assert_eq!(shuffle.number(*position), number);
            }
            positions.sort_unstable();
            prop_assert!(positions.into_iter().eq(first..first + count));
        }
    }

    #[test]
    fn every_order_of_three_is_about_equally_frequent() {
        let mut counts = std::collections::BTreeMap::new();
        for key in 0..6000 {
            let order: Vec<u64> = (0..3).map(|number| Shuffle::new(0, 3, key).position(number)).collect();
            *counts.entry(order).or_insert(0) += 1;
        }
        // Four standard deviations of a count of 6,000 · 1/6.
        assert!(
            counts.len() == 6 && counts.values().all(|count: &i32| (count - 1000).abs() < 116),
            "{counts:?}"
        );
    }
}
