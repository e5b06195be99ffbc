//! Relabellings of items: all of them, or a random sample.

use crate::split_mix::SplitMix64;

/// The relabellings of `items` that a test uses; each is computed from its number alone, so any thread can take any of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Relabellings {
    pub(super) count: u64,
    /// Seed of the random ones, drawn with replacement; `None` for all, each once.
    seed: Option<u64>,
}

impl Relabellings {
    /// All of them if there are at most `max_count`, otherwise `max_count` random ones.
    pub(super) fn new(items: usize, max_count: u64, seed: u64) -> Self {
        let all = (1..=items as u64).try_fold(1_u64, u64::checked_mul);
        let few = all.filter(|all| *all <= max_count);
        Self {
            count: few.unwrap_or(max_count),
            seed: few.is_none().then_some(seed),
        }
    }

    pub(super) fn is_all(self) -> bool {
        self.seed.is_none()
    }

    /// Writes relabelling `number` into `labels`, which has one entry per item.
    pub(super) fn write(self, number: u64, labels: &mut [usize]) {
        for (k, label) in labels.iter_mut().enumerate() {
            *label = k;
        }
        let mut rng = self.seed.map(|seed| SplitMix64::keyed(seed, number));
        // Without a seed, the digits of the number in the factorial number system choose the swaps.
        let mut rest = number;
        for last in (1..labels.len()).rev() {
            let choices = last as u64 + 1;
            let chosen = rng.as_mut().map_or(rest % choices, |rng| rng.unbiased_below(choices));
            labels.swap(last, chosen as usize);
            rest /= choices;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;

    fn counts(relabellings: Relabellings, items: usize) -> BTreeMap<Vec<usize>, u32> {
        let mut counts = BTreeMap::new();
        let mut labels = vec![0; items];
        for number in 0..relabellings.count {
            relabellings.write(number, &mut labels);
            *counts.entry(labels.clone()).or_default() += 1;
        }
        counts
    }

    #[test]
    fn all_relabellings_occur_once_if_few() {
        for items in 1..=6 {
            let all = Relabellings::new(items, 720, 1);
            assert!(all.is_all());
            let counts = counts(all, items);
            assert_eq!(counts.len() as u64, all.count);
            assert!(counts.values().all(|count| *count == 1));
        }
        assert_eq!(
            Relabellings::new(7, 720, 1),
            Relabellings {
                count: 720,
                seed: Some(1)
            }
        );
        assert!(!Relabellings::new(30, u64::MAX, 1).is_all(), "30! does not fit");
    }

    #[test]
    fn drawn_relabellings_are_uniform_and_depend_on_the_seed() {
        let drawn = |seed| Relabellings {
            count: 24_000,
            seed: Some(seed),
        };
        let counts_of = |seed| counts(drawn(seed), 4);
        let found = counts_of(7);
        let chi_squared: f64 = found
            .values()
            .map(|count| (f64::from(*count) - 1000.0).powi(2) / 1000.0)
            .sum();
        assert_eq!(found.len(), 24);
        assert!(chi_squared < 49.73, "23 degrees of freedom, α = 0.001: {chi_squared}");
        assert_eq!(found, counts_of(7));
        assert_ne!(found, counts_of(8));
    }
}
