//! What several lifetimes say together, and of two agents which is better. The statistics are the library's.

use driftworld::metrics::{
    BootstrapOptions, ComparedMetric, LifetimeMetrics, RepeatedMetric, compare_agents, over_repeats,
};
use serde::Serialize;

use crate::commands::Failure;

/// The result as JSON has it.
#[derive(Serialize)]
pub(super) struct Together<'a> {
    /// How the intervals were made.
    pub(super) intervals: BootstrapOptions,
    /// Each metric over the lifetimes.
    pub(super) repeats: Vec<RepeatedMetric>,
    /// Each metric over the other agent's lifetimes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) repeats_against: Vec<RepeatedMetric>,
    /// Each metric, how probably a lifetime is better than one of the other agent.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(super) improvement: Vec<ComparedMetric>,
    /// The lifetimes, each by itself.
    pub(super) lifetimes: &'a [LifetimeMetrics],
    /// Those of the other agent.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    pub(super) lifetimes_against: &'a [LifetimeMetrics],
}

/// Looks at lifetimes together; `others` are those of another agent, or none.
pub(super) fn together<'a>(
    lifetimes: &'a [LifetimeMetrics],
    others: &'a [LifetimeMetrics],
    intervals: &BootstrapOptions,
) -> Result<Together<'a>, Failure> {
    Ok(Together {
        intervals: *intervals,
        repeats: over_repeats(lifetimes, intervals)?,
        repeats_against: over_repeats(others, intervals)?,
        improvement: compare_agents(lifetimes, others, intervals)?,
        lifetimes,
        lifetimes_against: others,
    })
}
