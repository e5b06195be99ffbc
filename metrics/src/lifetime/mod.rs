//! A lifetime as the metrics see it: its tasks, its regimes in order, and the single-task experts it is compared with.
//!
//! Not here: reading files (`log`), changing the numbers (`preprocess`), and judging them (`score`).

mod regime;
mod ste;

use indexmap::{IndexMap, IndexSet};

pub(crate) use regime::mean_per_experience;
pub use regime::{MAX_REGIMES, Regime};
pub(crate) use ste::SteRun;
pub use ste::{SteLog, experts_serving};

use crate::log::{TaskParams, Timestamp};
use crate::preprocess;
use crate::{BlockSubtype, BlockType, DataRange, ExpStatus, Log, MetricsError, Options, Rows, VariantMode};

/// Performances must stay below this magnitude, so that no sum or quotient of them overflows.
pub(crate) const MAX_PERFORMANCE: f64 = 1e100;

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
    /// Takes the complete rows that have a number in the performance column, forms regimes, and preprocesses them:
    /// smoothing, clamping, normalisation, in that order. Which experts a task is compared with, [`experts_serving`] says; others
    /// are left aside. Several logs of one task are several runs of its expert.
    ///
    /// # Errors
    /// [`MetricsError::UnknownColumn`], [`MetricsError::NoUsableRows`], [`MetricsError::TooManyRegimes`],
    /// [`MetricsError::PerformanceOutOfRange`], [`MetricsError::BadOption`].
    pub fn prepare(log: &Log, experts: &[SteLog], options: &Options) -> Result<Self, MetricsError> {
        options.check()?;
        let rows = usable_rows(log, &log.run_id, &options.perf_measure)?;
        let regimes = regime::form(&log.run_id, &rows, options)?;
        let tasks = tasks_by_training(&regimes);
        let experts = ste::gather(experts, &tasks, options)?;
        let stamps = || rows.indices.iter().map(|&row| log.rows.timestamps()[row]);
        let mut lifetime = Self {
            run_id: log.run_id.clone(),
            tasks,
            sleeps: regimes.iter().any(|regime| regime.block_subtype == BlockSubtype::Sleep),
            regimes,
            experts,
            normalization_data_range: None,
            runtime_secs: span_secs(stamps().min(), stamps().max()),
        };
        lifetime.check_bounds("as logged")?;
        preprocess::smooth(&mut lifetime, options);
        preprocess::clamp(&mut lifetime, options)?;
        lifetime.normalization_data_range = preprocess::normalize(&mut lifetime, options)?;
        preprocess::disturb(&mut lifetime, options);
        lifetime.check_bounds("after preprocessing")?;
        Ok(lifetime)
    }

    /// Name of the log.
    pub fn run_id(&self) -> &str {
        &self.run_id
    }

    /// All tasks, lower-case: by first learning block, then those never trained by first evaluation block.
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

    /// The runs of a task's single-task expert.
    pub(crate) fn experts_of(&self, task: &str) -> &[SteRun] {
        self.experts.get(task).map_or(&[], Vec::as_slice)
    }

    /// The learning of a task's single-task expert after preprocessing, a list per run, in the order of the runs given.
    pub fn expert_curves(&self, task: &str) -> impl Iterator<Item = Vec<f64>> {
        self.experts_of(task).iter().map(SteRun::training_performance)
    }

    /// Range per task that was scaled to 1..=101; `None` where nothing was normalised.
    pub fn normalization_data_range(&self) -> Option<&IndexMap<String, DataRange>> {
        self.normalization_data_range.as_ref()
    }

    /// Seconds between the first and the last time stamp of the rows in use.
    pub fn runtime_secs(&self) -> f64 {
        self.runtime_secs
    }

    /// Whether a regime counts for maintenance, transfer and average performance: all do, but where the lifetime has
    /// sleep blocks the wake evaluations are left out, since the agent is judged by what it keeps after sleeping.
    pub(crate) fn is_assessed(&self, regime: &Regime) -> bool {
        !(self.sleeps && regime.block_type == BlockType::Test && regime.block_subtype == BlockSubtype::Wake)
    }

    /// Performances and exp numbers of the task's wake learning regimes, end to end.
    pub(crate) fn training_of(&self, task: &str) -> (Vec<u64>, Vec<f64>) {
        let trained = || self.regimes_of(task).filter(|regime| regime.is_wake_training());
        (
            trained().flat_map(|regime| regime.exp_nums.iter().copied()).collect(),
            trained()
                .flat_map(|regime| regime.performance.iter().copied())
                .collect(),
        )
    }

    /// The lifetime's own regimes.
    pub(crate) fn own_regimes_mut(&mut self) -> &mut [Regime] {
        &mut self.regimes
    }

    /// All regimes that hold performances: the lifetime's, then the experts'.
    pub(crate) fn all_regimes_mut(&mut self) -> impl Iterator<Item = &mut Regime> {
        let experts = self.experts.values_mut().flatten().flat_map(|run| &mut run.regimes);
        self.regimes.iter_mut().chain(experts)
    }

    /// Performances of a task in the lifetime, and those of its experts' training.
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

    fn check_bounds(&mut self, after: &'static str) -> Result<(), MetricsError> {
        let run_id = self.run_id.clone();
        for regime in self.all_regimes_mut() {
            let bounded = |value: f64| value.abs() < MAX_PERFORMANCE;
            if let Some(&found) = regime.performance.iter().find(|value| !bounded(**value)) {
                let task = regime.task_name.clone();
                return Err(MetricsError::PerformanceOutOfRange {
                    run_id,
                    task,
                    found,
                    after,
                });
            }
        }
        Ok(())
    }
}

