//! Performance recovery: whether an agent recovers faster and faster.

use super::assessment::Assessment;
use super::metric::Metric;
use crate::results::{Direction, Headline};
use crate::statistics::theil_sen_slope;
use crate::{Definitions, MetricsError, Options};

/// `perf_recovery` of every task, and the `recovery_times` behind it.
///
/// Minus the Theil–Sen slope of a task's recovery times, in experiences per learning regime; positive if each recovery is
/// faster than the last. `None` for fewer than two recovery times, that is, three learning regimes.
///
/// QUIRK: if the whole lifetime has only one recovery time, it is not listed. Under the published definitions, it is.
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
        let mut times: Vec<Vec<f64>> = tasks.iter().map(|task| times_of(assessment, task)).collect();
        let is_alone = times.iter().map(Vec::len).sum::<usize>() == 1;
        if is_alone && assessment.options().definitions == Definitions::Reference {
            times.iter_mut().for_each(Vec::clear);
        }
        for (task, times) in tasks.iter().zip(times) {
            // Subtracted from 0, because negating a slope of 0 would give -0.
            let faster = theil_sen_slope(&times).map(|slope| 0.0 - slope);
            assessment.set_task(task, NAME, faster);
            assessment.set_task(task, "recovery_times", Some(times));
        }
        Ok(())
    }
}

/// Recovery time, in experiences, of the second and every later wake learning regime of a task.
///
/// The first index at which the regime reaches the terminal performance of the one before; its number of rows plus one if it
/// never does. With `resolves_ties`, a performance that is lower only by rounding also reaches it.
fn times_of(assessment: &Assessment<'_>, task: &str) -> Vec<f64> {
    let trained: Vec<_> = (assessment.lifetime().regimes_of(task))
        .filter(|regime| regime.is_wake_training())
        .collect();
    let time = |pair: &[&crate::Regime]| {
        let ended = assessment.term_perf(pair[0].regime_num)?;
        let performances = pair[1].per_experience();
        let wanted = ended - assessment.slack(&[&performances[..], &[ended]].concat());
        let reached = performances.iter().position(|performance| *performance >= wanted);
        Some(reached.unwrap_or(pair[1].len() + 1) as f64)
    };
    trained.windows(2).filter_map(time).collect()
}
