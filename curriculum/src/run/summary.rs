//! What a lifetime came to, regime by regime, counted while it is lived or from its log. What lifelong learning makes of it is `metrics`'.

use std::collections::BTreeMap;

use driftworld_spec::BlockKind;

use super::planned::Planned;

/// How far a run has come.
#[derive(Clone, Debug, PartialEq)]
pub struct Progress {
    /// Experiences that are over.
    pub done: u64,
    /// Experiences of the whole lifetime.
    pub total: u64,
    /// The block of the last one, from 0.
    pub block: usize,
    /// Whether the agent learned in it.
    pub kind: BlockKind,
    /// Its variant, as `task#variant`.
    pub variant: String,
    /// What it paid; NaN for one that was left out.
    pub reward: f64,
}

/// What a lifetime came to.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Summary {
    /// Experiences that were lived.
    pub experiences: u64,
    /// Experiences that were left out because their worlds could not be drawn.
    pub skipped: u64,
    /// The first of those, 100 at most.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub left_out: Vec<LeftOut>,
    /// Steps in all that were lived.
    pub steps: u64,
    /// How many of those that were lived were ended by what, by the words of the log's column
    /// [`ENDED_BY`](super::ENDED_BY): `unknown` where the log does not say.
    pub ended_by: BTreeMap<String, u64>,
    /// Whether the whole scenario was lived.
    pub finished: bool,
    /// One row for each regime that was begun.
    pub regimes: Vec<RegimeSummary>,
}

/// An experience that was left out.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct LeftOut {
    /// The experience, from 0 over the whole lifetime.
    pub experience: u64,
    /// The block, from 0.
    pub block: usize,
    /// The variant, as `task#variant`.
    pub variant: String,
    /// How far on its way a drift is, 0..=1; 0 where nothing drifts.
    pub progress: f64,
    /// Why its world could not be drawn.
    pub reason: String,
}

/// What a regime came to.
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
    /// Experiences that were lived.
    pub experiences: u32,
    /// Experiences that were left out.
    pub skipped: u32,
    /// Mean of the rewards of those that were lived.
    pub mean_reward: f64,
    /// Share of them that were successes.
    pub success_rate: f64,
}

/// The most experiences that a summary names as left out.
const MOST_NAMED: usize = 100;

impl Summary {
    /// Takes the next experience into account, which was ended by what the word says.
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

    /// Takes into account that the next experience, `number`, is left out.
    pub(super) fn leave_out(&mut self, planned: &Planned, number: u64, reason: &str) {
        self.skipped += 1;
        self.row(planned).skipped += 1;
        if self.left_out.len() < MOST_NAMED {
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
        // A block that is shuffled comes back to its regimes.
        let first = self.regimes.partition_point(|row| row.block < planned.block);
        let mut of_block = self.regimes[first..].iter();
        let known = of_block.rposition(|row| row.regime == planned.regime);
        let index = known.map_or(self.regimes.len(), |place| first + place);
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