/// Parameter of a task by which a row says which part of the life it belongs to, and the part that is not scored.
const PHASE: (&str, &str) = ("phase", "pre_deployment");

/// The rows of a log that count, and the column of their performance.
pub(crate) struct Usable<'a> {
    pub(crate) rows: &'a Rows,
    /// Which rows count, in order.
    pub(crate) indices: Vec<usize>,
    /// Performance of every row of the log.
    pub(crate) performance: &'a [f64],
}

/// The rows that count: complete, with a number in the performance column, and not of the time before deployment, which prepares
/// a lifetime and is no part of it. Rows of that time have the task parameter `phase`, `pre_deployment`. Messages call the log `name`.
pub(crate) fn usable_rows<'a>(log: &'a Log, name: &str, column: &str) -> Result<Usable<'a>, MetricsError> {
    let mut usable = complete_rows(log, name, column)?;
    let performance = usable.performance;
    usable.indices.retain(|&row| !performance[row].is_nan());
    Ok(usable)
}

/// The same with complete rows that have no number; at least one has a number.
pub(crate) fn complete_rows<'a>(log: &'a Log, name: &str, column: &str) -> Result<Usable<'a>, MetricsError> {
    let declared = log.logger_info.metrics_columns();
    let performance = (declared.iter().any(|name| name == column))
        .then(|| log.rows.metric(column))
        .flatten()
        .ok_or_else(|| MetricsError::UnknownColumn {
            run_id: name.to_owned(),
            column: column.to_owned(),
            available: declared.join(", "),
        })?;
    let rows = &log.rows;
    let params = rows.task_params();
    let is_deployed = |params: &TaskParams| params.get(PHASE.0).is_none_or(|phase| phase != PHASE.1);
    let deployed: Vec<bool> = params.values().iter().map(is_deployed).collect();
    let counts = |&row: &usize| rows.exp_statuses()[row] == ExpStatus::Complete && deployed[params.ids()[row] as usize];
    let indices: Vec<usize> = (0..rows.len()).filter(counts).collect();
    if indices.iter().all(|&row| performance[row].is_nan()) {
        return Err(MetricsError::NoUsableRows {
            run_id: name.to_owned(),
            column: column.to_owned(),
        });
    }
    Ok(Usable {
        rows,
        indices,
        performance,
    })
}

/// The name under which a task is scored: lower-case, and without its variant where variants do not count.
pub(crate) fn scored_name(task_name: &str, mode: VariantMode) -> String {
    let mut name = task_name.to_lowercase();
    if mode == VariantMode::Agnostic {
        name.truncate(name.find('_').unwrap_or(name.len()));
    }
    name
}

fn tasks_by_training(regimes: &[Regime]) -> Vec<String> {
    let mut ordered: Vec<&Regime> = regimes.iter().collect();
    ordered.sort_by_key(|regime| (regime.block_type, regime.block_num));
    ordered
        .into_iter()
        .map(|regime| regime.task_name.clone())
        .collect::<IndexSet<_>>()
        .into_iter()
        .collect()
}

fn span_secs(first: Option<Timestamp>, last: Option<Timestamp>) -> f64 {
    first.zip(last).map_or(0.0, |(first, last)| last.seconds_since(first))
}
