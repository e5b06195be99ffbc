//! The power of comparing two agents by each metric, from how much their lifetimes vary.
//!
//! Not here: how power is computed, see `crate::repeats`.

use serde::Serialize;

use super::repeats::headlines;
use super::{Headline, LifetimeMetrics};
use crate::repeats::{lifetimes_for, smallest_effect, welch_power};
use crate::statistics::variance;

/// What lifetimes can show of one metric, by Welch's t test of two sides at 5 %.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MetricPower {
    /// Which metric.
    #[serde(flatten)]
    pub headline: Headline,
    /// Standard deviation of the metric between the lifetimes of each agent, in its own unit; of one agent alone, twice
    /// its own.
    pub deviations: [f64; 2],
    /// Lifetimes of each agent that have a value.
    pub lifetimes: [usize; 2],
    /// The difference of means that is asked about, in the metric's unit.
    pub effect: f64,
    /// The chance that the lifetimes at hand show that difference, 0..=1; `None` where no lifetime differs from
    /// another: then no test can be made, and the next two are `None`, too.
    pub power: Option<f64>,
    /// How many lifetimes of each agent show it with a chance of 80 %; `None` for more than 100,000.
    pub lifetimes_needed: Option<usize>,
    /// The smallest difference that the lifetimes at hand show with a chance of 80 %.
    pub smallest_effect: Option<f64>,
}

/// Of every metric of which at least two lifetimes of each agent have values. Without another agent,
/// `others` empty, it is taken to be one whose lifetimes vary as much and are as many.
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
