//! Logs to lifetimes that are scored, many at once. What a score is, is the library's.

use std::path::{Path, PathBuf};

use driftworld::metrics::{LifetimeMetrics, Options, read_log, score};
use rayon::prelude::*;

use crate::commands::scoring::Experts;
use crate::commands::{Failure, output};

/// Reads a log, with its warnings to standard error, and scores it.
pub(crate) fn score_log(dir: &Path, experts: &Experts, options: &Options) -> Result<LifetimeMetrics, Failure> {
    let log = read_log(dir)?;
    for warning in &log.warnings {
        output::note(format!("warning: {}: {warning}", dir.display()));
    }
    Ok(score(&log, &experts.of(&log, options)?, options)?)
}

/// The same for many logs; where several cannot be scored, every one is told.
pub(crate) fn score_logs(
    logs: &[PathBuf],
    experts: &Experts,
    options: &Options,
) -> Result<Vec<LifetimeMetrics>, Failure> {
    let scored: Vec<_> = logs.par_iter().map(|log| score_log(log, experts, options)).collect();
    let failures: Vec<&str> = scored
        .iter()
        .filter_map(|found| Some(found.as_ref().err()?.text()))
        .collect();
    if failures.is_empty() {
        return scored.into_iter().collect();
    }
    Err(Failure::input(failures.join("\n")))
}
