//! A log, the lifetime in it, and its scores; many at once. What a score is, is the library's.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::metrics::{ExpStatus, Lifetime, LifetimeMetrics, Log, MetricsError, Options, Scorer, read_log};
use crate::spec::nearest;
use driftworld_text::ShownPath;
use rayon::prelude::*;

use crate::commands::scoring::Experts;
use crate::commands::{Failure, log_folders, output};

/// One lifetime with everything that is known of it.
pub(crate) struct Lived {
    pub(crate) log: Log,
    pub(crate) lifetime: Lifetime,
    pub(crate) metrics: LifetimeMetrics,
    /// Told on standard error already.
    pub(crate) warnings: Vec<String>,
}

impl Lived {
    /// Reads a log, with its warnings to standard error, and scores it; `name` tells it from others, by default its folder's.
    pub(crate) fn read(
        folder: &Path,
        name: Option<&str>,
        experts: &Experts,
        options: &Options,
    ) -> Result<Self, Failure> {
        let mut log = read_log(folder)?;
        if let Some(name) = name {
            name.clone_into(&mut log.run_id);
        }
        let mut warnings: Vec<String> = log.warnings.iter().map(ToString::to_string).collect();
        warnings.extend(missing_numbers(&log, &options.perf_measure));
        warnings.extend(experts.left_aside(&log, options));
        for warning in &warnings {
            output::note(format!("warning: {}: {warning}", folder.shown()));
        }
        let lifetime = Lifetime::prepare(&log, &experts.of(&log, options)?, options).map_err(without_column)?;
        let metrics = Scorer::default().judge(&log, &lifetime, options)?;
        Ok(Self {
            log,
            lifetime,
            metrics,
            warnings,
        })
    }
}

/// A failure in the command's words: a column that is not there was asked for, or is what is asked for by default.
fn without_column(error: MetricsError) -> Failure {
    let MetricsError::UnknownColumn { column, available, .. } = &error else {
        return error.into();
    };
    let near = nearest(column, available.split(", "));
    let advice = near.map_or_else(String::new, |near| format!("; did you mean {near:?}?"));
    Failure::Input(format!("--perf-measure: {error}{advice}"), Some(Arc::new(error)))
}

/// Says how many rows are passed over because they have no number.
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
        .then(|| format!("{missing} of {complete} complete rows have no number in column {column} and are left out"))
}

/// Reads and scores many logs and keeps of each what `keep` makes of it; where several cannot be scored, every one is told, and the first is the
/// cause.
pub(crate) fn each_lived<T: Send>(
    logs: &[PathBuf],
    experts: &Experts,
    options: &Options,
    keep: impl Fn(Lived) -> Result<T, Failure> + Sync,
) -> Result<Vec<T>, Failure> {
    let names = log_folders::names(logs);
    let read = |(log, name): (&PathBuf, &String)| {
        let name = (logs.len() > 1).then_some(name.as_str());
        keep(Lived::read(log, name, experts, options)?)
    };
    let kept: Vec<_> = logs.par_iter().zip(&names).map(read).collect();
    let failures: Vec<&Failure> = kept.iter().filter_map(|kept| kept.as_ref().err()).collect();
    let Some(first) = failures.first() else {
        return kept.into_iter().collect();
    };
    let texts: Vec<&str> = failures.iter().map(|failure| failure.text()).collect();
    Err(Failure::Input(texts.join("\n"), first.cause()))
}

/// The scores of many logs.
pub(crate) fn score_logs(
    logs: &[PathBuf],
    experts: &Experts,
    options: &Options,
) -> Result<Vec<LifetimeMetrics>, Failure> {
    each_lived(logs, experts, options, |lived| Ok(lived.metrics))
}
