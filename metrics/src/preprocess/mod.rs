//! What is done to performances before they are judged: smoothing, clamping of outliers, normalisation, and noise if asked
//! for, in that order.
//!
//! Not here: the metrics.

mod clamping;
mod noise;
mod normalization;
mod smoothing;

pub(crate) use clamping::clamp;
pub(crate) use noise::disturb;
pub(crate) use normalization::normalize;
pub(crate) use smoothing::{smooth, smoothed};

use crate::lifetime::Lifetime;
use crate::{DataRange, MetricsError, Options, VariantMode};

/// The range a user gave for a task, under the name it is scored by; `None` when no ranges were given at all.
///
/// Where variants do not count, the range of a task is the hull of its variants' ranges.
pub(crate) fn given_range(
    task: &str,
    lifetime: &Lifetime,
    options: &Options,
) -> Result<Option<DataRange>, MetricsError> {
    let Some(ranges) = &options.data_range else {
        return Ok(None);
    };
    let belongs = |name: &str| options.variant_mode.scored_name(name) == task;
    let hull = |a: DataRange, b: DataRange| DataRange {
        min: a.min.min(b.min),
        max: a.max.max(b.max),
    };
    let found = ranges
        .iter()
        .filter(|(name, _)| belongs(name))
        .map(|(_, range)| *range)
        .reduce(hull);
    found.map(Some).ok_or_else(|| MetricsError::BadOption {
        option: "data_range",
        found: format!("no range for task {task}"),
        expected: match options.variant_mode {
            VariantMode::Aware => format!("one for each of {}", lifetime.tasks().join(", ")),
            VariantMode::Agnostic => format!("one for a variant of each of {}", lifetime.tasks().join(", ")),
        },
    })
}
