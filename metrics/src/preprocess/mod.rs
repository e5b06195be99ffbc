//! Preprocessing of performances: smoothing, clamping of outliers, normalisation, and optional noise, in that order.

mod clamping;
mod noise;
mod normalization;
mod smoothing;

pub(crate) use clamping::clamp;
pub(crate) use noise::disturb;
pub(crate) use normalization::normalize;
pub(crate) use smoothing::{smooth, smoothed};

use crate::lifetime::Lifetime;
use crate::{Anchors, DataRange, MetricsError, Options, VariantMode};

/// The floor and ceiling of a task, under the name used for scoring; `None` if unknown, or if the ceiling is not above the
/// floor, so that nothing can be learned. If variants do not count, the lowest floor and the highest ceiling of its variants.
pub(crate) fn anchors(task: &str, options: &Options) -> Option<Anchors> {
    given_anchors(task, options).filter(|anchors| anchors.ceiling > anchors.floor)
}

/// A caution about tasks whose given ceiling is not above the floor: they are scaled by their own range instead.
pub(crate) fn caution_of_scales(lifetime: &Lifetime, options: &Options) -> Option<String> {
    let flat = |task: &String| {
        let Anchors { floor, ceiling, .. } = given_anchors(task, options)?;
        (ceiling <= floor).then(|| format!("{task} (floor {floor}, ceiling {ceiling})"))
    };
    let flat: Vec<String> = lifetime.tasks().iter().filter_map(flat).collect();
    (!flat.is_empty()).then(|| {
        format!(
            "scales: found no ceiling above the floor, expected one; each of these is scaled by its own range: {}",
            flat.join(", ")
        )
    })
}

fn given_anchors(task: &str, options: &Options) -> Option<Anchors> {
    let scales = options.scales.iter().flatten();
    let of_task = scales.filter(|(name, _)| options.variant_mode.scored_name(name) == task);
    let hull = |a: Anchors, b: Anchors| Anchors {
        floor: a.floor.min(b.floor),
        ceiling: a.ceiling.max(b.ceiling),
        unlabelled: Vec::new(),
    };
    of_task.map(|(_, anchors)| anchors.clone()).reduce(hull)
}

/// The range given for a task, under the name used for scoring: its range in `data_range` if that option is given, and an error if
/// the task is missing there; otherwise its floor and ceiling, or `None` if these are unknown.
///
/// If variants do not count, the range of a task is the hull of its variants' ranges.
pub(crate) fn given_range(
    task: &str,
    lifetime: &Lifetime,
    options: &Options,
) -> Result<Option<DataRange>, MetricsError> {
    let Some(ranges) = &options.data_range else {
        let range = |anchors: Anchors| DataRange::new(anchors.floor, anchors.ceiling);
        return Ok(anchors(task, options).map(range));
    };
    let belongs = |name: &str| options.variant_mode.scored_name(name) == task;
    let hull = |a: DataRange, b: DataRange| DataRange::new(a.min.min(b.min), a.max.max(b.max));
    let found = ranges
        .iter()
        .filter(|(name, _)| belongs(name))
        .map(|(_, range)| *range)
        .reduce(hull);
    found.map(Some).ok_or_else(|| {
        MetricsError::bad_option(
            "data_range",
            format!("no range for task {task}"),
            match options.variant_mode {
                VariantMode::Aware => format!("one for each of {}", lifetime.tasks().join(", ")),
                VariantMode::Agnostic => format!("one for a variant of each of {}", lifetime.tasks().join(", ")),
            },
        )
    })
}
