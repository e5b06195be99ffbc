//! [`Streams`]: seeds and world indices for the parts of a lifetime. Seeds depend on the lifetime and the purpose of the
//! worlds; the first index for learning depends on the variant.

use driftworld_spec::{MAX_EXPERIENCES, Regime};
use serde::Deserialize;

use super::wanted::MAX_BLOCKS;
use super::{Choice, Design};
use crate::hash::number_of;

/// The purpose of the worlds in evaluation blocks. The two splits have no world in common.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Split {
    /// For choosing hyperparameters and agents.
    Validation,
    /// For reported results.
    #[default]
    Test,
}

/// Number of world indices reserved for each variant: no lifetime learns a variant in more worlds.
const SPAN: u64 = MAX_EXPERIENCES as u64 * MAX_BLOCKS as u64;

/// Size of seeds in bits, small enough for every JSON reader to keep them exact.
const SEED_BITS: u32 = 53;

/// The worlds of one lifetime.
pub(super) struct Streams<'a> {
    options: &'a Design,
    /// Names of all variants, sorted.
    ids: Vec<String>,
}

impl<'a> Streams<'a> {
    pub(super) fn new(variants: &[Choice], options: &'a Design) -> Self {
        let mut ids: Vec<String> = variants.iter().chain(&options.held_out).map(Choice::id).collect();
        ids.sort_unstable();
        ids.dedup();
        Self { options, ids }
    }

    /// `count` learning experiences, after the first `num_learned` of this variant.
    pub(super) fn learning(&self, choice: &Choice, count: u32, num_learned: u64) -> Regime {
        let seed = seed_for(self.options.seed, self.options.lifetime, "learn");
        choice.regime(count, seed, self.start(choice) + num_learned)
    }

    /// Experiences before deployment.
    pub(super) fn before_deployment(&self, choice: &Choice) -> Regime {
        let seed = seed_for(self.options.seed, self.options.lifetime, "before deployment");
        choice.regime(self.options.pre_deployment, seed, 0)
    }

    /// Evaluation, the same each time. All variants use the same world indices, so that they can be compared in pairs.
    pub(super) fn evaluation(&self, choice: &Choice) -> Regime {
        let lifetime = if self.options.fixed_evaluation {
            0
        } else {
            self.options.lifetime
        };
        let purpose = match self.options.split {
            Split::Validation => "validation",
            Split::Test => "test",
        };
        choice.regime(self.options.evaluate, seed_for(self.options.seed, lifetime, purpose), 0)
    }

    /// Index of the first world in which a variant is learned. Independent of the order of the variants.
    fn start(&self, choice: &Choice) -> u64 {
        if self.options.paired_learning {
            return 0;
        }
        let id = choice.id();
        self.ids.partition_point(|other| *other < id) as u64 * SPAN
    }
}

/// A seed for one use in one lifetime, at most 2⁵³ − 1. Similar seeds give unrelated results.
fn seed_for(seed: u64, lifetime: u64, purpose: &str) -> u64 {
    let number = number_of([&seed.to_le_bytes()[..], &lifetime.to_le_bytes(), purpose.as_bytes()]);
    number >> (u64::BITS - SEED_BITS)
}
