//! Performance recovery: whether an agent recovers faster and faster.
//!
//! Not here: the single recovery times, see `recovery_time`.

use super::{Assessment, Metric, recovery_time};
use crate::results::{Direction, Headline};
use crate::statistics::theil_sen_slope;
use crate::{Definitions, MetricsError, Options};

/// `perf_recovery` of every task, and the `recovery_times` it is made of.
///
/// Minus the Theil–Sen slope of a task's recovery times, in experiences per learning regime; positive when each
/// recovery is faster than the last. None for fewer than two recovery times, that is, three learning regimes.
///
/// QUIRK: where there is one recovery time in the whole lifetime, it is not listed. It is under the published definitions.
pub(super) struct PerformanceRecovery;

const NAME: &str = "perf_recovery";

impl Metric for PerformanceRecovery {
    fn headlines(&self, _: &Options) -> Vec<Headline> {
        vec![Headline::new(
            NAME,
            "does relearning a task get faster each time? experiences saved per relearning",
            Direction::HigherThan(0.0),
        )]
    }

    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        let tasks = assessment.lifetime().tasks();
        let mut times: Vec<Vec<f64>> = tasks
            .iter()
            .map(|task| recovery_time::of_task(assessment, task))
            .collect();
        let is_alone = times.iter().map(Vec::len).sum::<usize>() == 1;
        if is_alone && assessment.options().definitions == Definitions::Reference {
            times.iter_mut().for_each(Vec::clear);
        }
        for (task, times) in tasks.iter().zip(times) {
            // A difference, since minus a slope of 0 would be -0.
            let faster = theil_sen_slope(&times).map(|slope| 0.0 - slope);
            assessment.set_task(task, NAME, faster);
            assessment.set_task(task, "recovery_times", Some(times));
        }
        Ok(())
    }
}
