//! Performance recovery: whether an agent recovers faster and faster.
//!
//! Not here: the single recovery times, see `recovery_time`.

use crate::statistics::theil_sen_slope;

/// Minus the Theil–Sen slope of a task's recovery times, in experiences per learning regime; positive when each
/// recovery is faster than the last. `None` for fewer than two recovery times, that is, three learning regimes.
pub(super) fn of(recovery_times: &[f64]) -> Option<f64> {
    theil_sen_slope(recovery_times).map(|slope| -slope)
}
