//! [`Setup`]: what lifetimes are scored by and compared with, and one scale where they are compared: each task's range over
//! all of them. How performances are scaled is `metrics`'.

use std::path::PathBuf;

use driftworld_metrics::{DataRanges, Lifetime, NormalizationMethod, Options, read_log};
use rayon::prelude::*;

use super::{Experts, ScoringRequest};
use crate::{Failure, log_folders};

/// What lifetimes are scored by, and the logs that they are compared with.
pub(crate) struct Setup {
    pub(crate) logs: Vec<PathBuf>,
    pub(crate) options: Options,
    pub(crate) experts: Experts,
    /// The other agent's; none where there is no other.
    pub(crate) others: Vec<PathBuf>,
}

impl Setup {
    /// As the request says; on one scale for all lifetimes where two agents are compared, or where it is asked for.
    pub(crate) fn new(logs: Vec<PathBuf>, request: &ScoringRequest) -> Result<Self, Failure> {
        let (mut options, choice) = (request.settings.options()?, &request.settings.choice);
        let experts = Experts::new(&choice.experts, choice.expert_store.as_deref())?;
        let others = log_folders::below(&request.against)?;
        if request.common_ranges || !others.is_empty() {
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

/// The options with each task's range over all these logs, so that levels of different lifetimes can be compared.
///
/// Where nothing is normalised, or ranges were given, they are as they were.
fn with_common_ranges(logs: &[PathBuf], experts: &Experts, mut options: Options) -> Options {
    if options.normalization_method == NormalizationMethod::Off || options.data_range.is_some() {
        return options;
    }
    let own = |log: &PathBuf| {
        let log = read_log(log).ok()?;
        let lifetime = Lifetime::prepare(&log, &experts.of(&log, &options).ok()?, &options).ok()?;
        lifetime.normalization_data_range().cloned()
    };
    // What cannot be read or scored is reported when all are scored.
    let own: Vec<_> = logs.par_iter().filter_map(own).collect();
    let mut common = DataRanges::new();
    for (task, range) in own.into_iter().flatten() {
        let known = common.entry(task).or_insert(range);
        (known.min, known.max) = (known.min.min(range.min), known.max.max(range.max));
    }
    options.data_range = Some(common);
    options
}

/// What must be known before levels of different lifetimes are compared, where each has a scale of its own.
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
