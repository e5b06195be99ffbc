//! Clamping: moves performances outside a task's usual range to the nearer end of that range.

use super::given_range;
use crate::lifetime::Lifetime;
use crate::statistics::quantile;
use crate::{DataRange, MetricsError, Options};

/// Default quantiles that bound a task's performances.
const USUAL: (f64, f64) = (0.1, 0.9);

/// Clips each task's performances, and its experts', to the given range or to the 0.1 and 0.9 quantiles of the task's data
/// together with its experts' training data. Does nothing unless requested.
pub(crate) fn clamp(lifetime: &mut Lifetime, options: &Options) -> Result<(), MetricsError> {
    if !options.clamp_outliers {
        return Ok(());
    }
    for task in lifetime.tasks().to_vec() {
        let range = match given_range(&task, lifetime, options)? {
            Some(range) => range,
            None => usual_range(&lifetime.performances_of(&task).collect::<Vec<_>>()),
        };
        for regime in lifetime.all_regimes_mut().filter(|regime| regime.task_name == task) {
            for value in &mut regime.performance {
                // The range is ordered: given ranges were checked, and quantiles are monotone.
                *value = value.max(range.min).min(range.max);
            }
        }
    }
    Ok(())
}

fn usual_range(performances: &[f64]) -> DataRange {
    DataRange::new(
        quantile(performances, USUAL.0).unwrap_or(f64::MIN),
        quantile(performances, USUAL.1).unwrap_or(f64::MAX),
    )
}
