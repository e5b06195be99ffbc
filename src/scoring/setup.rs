//! [`Setup`]: the scoring options and experts of a request. If lifetimes are compared, they get a common scale: each task's range
//! over all of them.

use std::collections::BTreeSet;
use std::path::PathBuf;

use driftworld_metrics::{DataRanges, Lifetime, NormalizationMethod, Options, read_log};
use driftworld_text::one_line;
use rayon::prelude::*;

use super::{Experts, ScoringRequest};
use crate::{Failure, Warn, log_folders};

/// Scoring options, with the logs to compare with.
pub(crate) struct Setup {
    pub(crate) logs: Vec<PathBuf>,
    pub(crate) options: Options,
    pub(crate) experts: Experts,
    /// The other agent's logs; empty without another agent.
    pub(crate) others: Vec<PathBuf>,
}

impl Setup {
    /// Prepares a request. If two agents are compared, or on request, all lifetimes have the same scale. `warn` receives a warning
    /// for each side of a comparison that has logs of several agents.
    pub(crate) fn new(logs: Vec<PathBuf>, request: &ScoringRequest, warn: Warn<'_>) -> Result<Self, Failure> {
        let (settings, mut options) = (&request.settings, request.settings.options()?);
        let experts = Experts::new(&settings.experts, settings.expert_store.as_deref())?;
        let others = log_folders::below(&request.against)?;
        let both = [logs.as_slice(), &others].concat();
        if log_folders::without_duplicates(both.clone()).len() < both.len() {
            return Err(Failure::in_argument(
                "against",
                "found a log of the first agent, expected logs of another agent",
            ));
        }
        if request.intervals.common_ranges || !others.is_empty() {
            options = with_common_ranges(&both, &experts, options);
        }
        let sides = [("the first agent's logs", &logs), ("the second agent's logs", &others)];
        for (side, logs) in sides.into_iter().filter(|_| !others.is_empty()) {
            several_agents(side, logs).into_iter().for_each(warn);
        }
        Ok(Self {
            logs,
            options,
            experts,
            others,
        })
    }
}

/// A warning if these lifetimes, which are scored as one agent's, belong to several agents.
fn several_agents(side: &str, logs: &[PathBuf]) -> Option<String> {
    let agent = |log: &PathBuf| Some(log_folders::scenario_info(log).get("agent")?.as_str()?.to_owned());
    let agents: BTreeSet<String> = logs.iter().filter_map(agent).collect();
    (agents.len() > 1).then(|| {
        let names = agents.into_iter().collect::<Vec<_>>().join(", ");
        format!(
            "{side}: found several agents, {}; they are scored as one",
            one_line(names)
        )
    })
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
