//! What several lifetimes say together, and of two agents which is better. The statistics are the library's.

use std::collections::BTreeSet;

use crate::metrics::{BootstrapOptions, ComparedMetric, LifetimeMetrics, RepeatedMetric, compare_agents, over_repeats};
use serde::Serialize;
use serde_json::Value;

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

impl Together<'_> {
    /// All but the lifetimes themselves, which have files of their own.
    pub(super) fn without_lifetimes(&self) -> Result<Value, Failure> {
        let mut together = serde_json::to_value(self)?;
        if let Some(fields) = together.as_object_mut() {
            fields.retain(|name, _| !name.starts_with("lifetimes"));
        }
        Ok(together)
    }
}

/// Looks at lifetimes together; `others` are those of another agent, or none.
pub(super) fn together<'a>(
    lifetimes: &'a [LifetimeMetrics],
    others: &'a [LifetimeMetrics],
    intervals: &BootstrapOptions,
) -> Result<Together<'a>, Failure> {
    let improvement = compare_agents(lifetimes, others, intervals)?;
    if improvement.is_empty() && !others.is_empty() {
        let tasks = |lifetimes: &[LifetimeMetrics]| {
            let names = lifetimes
                .iter()
                .flat_map(|lifetime| lifetime.task_metrics.keys().cloned());
            names
                .collect::<BTreeSet<_>>()
                .into_iter()
                .take(5)
                .collect::<Vec<_>>()
                .join(", ")
        };
        let (mine, theirs) = (tasks(lifetimes), tasks(others));
        return Err(Failure::input(format!(
            "--against: found no task that both agents have, {mine} here and {theirs} there, expected the same tasks"
        )));
    }
    Ok(Together {
        intervals: *intervals,
        repeats: over_repeats(lifetimes, intervals)?,
        repeats_against: over_repeats(others, intervals)?,
        improvement,
        lifetimes,
        lifetimes_against: others,
    })
}
