//! Performance recovery: whether an agent recovers faster and faster.
//!
//! Not here: the single recovery times, see `recovery_time`.

use super::{Assessment, Metric, recovery_time};
use crate::MetricsError;
use crate::report::{Direction, Headline};
use crate::statistics::theil_sen_slope;

/// `perf_recovery` of every task, and the `recovery_times` it is made of.
///
/// Minus the Theil–Sen slope of a task's recovery times, in experiences per learning regime; positive when each
/// recovery is faster than the last. None for fewer than two recovery times, that is, three learning regimes.
pub(super) struct PerformanceRecovery;

const NAME: &str = "perf_recovery";

impl Metric for PerformanceRecovery {
    fn headlines(&self) -> Vec<Headline> {
        vec![Headline::new(
            NAME,
            "does relearning a task get faster each time? experiences saved per relearning",
            Direction::HigherThan(0.0),
        )]
    }

    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        for task in assessment.lifetime().tasks() {
            let times = recovery_time::of_task(assessment, task);
            assessment.set_task(task, NAME, theil_sen_slope(&times).map(|slope| -slope));
            assessment.set_task(task, "recovery_times", Some(times));
        }
        Ok(())
    }
}
