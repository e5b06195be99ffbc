//! Relabellings of items: all of them, or some drawn at random. What is compared under them is in `mantel.rs`.

use crate::split_mix::SplitMix64;

/// The ways in which `items` can change labels that a test goes through; each is found by its number alone, so that any thread
/// may take any of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Relabellings {
    /// Each of them once.
    All {
        /// `items!`.
        count: u64,
    },
    /// Some at random, with repetitions.
    Drawn {
        /// How many.
        count: u64,
        /// What they are drawn from.
        seed: u64,
    },
}

impl Relabellings {
    /// All of them where there are at most `most`, otherwise `most` of them.
    pub(super) fn new(items: usize, most: u64, seed: u64) -> Self {
        let all = (1..=items as u64).try_fold(1_u64, u64::checked_mul);
        match all.filter(|all| *all <= most) {
            Some(count) => Self::All { count },
            None => Self::Drawn { count: most, seed },
        }
    }

    pub(super) fn count(self) -> u64 {
        match self {
            Self::All { count } | Self::Drawn { count, .. } => count,
        }
    }

    pub(super) fn is_all(self) -> bool {
        matches!(self, Self::All { .. })
    }

    /// Puts relabelling `number` into `labels`, which holds one place for each item.
    pub(super) fn write(self, number: u64, labels: &mut [usize]) {
        for (k, label) in labels.iter_mut().enumerate() {
            *label = k;
        }
        match self {
            Self::All { .. } => {
                // The digits of the number in the factorial number system choose who changes places.
                let mut rest = number;
                for last in (1..labels.len()).rev() {
                    let choices = last as u64 + 1;
                    labels.swap(last, (rest % choices) as usize);
                    rest /= choices;
                }
            }
            Self::Drawn { seed, .. } => {
                let mut rng = SplitMix64::keyed(seed, number);
                for last in (1..labels.len()).rev() {
                    labels.swap(last, rng.unbiased_below(last as u64 + 1) as usize);
                }
            }
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
        for number in 0..relabellings.count() {
            relabellings.write(number, &mut labels);
            *counts.entry(labels.clone()).or_default() += 1;
        }
        counts
    }

    #[test]
    fn all_are_gone_through_once_where_they_are_few() {
        for items in 1..=6 {
            let all = Relabellings::new(items, 720, 1);
            assert!(all.is_all());
            let counts = counts(all, items);
            assert_eq!(counts.len() as u64, all.count());
            assert!(counts.values().all(|count| *count == 1));
        }
        assert_eq!(
            Relabellings::new(7, 720, 1),
            Relabellings::Drawn { count: 720, seed: 1 }
        );
        assert!(!Relabellings::new(30, u64::MAX, 1).is_all(), "30! does not fit");
    }

    #[test]
    fn drawn_ones_are_as_likely_as_each_other_and_depend_on_the_seed() {
        let counts_of = |seed| counts(Relabellings::Drawn { count: 24_000, seed }, 4);
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
