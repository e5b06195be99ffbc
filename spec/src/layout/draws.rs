//! [`Draws`]: random numbers of a layout, with a separate stream for each purpose.

use crate::philox::philox;

/// The second word of a layout's Philox key.
const DOMAIN: u64 = 0x6c61_796f_7574_2031;

/// The purpose of a stream of random numbers.
#[derive(Clone, Copy, Debug)]
pub(super) enum Purpose {
    /// The spanning tree of a maze, or of connected rooms.
    Tree = 1,
    /// Which dead ends are opened, and where; which additional walls between rooms get doorways.
    Loops = 2,
    /// The position of a doorway in its wall.
    Doorways = 3,
    /// The order in which walls are removed.
    Standing = 4,
}

/// A stream of integers.
pub(super) struct Draws {
    key: [u64; 2],
    counter: [u64; 4],
    numbers: [u64; 4],
    /// Number of 32-bit halves of `numbers` already used.
    used: usize,
}

impl Draws {
    pub(super) fn new(seed: u64, purpose: Purpose) -> Self {
        Self {
            key: [seed, DOMAIN],
            counter: [0, purpose as u64, 0, 0],
            numbers: [0; 4],
            used: 8,
        }
    }

    /// An integer below `bound`, taken from the high half of a product; the bias is below `bound / 2³²`.
    pub(super) fn below(&mut self, bound: usize) -> usize {
        if self.used == 8 {
            self.numbers = philox(self.key, self.counter);
            self.counter[0] += 1;
            self.used = 0;
        }
        let half = (self.numbers[self.used / 2] >> (32 * (self.used % 2))) & 0xffff_ffff;
        self.used += 1;
        ((half * bound as u64) >> 32) as usize
    }

    /// Shuffles items (Fisher–Yates).
    pub(super) fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}

/// The given share, 0..=1, of `all`, rounded to the nearest integer.
pub(super) fn share_of(share: f64, all: usize) -> usize {
    ((share * all as f64).round() as usize).min(all)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_cover_all_integers_below_the_bound() {
        let mut draws = Draws::new(7, Purpose::Tree);
        let mut seen = [0_u32; 5];
        for _ in 0..5000 {
            seen[draws.below(5)] += 1;
        }
        assert!(seen.iter().all(|count| (900..1100).contains(count)), "{seen:?}");
    }

    #[test]
    fn seeds_and_purposes_have_separate_streams() {
        let first = |seed, purpose| Draws::new(seed, purpose).below(1 << 31);
        let all = [
            first(1, Purpose::Tree),
            first(2, Purpose::Tree),
            first(1, Purpose::Loops),
            first(1, Purpose::Standing),
        ];
        let different: std::collections::BTreeSet<usize> = all.into_iter().collect();
        assert_eq!(different.len(), all.len());
    }
}
