//! [`Setup`]: the scoring options and experts of a request. If lifetimes are compared, they get a common scale: each task's range
//! over all of them.

use std::path::PathBuf;

use driftworld_metrics::{DataRanges, Lifetime, NormalizationMethod, Options, read_log};
use rayon::prelude::*;

use super::{Experts, ScoringRequest};
use crate::{Failure, log_folders};

/// Scoring options, with the logs to compare with.
pub(crate) struct Setup {
    pub(crate) logs: Vec<PathBuf>,
    pub(crate) options: Options,
    pub(crate) experts: Experts,
    /// The other agent's logs; empty without another agent.
    pub(crate) others: Vec<PathBuf>,
}

impl Setup {
    /// Prepares a request. If two agents are compared, or on request, all lifetimes have the same scale.
    pub(crate) fn new(logs: Vec<PathBuf>, request: &ScoringRequest) -> Result<Self, Failure> {
        let (settings, mut options) = (&request.settings, request.settings.options()?);
        let experts = Experts::new(&settings.experts, settings.expert_store.as_deref())?;
        let others = log_folders::below(&request.against)?;
        if request.intervals.common_ranges || !others.is_empty() {
            options = with_common_ranges(&[logs.as_slice(), &others].concat(), &experts, options);
        }
        Ok(Self {
            logs,
            options,
            experts,
            others,
        })
    }
}

/// Sets each task's range to its range over all these logs, so that levels of different lifetimes are comparable.
///
/// Unchanged if nothing is normalised, or ranges were given.
fn with_common_ranges(logs: &[PathBuf], experts: &Experts, mut options: Options) -> Options {
    if options.normalization_method == NormalizationMethod::Off || options.data_range.is_some() {
        return options;
    }
    let own = |log: &PathBuf| {
        let log = read_log(log).ok()?;
        let lifetime = Lifetime::prepare(&log, &experts.of(&log, &options).ok()?, &options).ok()?;
        lifetime.normalization_data_range().cloned()
    };
    // Logs that cannot be read or scored are reported during scoring.
    let own: Vec<_> = logs.par_iter().filter_map(own).collect();
    let mut common = DataRanges::new();
    for (task, range) in own.into_iter().flatten() {
        let known = common.entry(task).or_insert(range);
        (known.min, known.max) = (known.min.min(range.min), known.max.max(range.max));
    }
    options.data_range = Some(common);
    options
}

/// A warning that levels of lifetimes cannot be compared if each has its own scale.
pub(crate) fn own_scale(options: &Options) -> Option<String> {
    let is_own = options.normalization_method != NormalizationMethod::Off
        && options.data_range.is_none()
        && options.scales.is_none();
    is_own.then(|| {
        "Each lifetime is scaled by its own smallest and largest performance, so levels (avg_train_perf, \
         avg_eval_perf) cannot be compared between lifetimes. Use --common-ranges, --scales, -d or -n none for one scale."
            .to_owned()
    })
}
