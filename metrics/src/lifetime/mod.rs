//! A lifetime prepared for scoring: its tasks, its regimes in order, and its single-task experts.

mod budget;
mod drift;
mod prepare;
mod regime;
mod ste;
mod usable;
mod worlds;

use indexmap::IndexMap;

pub(crate) use budget::{Budget, budgets, task_learned};
pub use drift::{Drift, logged_word};
pub(crate) use regime::mean_per_experience;
pub use regime::{MAX_REGIMES, Regime};
pub(crate) use ste::SteRun;
pub use ste::{SteLog, experts_serving, read_ste_log};
pub(crate) use usable::complete_rows;
pub(crate) use worlds::{World, worlds};

use crate::{BlockSubtype, BlockType, DataRange};

/// One agent's lifetime after preprocessing, ready to be scored or drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Lifetime {
    run_id: String,
    tasks: Vec<String>,
    regimes: Vec<Regime>,
    sleeps: bool,
    experts: IndexMap<String, Vec<SteRun>>,
    normalization_data_range: Option<IndexMap<String, DataRange>>,
    runtime_secs: f64,
}

impl Lifetime {
    /// Name of the log.
    pub fn run_id(&self) -> &str {
        &self.run_id
    }

    /// All tasks in lower case: trained tasks in order of their first learning block, then the others in order of their first
    /// evaluation block.
    pub fn tasks(&self) -> &[String] {
        &self.tasks
    }

    /// All regimes in order.
    pub fn regimes(&self) -> &[Regime] {
        &self.regimes
    }

    /// The regimes of one task, in order.
    pub fn regimes_of(&self, task: &str) -> impl Iterator<Item = &Regime> {
        self.regimes.iter().filter(move |regime| regime.task_name == task)
    }

    /// The regimes in which a task is evaluated or learned, in order, including drifts that count as learning it.
    pub(crate) fn regimes_about(&self, task: &str) -> impl Iterator<Item = &Regime> {
        self.regimes.iter().filter(move |regime| match regime.block_type {
            BlockType::Test => regime.task_name == task,
            BlockType::Train => regime.learns.iter().any(|learned| learned == task),
        })
    }

    /// The runs of a task's single-task expert.
    pub(crate) fn experts_of(&self, task: &str) -> &[SteRun] {
        self.experts.get(task).map_or(&[], Vec::as_slice)
    }

    /// The preprocessed learning curves of a task's single-task expert, one per run, in the order in which the runs were given.
    pub fn expert_curves(&self, task: &str) -> impl Iterator<Item = Vec<f64>> {
        self.experts_of(task).iter().map(SteRun::training_performance)
    }

    /// The range per task that was scaled to 1..=101; `None` without normalisation.
    pub fn normalization_data_range(&self) -> Option<&IndexMap<String, DataRange>> {
        self.normalization_data_range.as_ref()
    }

    /// Seconds between the first and the last time stamp of the rows that count.
    pub fn runtime_secs(&self) -> f64 {
        self.runtime_secs
    }

    /// Whether a regime counts for maintenance, transfer and average performance: all do, except wake evaluations in lifetimes with
    /// sleep blocks, because the agent is assessed by what it retains after sleeping.
    pub(crate) fn is_assessed(&self, regime: &Regime) -> bool {
        !(self.sleeps && regime.block_type == BlockType::Test && regime.block_subtype == BlockSubtype::Wake)
    }

    /// Experience numbers and performances of the task's wake learning regimes, concatenated.
    pub(crate) fn training_of(&self, task: &str) -> (Vec<u64>, Vec<f64>) {
        let trained = || self.regimes_of(task).filter(|regime| regime.is_wake_training());
        (
            trained().flat_map(|regime| regime.exp_nums.iter().copied()).collect(),
            trained()
                .flat_map(|regime| regime.performance.iter().copied())
                .collect(),
        )
    }

    /// The lifetime's own regimes, without the experts'.
    pub(crate) fn own_regimes_mut(&mut self) -> &mut [Regime] {
        &mut self.regimes
    }

    /// All regimes: the lifetime's own, then the experts'.
    pub(crate) fn all_regimes_mut(&mut self) -> impl Iterator<Item = &mut Regime> {
        let experts = self.experts.values_mut().flatten().flat_map(|run| &mut run.regimes);
        self.regimes.iter_mut().chain(experts)
    }

    /// Performances in a task: the lifetime's, then those of the task's experts in training.
    pub(crate) fn performances_of(&self, task: &str) -> impl Iterator<Item = f64> {
        let expert = self
            .experts_of(task)
            .iter()
            .flat_map(SteRun::training)
            .map(|(_, performance)| performance);
        self.regimes_of(task)
            .flat_map(|regime| regime.performance.iter().copied())
            .chain(expert)
    }
}
