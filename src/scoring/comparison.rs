//! [`Comparison`]: aggregates of several lifetimes, and comparisons of two agents.

use std::collections::BTreeSet;

use driftworld_metrics::{
    BootstrapOptions, ComparedMetric, LifetimeMetrics, MetricPower, RepeatedMetric, compare_agents, metric_power,
    over_repeats,
};
use serde::Serialize;

use crate::{Failure, argument};

/// Aggregates of several lifetimes.
#[derive(Clone, Debug, Serialize)]
#[non_exhaustive]
pub struct Comparison {
    /// How the intervals were computed.
    pub intervals: BootstrapOptions,
    /// Each metric over the lifetimes.
    pub repeats: Vec<RepeatedMetric>,
    /// Each metric over the other agent's lifetimes.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub repeats_against: Vec<RepeatedMetric>,
    /// For each metric, the probability that a lifetime is better than one of the other agent.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub improvement: Vec<ComparedMetric>,
    /// For each metric, what this number of lifetimes can show, if requested.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub power: Vec<MetricPower>,
}

impl Comparison {
    /// Aggregates lifetimes, and compares them with those of another agent, if any.
    pub(super) fn new(
        lifetimes: &[LifetimeMetrics],
        others: &[LifetimeMetrics],
        intervals: &BootstrapOptions,
        effect: Option<f64>,
    ) -> Result<Self, Failure> {
        let improvement = compare_agents(lifetimes, others, intervals)?;
        if improvement.is_empty() && !others.is_empty() {
            return Err(Failure::input(format!(
                "{}: found no task that both agents have, {} here and {} there, expected the same tasks",
                argument("against"),
                tasks(lifetimes),
                tasks(others)
            )));
        }
        Ok(Self {
            intervals: *intervals,
            repeats: over_repeats(lifetimes, intervals)?,
            repeats_against: over_repeats(others, intervals)?,
            improvement,
            power: effect.map_or_else(Vec::new, |effect| metric_power(lifetimes, others, effect)),
        })
    }
}

/// The names of the first few tasks of lifetimes.
fn tasks(lifetimes: &[LifetimeMetrics]) -> String {
    let names = lifetimes
        .iter()
        .flat_map(|lifetime| lifetime.task_metrics.keys().map(String::as_str));
    let names: BTreeSet<&str> = names.collect();
    names.into_iter().take(5).collect::<Vec<_>>().join(", ")
}
