//! Single-task experts: agents trained on one task alone, with which a lifetime is compared.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use indexmap::{IndexMap, IndexSet};

use super::budget::Budget;
use super::regime::{self, Regime};
use super::usable::{complete_rows, is_deployed};
use crate::log::{Log, read_log};
use crate::{BlockType, MetricsError, Options, VariantMode};

/// The log of a single-task expert, which trains exactly one task, apart from training before deployment. Clones share the log.
#[derive(Debug, Clone, PartialEq)]
pub struct SteLog {
    log: Arc<Log>,
    task_name: String,
    /// The folder that it was read from, for messages.
    dir: Option<PathBuf>,
}

impl SteLog {
    /// Wraps the log of an expert.
    ///
    /// # Errors
    /// [`MetricsError::NotSingleTask`] unless it trains exactly one task.
    pub fn new(log: Log) -> Result<Self, MetricsError> {
        let tasks = log.rows.task_names();
        let params = log.rows.task_params();
        let deployed: Vec<bool> = params.values().iter().map(is_deployed).collect();
        let trained = log.rows.block_types().iter().zip(params.ids()).zip(tasks.ids());
        let trained: IndexSet<u32> = trained
            .filter(|((block_type, params), _)| **block_type == BlockType::Train && deployed[**params as usize])
            .map(|(_, task)| *task)
            .collect();
        let names: IndexSet<String> = trained
            .into_iter()
            .map(|task| VariantMode::Aware.scored_name(&tasks.values()[task as usize]))
            .collect();
        let names: Vec<String> = names.into_iter().collect();
        let found = match names.as_slice() {
            [task_name] => {
                let (log, task_name, dir) = (Arc::new(log), task_name.clone(), None);
                return Ok(Self { log, task_name, dir });
            }
            [] => "no trained task".to_owned(),
            names => names.join(", "),
        };
        let run_id = log.run_id;
        Err(MetricsError::NotSingleTask { run_id, found })
    }

    /// The log's name in messages: its folder if known, because experts' logs often share a name.
    fn shown_name(&self) -> String {
        (self.dir.as_ref()).map_or_else(|| self.log.run_id.clone(), |dir| dir.display().to_string())
    }

    /// The trained task, lower-case, with its variant.
    pub fn task_name(&self) -> &str {
        &self.task_name
    }

    /// The log itself.
    pub fn log(&self) -> &Log {
        &self.log
    }
}

/// Reads the log of a single-task expert, for `ste_rel_perf` and `sample_efficiency`.
///
/// # Errors
/// Those of [`read_log`], and [`MetricsError::NotSingleTask`] unless it trains exactly one task.
pub fn read_ste_log(dir: impl AsRef<Path>) -> Result<SteLog, MetricsError> {
    let dir = dir.as_ref();
    let expert = SteLog::new(read_log(dir)?)?;
    Ok(SteLog {
        dir: Some(dir.to_owned()),
        ..expert
    })
}

/// One run of an expert, with its own regimes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SteRun {
    /// The log's name in messages.
    pub(crate) name: String,
    /// The agent, as logged.
    pub(crate) agent: Option<String>,
    /// Its training budget.
    pub(crate) budget: Budget,
    pub(crate) regimes: Vec<Regime>,
}

impl SteRun {
    /// Experience number and performance of each training row.
    pub(crate) fn training(&self) -> impl Iterator<Item = (u64, f64)> {
        let trained = self
            .regimes
            .iter()
            .filter(|regime| regime.block_type == BlockType::Train);
        trained.flat_map(|regime| regime.exp_nums.iter().copied().zip(regime.performance.iter().copied()))
    }

    /// Performance of each training row.
    pub(crate) fn training_performance(&self) -> Vec<f64> {
        self.training().map(|(_, performance)| performance).collect()
    }
}

/// The experts that a task is compared with, as indices into `trained`, the tasks of the experts with their variants.
///
/// Experts of the task itself are used; if there are none, experts of its variants: `ferry_red` and `ferry_blue` serve `ferry`.
/// This applies to a task that was logged without a variant, and to one that lost it because variants do not count. A variant is
/// served only by its own experts. Names are compared in lower case.
///
/// QUIRK: the reference finds files of variants by the prefix of their names, so an expert of `ferryman_red` also serves `ferry`
/// if an expert of one of `ferry`'s variants does. That is not reproduced.
///
/// ```
/// use driftworld_metrics::experts_serving;
///
/// assert_eq!(experts_serving("ferry", &["ferry_red", "dock_old", "ferry_blue"]), [0, 2]);
/// assert_eq!(experts_serving("ferry", &["ferry_red", "ferry"]), [1]);
/// assert_eq!(experts_serving("ferry_red", &["ferry", "ferry_blue"]), [] as [usize; 0]);
/// ```
pub fn experts_serving(task: &str, trained: &[&str]) -> Vec<usize> {
    let task = task.to_lowercase();
    let indices_in_mode = |mode| {
        let is_named = |name: &&str| VariantMode::scored_name(mode, name) == task;
        (0..)
            .zip(trained)
            .filter(|(_, name)| is_named(name))
            .map(|(index, _)| index)
            .collect::<Vec<usize>>()
    };
    let own = indices_in_mode(VariantMode::Aware);
    if own.is_empty() {
        indices_in_mode(VariantMode::Agnostic)
    } else {
        own
    }
}

/// Expert runs per task of the lifetime, in the given order.
pub(super) fn gather(
    experts: &[SteLog],
    tasks: &[String],
    options: &Options,
) -> Result<IndexMap<String, Vec<SteRun>>, MetricsError> {
    let trained: Vec<&str> = experts.iter().map(SteLog::task_name).collect();
    let mut runs: IndexMap<String, Vec<SteRun>> = IndexMap::new();
    let mut used = vec![false; experts.len()];
    for task in tasks {
        for index in experts_serving(task, &trained) {
            used[index] = true;
            let run = run_of(&experts[index], task, options)?;
            runs.entry(task.clone()).or_default().push(run);
        }
    }
    for (expert, _) in experts.iter().zip(used).filter(|(_, used)| !used) {
        tracing::warn!(
            run_id = expert.log.run_id,
            task = expert.task_name,
            "expert log ignored: the lifetime has no such task"
        );
    }
    Ok(runs)
}

/// Forms an expert's regimes under the name of the task that it serves.
///
/// Variants are kept apart. As in the reference, which does this when it stores an expert, regimes are formed before rows without
/// a number are dropped: a stretch of such rows still separates its neighbours, which are smoothed independently.
fn run_of(expert: &SteLog, task: &str, options: &Options) -> Result<SteRun, MetricsError> {
    let rows = complete_rows(&expert.log, &expert.shown_name(), &options.perf_measure)?;
    let with_variants = Options {
        variant_mode: VariantMode::Aware,
        ..options.clone()
    };
    let mut regimes = regime::form(&expert.shown_name(), &rows, &with_variants)?;
    for regime in &mut regimes {
        regime.keep_numbers();
        if regime.task_name == expert.task_name {
            task.clone_into(&mut regime.task_name);
        }
    }
    regimes.retain(|regime| !regime.is_empty());
    Ok(SteRun {
        name: expert.log.run_id.clone(),
        agent: expert.log.scenario_info.agent(),
        budget: Budget::of_expert(&expert.log),
        regimes,
    })
}
