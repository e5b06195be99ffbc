//! Summarises a lifetime regime by regime, during the run or from its log.

use std::collections::BTreeMap;

use driftworld_spec::BlockKind;

use super::planned::Planned;

/// The progress of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Experiences finished.
    pub done: u64,
    /// Experiences of the whole lifetime.
    pub total: u64,
    /// The block of the last experience, from 0.
    pub block: usize,
    /// Whether the agent learned in it.
    pub kind: BlockKind,
    /// Its variant, as `task#variant`.
    pub variant: String,
    /// Its reward; NaN if it was skipped.
    pub reward: f64,
}

/// The summary of a lifetime.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Summary {
    /// Experiences that were run.
    pub experiences: u64,
    /// Experiences that were skipped because their worlds could not be drawn.
    pub skipped: u64,
    /// The first of those, at most 100.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<LeftOut>,
    /// Total steps that were run.
    pub steps: u64,
    /// How often each cause ended an experience, by the words of the log's column [`ENDED_BY`](super::ENDED_BY); `unknown` if the
    /// log does not name the cause.
    pub ended_by: BTreeMap<String, u64>,
    /// Whether the whole scenario was run.
    pub finished: bool,
    /// One row for each regime that was started.
    pub regimes: Vec<RegimeSummary>,
}

/// An experience that was skipped.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct LeftOut {
    /// The experience, from 0 over the whole lifetime.
    pub experience: u64,
    /// The block, from 0.
    pub block: usize,
    /// The variant, as `task#variant`.
    pub variant: String,
    /// Progress of a drift, 0..=1; 0 without a drift.
    pub progress: f64,
    /// Why its world could not be drawn.
    pub reason: String,
}

/// The summary of a regime.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct RegimeSummary {
    /// The block, from 0.
    pub block: usize,
    /// The regime in its block, from 0.
    #[serde(skip)]
    pub regime: usize,
    /// Whether the agent learned.
    pub kind: BlockKind,
    /// The variant, as `task#variant`.
    pub variant: String,
    /// Experiences that were run.
    pub experiences: u32,
    /// Experiences that were skipped.
    pub skipped: u32,
    /// Mean of the rewards of those that were run.
    pub mean_reward: f64,
    /// Share of them that were successes.
    pub success_rate: f64,
}

/// Maximum number of skipped experiences that a summary lists.
const MAX_LISTED: usize = 100;

impl Summary {
    /// Counts the next experience; `ended_by` is the word for what ended it.
    pub(super) fn count(&mut self, planned: &Planned, reward: f64, success: f64, steps: u64, ended_by: &str) {
        self.experiences += 1;
        match self.ended_by.get_mut(ended_by) {
            Some(count) => *count += 1,
            None => drop(self.ended_by.insert(ended_by.to_owned(), 1)),
        }
        self.steps += steps;
        let row = self.row(planned);
        let before = f64::from(row.experiences);
        row.experiences += 1;
        let mean = |old: f64, new: f64| (old * before + new) / (before + 1.0);
        row.mean_reward = mean(row.mean_reward, reward);
        row.success_rate = mean(row.success_rate, success);
    }

    /// Counts the next experience, `number`, as skipped.
    pub(super) fn leave_out(&mut self, planned: &Planned, number: u64, reason: &str) {
        self.skipped += 1;
        self.row(planned).skipped += 1;
        if self.left_out.len() < MAX_LISTED {
            self.left_out.push(LeftOut {
                experience: number,
                block: planned.block,
                variant: planned.id.clone(),
                progress: planned.progress(number),
                reason: reason.to_owned(),
            });
        }
    }

    fn row(&mut self, planned: &Planned) -> &mut RegimeSummary {
        // Regimes alternate in a shuffled block, so this one need not be the last.
        let first = self.regimes.partition_point(|row| row.block < planned.block);
        let mut of_block = self.regimes[first..].iter();
        let known = of_block.rposition(|row| row.regime == planned.regime);
        let index = known.map_or(self.regimes.len(), |index| first + index);
        if known.is_none() {
            self.regimes.push(RegimeSummary {
                block: planned.block,
                regime: planned.regime,
                kind: planned.kind,
                variant: planned.id.clone(),
                experiences: 0,
                skipped: 0,
                mean_reward: 0.0,
                success_rate: 0.0,
            });
        }
        &mut self.regimes[index]
    }
}
