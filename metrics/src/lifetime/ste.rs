//! Single-task experts: agents that were trained on one task alone, the yardstick of a lifetime.
//!
//! Not here: the comparison, see `score::ste_relative_performance` and `score::sample_efficiency`.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use indexmap::{IndexMap, IndexSet};

use super::regime::{self, Regime};
use super::{scored_name, usable_rows};
use crate::{BlockType, Log, MetricsError, Options, VariantMode};

/// The log of a single-task expert: exactly one task is trained in it. A clone shares the log.
#[derive(Debug, Clone, PartialEq)]
pub struct SteLog {
    log: Arc<Log>,
    task_name: String,
    /// Where it was read, for messages.
    dir: Option<PathBuf>,
}

impl SteLog {
    /// Takes a log as an expert's.
    ///
    /// # Errors
    /// [`MetricsError::NotSingleTask`] when it does not train exactly one task.
    pub fn new(log: Log) -> Result<Self, MetricsError> {
        let tasks = log.rows.task_names();
        let trained = log.rows.block_types().iter().zip(tasks.ids());
        let trained: IndexSet<u32> = trained
            .filter(|(block_type, _)| **block_type == BlockType::Train)
            .map(|(_, task)| *task)
            .collect();
        let mut names: IndexSet<String> = trained
            .into_iter()
            .map(|task| scored_name(&tasks.values()[task as usize], VariantMode::Aware))
            .collect();
        match (names.len(), names.pop()) {
            (1, Some(task_name)) => Ok(Self {
                log: Arc::new(log),
                task_name,
                dir: None,
            }),
            (_, None) => Err(MetricsError::NotSingleTask {
                run_id: log.run_id,
                found: "no trained task".to_owned(),
            }),
            (_, Some(last)) => {
                names.insert(last);
                let found = names.into_iter().collect::<Vec<_>>().join(", ");
                Err(MetricsError::NotSingleTask {
                    run_id: log.run_id,
                    found,
                })
            }
        }
    }

    /// Says where the log was read.
    pub(crate) fn read_from(mut self, dir: &Path) -> Self {
        self.dir = Some(dir.to_owned());
        self
    }

    /// What messages call the log: experts' logs often have one name, and lie in folders that tell them apart.
    fn place(&self) -> String {
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

/// One run of an expert, as regimes of its own.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SteRun {
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

/// Runs per task of the lifetime, in the order in which they were given.
pub(super) fn gather(
    experts: &[SteLog],
    tasks: &[String],
    options: &Options,
) -> Result<IndexMap<String, Vec<SteRun>>, MetricsError> {
    let mut runs: IndexMap<String, Vec<SteRun>> = IndexMap::new();
    for expert in experts {
        let task = scored_name(&expert.task_name, options.variant_mode);
        if !tasks.contains(&task) {
            tracing::warn!(
                run_id = expert.log.run_id,
                task,
                "expert log left aside: the lifetime has no such task"
            );
            continue;
        }
        let rows = usable_rows(&expert.log, &expert.place(), &options.perf_measure)?;
        let regimes = regime::form(&expert.place(), &rows, options)?;
        runs.entry(task).or_default().push(SteRun { regimes });
    }
    Ok(runs)
}
