//! What a lifetime came to, regime by regime, counted while it is lived or from its log. What lifelong learning makes of it is `metrics`'.

use driftworld_spec::BlockKind;

use super::plan::Planned;

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
    /// What it paid.
    pub reward: f64,
}

/// What a lifetime came to.
#[derive(Clone, Debug, Default, PartialEq, serde::Serialize)]
pub struct Summary {
    /// Experiences that were lived.
    pub experiences: u64,
    /// Steps in all of them.
    pub steps: u64,
    /// Whether the whole scenario was lived.
    pub finished: bool,
    /// One row for each regime that was begun.
    pub regimes: Vec<RegimeSummary>,
}

/// What a regime came to.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct RegimeSummary {
    /// The block, from 0.
    pub block: usize,
    /// Whether the agent learned.
    pub kind: BlockKind,
    /// The variant, as `task#variant`.
    pub variant: String,
    /// Experiences.
    pub experiences: u32,
    /// Mean of their rewards.
    pub mean_reward: f64,
    /// Share of them that were successes.
    pub success_rate: f64,
}

impl Summary {
    /// Takes the next experience into account; `first` says that its regime begins with it.
    pub(super) fn count(&mut self, planned: &Planned, first: bool, reward: f64, success: f64, steps: u64) {
        if first {
            self.regimes.push(RegimeSummary {
                block: planned.block,
                kind: planned.kind,
                variant: planned.id.clone(),
                experiences: 0,
                mean_reward: 0.0,
                success_rate: 0.0,
            });
        }
        self.experiences += 1;
        self.steps += steps;
        if let Some(row) = self.regimes.last_mut() {
            let before = f64::from(row.experiences);
            row.experiences += 1;
            let mean = |old: f64, new: f64| (old * before + new) / (before + 1.0);
            row.mean_reward = mean(row.mean_reward, reward);
            row.success_rate = mean(row.success_rate, success);
        }
    }
}
