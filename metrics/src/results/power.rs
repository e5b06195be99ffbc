//! Statistical power of comparing two agents by each metric, from the variation of their lifetimes.

use serde::Serialize;

use super::repeats::headlines;
use super::{Headline, LifetimeMetrics};
use crate::repeats::{lifetimes_for, smallest_effect, welch_power};
use crate::statistics::variance;

/// The power to show a difference in one metric, by a two-sided Welch's t test at 5 %.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MetricPower {
    /// The metric.
    #[serde(flatten)]
    pub headline: Headline,
    /// Standard deviation of the metric between the lifetimes of each agent, in its own unit; the same twice if only
    /// one agent is given.
    pub deviations: [f64; 2],
    /// Lifetimes of each agent that have a value.
    pub lifetimes: [usize; 2],
    /// The difference between means that is to be shown, in the metric's unit.
    pub effect: f64,
    /// The chance that the given lifetimes show that difference, 0..=1; `None` if the lifetimes do not vary: then no test is
    /// possible, and the next two fields are `None` as well.
    pub power: Option<f64>,
    /// Lifetimes per agent that show it with a chance of 80 %; `None` for more than 100,000.
    pub lifetimes_needed: Option<usize>,
    /// The smallest difference that the given lifetimes show with a chance of 80 %.
    pub smallest_effect: Option<f64>,
}

/// The power for every metric with values in at least two lifetimes of each agent. If `others` is empty, the other agent is
/// assumed to have the same variation and the same number of lifetimes.
pub fn metric_power(lifetimes: &[LifetimeMetrics], others: &[LifetimeMetrics], effect: f64) -> Vec<MetricPower> {
    let others = if others.is_empty() { lifetimes } else { others };
    let of_headline = |headline: Headline| {
        let values = [lifetimes, others].map(|agent| {
            let numbers = agent.iter().filter_map(|life| life.number(&headline.name));
            numbers.collect::<Vec<f64>>()
        });
        let [a, b] = [variance(&values[0])?.sqrt(), variance(&values[1])?.sqrt()];
        let (nums, deviations) = ([values[0].len(), values[1].len()], [a, b]);
        Some(MetricPower {
            deviations,
            lifetimes: nums,
            effect,
            power: welch_power(nums, deviations, effect),
            lifetimes_needed: lifetimes_for(deviations, effect),
            smallest_effect: smallest_effect(nums, deviations),
            headline,
        })
    };
    headlines(lifetimes).into_iter().filter_map(of_headline).collect()
}
