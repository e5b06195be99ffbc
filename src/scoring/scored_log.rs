//! [`ScoredLog`]: a log with its lifetime and scores; reads many in parallel.

use std::path::{Path, PathBuf};

use driftworld_metrics::{
    ExpStatus, Lifetime, LifetimeMetrics, Log, LogWarning, MetricsError, Options, Scorer, read_log,
};
use driftworld_spec::did_you_mean;
use rayon::prelude::*;

use super::Experts;
use super::scales_fit::unfit_scales;
use crate::{Failure, Warn, argument, log_folders};

/// One lifetime with all its data.
pub(crate) struct ScoredLog {
    pub(crate) log: Log,
    pub(crate) lifetime: Lifetime,
    pub(crate) metrics: LifetimeMetrics,
    /// Warnings about the log, which were already passed to `warn`.
    pub(crate) warnings: Vec<String>,
}

impl ScoredLog {
    /// Reads a log and scores it; `name` distinguishes it from others, by default its folder's name.
    pub(crate) fn read(
        folder: &Path,
        name: Option<&str>,
        experts: &Experts,
        options: &Options,
        warn: Warn<'_>,
    ) -> Result<Self, Failure> {
        let mut log = read_log(folder)?;
        if let Some(name) = name {
            name.clone_into(&mut log.run_id);
        }
        let mut warnings: Vec<String> = log.warnings.iter().map(ToString::to_string).collect();
        warnings.extend(missing_numbers(&log, &options.perf_measure));
        warnings.extend(experts.unused_warnings(&log, options));
        warnings.extend(unfit_scales(&log, options));
        let experts = experts.of(&log, options)?;
        warnings.extend(experts.iter().filter_map(|expert| missing_rows(expert.log())));
        for warning in &warnings {
            warn(log_folders::placed(folder, warning));
        }
        let lifetime = Lifetime::prepare(&log, &experts, options).map_err(without_column)?;
        let metrics = Scorer::default().judge(&log, &lifetime, options)?;
        Ok(Self {
            log,
            lifetime,
            metrics,
            warnings,
        })
    }
}

/// Adds the option's name and a similar column, if there is one, to the error for a missing column.
fn without_column(error: MetricsError) -> Failure {
    let MetricsError::UnknownColumn { column, available, .. } = &error else {
        return error.into();
    };
    let advice = did_you_mean(column, available.split(", "));
    Failure::because(format!("{}: {error}{advice}", argument("perf_measure")), error)
}

/// A warning about an expert's log that lacks rows.
fn missing_rows(log: &Log) -> Option<String> {
    let missing = |warning: &&LogWarning| matches!(warning, LogWarning::Missing { .. });
    log.warnings.iter().find(missing).map(ToString::to_string)
}

/// A warning that counts the complete rows without a number in the column.
fn missing_numbers(log: &Log, column: &str) -> Option<String> {
    let is_complete = |status: &ExpStatus| *status == ExpStatus::Complete;
    let complete = log
        .rows
        .exp_statuses()
        .iter()
        .filter(|status| is_complete(status))
        .count();
    let numbers = log.rows.exp_statuses().iter().zip(log.rows.metric(column)?);
    let missing = numbers
        .filter(|(status, number)| is_complete(status) && number.is_nan())
        .count();
    (missing > 0)
        .then(|| format!("{missing} of {complete} complete rows have no number in column {column} and are ignored"))
}

/// Reads and scores many logs and keeps the result of `keep` for each. The failure names every log that cannot be scored, with
/// the first error as its cause.
pub(super) fn each_log<T: Send>(
    logs: &[PathBuf],
    experts: &Experts,
    options: &Options,
    warn: Warn<'_>,
    keep: impl Fn(ScoredLog) -> Result<T, Failure> + Sync,
) -> Result<Vec<T>, Failure> {
    let names = log_folders::names(logs);
    let read = |(log, name): (&PathBuf, &String)| {
        let name = (logs.len() > 1).then_some(name.as_str());
        ScoredLog::read(log, name, experts, options, warn)
            .and_then(&keep)
            .map_err(|failure| failure.at(log))
    };
    let kept: Vec<_> = logs.par_iter().zip(&names).map(read).collect();
    let failures: Vec<&Failure> = kept.iter().filter_map(|kept| kept.as_ref().err()).collect();
    if failures.is_empty() {
        return kept.into_iter().collect();
    }
    Err(Failure::of_several(&failures))
}

/// The scores of many logs.
pub(crate) fn score_logs(
    logs: &[PathBuf],
    experts: &Experts,
    options: &Options,
    warn: Warn<'_>,
) -> Result<Vec<LifetimeMetrics>, Failure> {
    each_log(logs, experts, options, warn, |log| Ok(log.metrics))
}
