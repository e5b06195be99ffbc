//! What lifetimes are scored by and compared with, and one scale where they are compared: each task's range over all of them. How
//! performances are scaled is the library's.

use std::path::PathBuf;

use crate::metrics::{DataRanges, Lifetime, NormalizationMethod, Options, read_log};
use rayon::prelude::*;

use super::Intervals;
use crate::commands::scoring::{Experts, Scoring};
use crate::commands::{Failure, log_folders};

/// What lifetimes are scored by, and the logs that they are compared with.
pub(crate) struct Yardstick {
    pub(crate) options: Options,
    pub(crate) experts: Experts,
    /// The other agent's; none where there is no other.
    pub(crate) others: Vec<PathBuf>,
}

impl Yardstick {
    /// As the arguments say; on one scale for all lifetimes where two agents are compared, or where it is asked for.
    pub(crate) fn new(
        logs: &[PathBuf],
        against: &[PathBuf],
        scoring: &Scoring,
        intervals: &Intervals,
    ) -> Result<Self, Failure> {
        let (mut options, experts) = (scoring.options()?, scoring.experts()?);
        let others = log_folders::below(against)?;
        if intervals.common_ranges || !others.is_empty() {
            options = with_common_ranges(&[logs, &others].concat(), &experts, options);
        }
        Ok(Self {
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
    // What cannot be read or scored is told when all are scored.
    let own: Vec<_> = logs.par_iter().filter_map(own).collect();
    let mut common = DataRanges::new();
    for (task, range) in own.into_iter().flatten() {
        let known = common.entry(task).or_insert(range);
        (known.min, known.max) = (known.min.min(range.min), known.max.max(range.max));
    }
    options.data_range = Some(common);
    options
}
