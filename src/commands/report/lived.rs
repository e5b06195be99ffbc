//! A log, the lifetime in it, and its scores: a report wants to look at all three.

use std::path::Path;

use driftworld::metrics::{Lifetime, LifetimeMetrics, Log, Options, Scorer, read_log};

use crate::commands::scoring::Experts;
use crate::commands::{Failure, output};

/// One lifetime with everything that is known of it.
pub(super) struct Lived {
    pub(super) log: Log,
    pub(super) lifetime: Lifetime,
    pub(super) metrics: LifetimeMetrics,
    /// Told on standard error already.
    pub(super) warnings: Vec<String>,
}

impl Lived {
    /// Reads a log, with its warnings to standard error, and scores it.
    pub(super) fn read(folder: &Path, experts: &Experts, options: &Options) -> Result<Self, Failure> {
        let log = read_log(folder)?;
        let warnings: Vec<String> = log.warnings.iter().map(ToString::to_string).collect();
        for warning in &warnings {
            output::note(format!("warning: {}: {warning}", folder.display()));
        }
        let lifetime = Lifetime::prepare(&log, &experts.of(&log, options)?, options)?;
        let metrics = Scorer::default().judge(&log, &lifetime, options)?;
        Ok(Self {
            log,
            lifetime,
            metrics,
            warnings,
        })
    }
}
