//! Prepares a lifetime from a log: forms regimes from its rows and preprocesses them.

use indexmap::IndexSet;

use super::usable::usable_rows;
use super::{Lifetime, Regime, SteLog, drift, regime, ste};
use crate::log::Log;
use crate::options::is_bounded;
use crate::preprocess;
use crate::{BlockSubtype, MetricsError, Options};

impl Lifetime {
    /// Takes the complete rows that have a number in the performance column, forms regimes, and preprocesses them by smoothing,
    /// clamping, normalisation and noise, in that order. [`experts_serving`](crate::experts_serving) decides which experts a task
    /// is compared with; others are ignored. Several logs of one task count as several runs of its expert.
    ///
    /// # Errors
    /// [`MetricsError::UnknownColumn`] if the log does not declare the performance column; [`MetricsError::NoUsableRows`] if no row
    /// counts; [`MetricsError::TooManyRegimes`]; [`MetricsError::PerformanceOutOfRange`] for performances so large that sums would
    /// overflow; [`MetricsError::BadOption`] for an invalid option.
    pub fn prepare(log: &Log, experts: &[SteLog], options: &Options) -> Result<Self, MetricsError> {
        options.check()?;
        let rows = usable_rows(log, &log.run_id, &options.perf_measure)?;
        let mut regimes = regime::form(&log.run_id, &rows, options)?;
        let tasks = tasks_by_training(&regimes);
        drift::set_learned(&mut regimes, &tasks);
        let experts = ste::gather(experts, &tasks, options)?;
        let stamps = || rows.indices.iter().map(|&row| log.rows.timestamps()[row]);
        let mut lifetime = Self {
            run_id: log.run_id.clone(),
            tasks,
            sleeps: regimes.iter().any(|regime| regime.block_subtype == BlockSubtype::Sleep),
            regimes,
            experts,
            normalization_data_range: None,
            runtime_secs: (stamps().min().zip(stamps().max())).map_or(0.0, |(first, last)| last.seconds_since(first)),
        };
        lifetime.check_bounds("as logged")?;
        preprocess::smooth(&mut lifetime, options);
        preprocess::clamp(&mut lifetime, options)?;
        lifetime.normalization_data_range = preprocess::normalize(&mut lifetime, options)?;
        preprocess::disturb(&mut lifetime, options);
        lifetime.check_bounds("after preprocessing")?;
        Ok(lifetime)
    }

    fn check_bounds(&mut self, after: &'static str) -> Result<(), MetricsError> {
        let run_id = self.run_id.clone();
        for regime in self.all_regimes_mut() {
            if let Some(&found) = regime.performance.iter().find(|value| !is_bounded(**value)) {
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
