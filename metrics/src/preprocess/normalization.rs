//! Normalisation: performances are scaled to 1..=101, so that tasks with different rewards can be compared.

use indexmap::IndexMap;

use super::given_range;
use crate::lifetime::Lifetime;
use crate::{DataRange, MetricsError, NormalizationMethod, Options};

/// Width of the target range.
const SCALE: f64 = 100.0;

/// Its lower end: not 0, so that ratios of performances always exist.
const OFFSET: f64 = 1.0;

/// Scales every performance, and returns the original range per task.
///
/// A task (under `task`) or run (under `run`) whose performances are all equal becomes 1 everywhere; so does one whose
/// performances differ only by the rounding of smoothing, which the reference scales to 1..=101.
pub(crate) fn normalize(
    lifetime: &mut Lifetime,
    options: &Options,
) -> Result<Option<IndexMap<String, DataRange>>, MetricsError> {
    if options.normalization_method == NormalizationMethod::Off {
        return Ok(None);
    }
    let mut ranges = IndexMap::new();
    for task in lifetime.tasks() {
        let range = match given_range(task, lifetime, options)? {
            Some(range) => range,
            None => hull(lifetime.performances_of(task)),
        };
        ranges.insert(task.clone(), range);
    }
    let whole = hull(ranges.values().flat_map(|range| [range.min, range.max]));
    for regime in lifetime.all_regimes_mut() {
        let range = match options.normalization_method {
            NormalizationMethod::Run => Some(whole),
            _ => ranges.get(&regime.task_name).copied(),
        };
        // An expert's evaluation of a task that the lifetime lacks has no range; nothing reads it.
        if let Some(range) = range {
            stretch(&mut regime.performance, range);
        }
    }
    Ok(Some(ranges))
}

fn hull(values: impl Iterator<Item = f64>) -> DataRange {
    values.fold(DataRange::new(f64::INFINITY, f64::NEG_INFINITY), |range, value| {
        DataRange::new(range.min.min(value), range.max.max(value))
    })
}

/// Differences up to this share of the largest performance are rounding errors; a mean of a hundred equal numbers has a smaller
/// error.
const ROUNDING: f64 = 1e-12;

fn stretch(values: &mut [f64], range: DataRange) {
    let width = range.max - range.min;
    let is_constant = width <= ROUNDING * range.min.abs().max(range.max.abs());
    for value in values {
        *value = if is_constant {
            OFFSET
        } else {
            (*value - range.min) / width * SCALE + OFFSET
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_are_scaled_to_1_to_101() {
        let check = |mut values: Vec<f64>, range: DataRange, expected: &[f64]| {
            stretch(&mut values, range);
            assert_eq!(values, expected);
        };
        check(
            vec![-1.0, 0.0, 3.0],
            DataRange { min: -1.0, max: 3.0 },
            &[1.0, 26.0, 101.0],
        );
        check(vec![5.0, 5.0], DataRange { min: 5.0, max: 5.0 }, &[1.0, 1.0]);
        check(vec![20.0], DataRange { min: 0.0, max: 10.0 }, &[201.0]);
        // The last bit of a mean of equal numbers may be wrong.
        let next = f64::from_bits(0.1_f64.to_bits() + 1);
        check(vec![0.1, next], DataRange { min: 0.1, max: next }, &[1.0, 1.0]);
    }
}
