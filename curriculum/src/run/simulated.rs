//! The part of an experience that a simulated agent needs to compute its reward.

use driftworld_spec::BlockKind;

use super::plan::Plan;

/// The data of an experience from which a simulated agent computes its reward.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ExperienceData {
    /// Its number over the whole lifetime.
    pub(crate) number: u64,
    /// Its number in its block.
    pub(crate) number_in_block: u64,
    /// Whether the agent may learn.
    pub(crate) learning: bool,
    /// Its variant; in a drift, the nearer end.
    pub(crate) variant: String,
    /// Seed and index of its world; variants of one task with the same seed and index have the same layout.
    pub(crate) layout: [u64; 2],
}

impl Plan {
    /// The data of an experience for a simulated agent.
    pub(crate) fn experience_data(&self, number: u64) -> ExperienceData {
        let index = self.regime_of(number);
        let planned = &self.regimes[index];
        let before = self.regimes[..index].iter().rev();
        let block = before.take_while(|other| other.block == planned.block).last();
        ExperienceData {
            number,
            number_in_block: number - block.unwrap_or(planned).first,
            learning: planned.kind == BlockKind::Learning,
            variant: planned.nearest(number),
            layout: if planned.is_drawn() {
                [planned.seed, planned.index_of(number)]
            } else {
                [0, 0]
            },
        }
    }
}
