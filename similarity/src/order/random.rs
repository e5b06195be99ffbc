//! Random orders from a seed, as controls.

use super::items::Items;
use crate::split_mix::SplitMix64;

pub(super) fn order(items: &Items, seed: u64) -> Vec<usize> {
    let mut ranks: Vec<usize> = (0..items.len()).collect();
    let mut rng = SplitMix64(seed);
    // Fisher and Yates: every order is equally likely.
    for index in (1..ranks.len()).rev() {
        ranks.swap(index, rng.below(index as u64 + 1) as usize);
    }
    items.with_fixed_ends(ranks)
}
