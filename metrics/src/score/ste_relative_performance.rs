//! Performance relative to a single-task expert: what the agent gathers while learning, as a part of what an agent
//! gathers that has only this task to learn.
//!
//! Not here: how fast either learns, see `sample_efficiency`.

use super::{Assessment, Metric};
use crate::lifetime::{Lifetime, SteRun};
use crate::results::{Direction, Headline};
use crate::statistics::mean_of_known;
use crate::{MetricsError, Options, SteAveragingMethod};

/// `ste_rel_perf` of every task, the mean of its `ste_rel_perf_vals`.
pub(super) struct SteRelativePerformance;

const NAME: &str = "ste_rel_perf";

impl Metric for SteRelativePerformance {
    fn headlines(&self, _: &Options) -> Vec<Headline> {
        vec![Headline::new(
            NAME,
            "performance gathered while learning, over that of an expert trained on the task alone",
            Direction::HigherThan(1.0),
        )]
    }

    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        let lifetime = assessment.lifetime();
        let mut of_tasks = Vec::new();
        for task in lifetime.tasks() {
            let values = of_task(lifetime, task, assessment.options().ste_averaging_method);
            let whole = mean_of_known(&values);
            of_tasks.extend(whole);
            assessment.set_task(task, NAME, whole);
            assessment.set_task(task, "ste_rel_perf_vals", Some(with_gaps(&values)));
        }
        assessment.set_lifetime_of(NAME, of_tasks);
        Ok(())
    }
}

/// One value per run of the task's expert (`metrics`), or one against their average (`time`).
///
/// Sum of the first n performances of the task's learning, over that of the expert's, n being the shorter length.
/// Empty without experts or without learning. Over a run that adds up to 0 the value is no finite number; the mean leaves out NaN, as
/// the reference's does.
fn of_task(lifetime: &Lifetime, task: &str, averaging: SteAveragingMethod) -> Vec<f64> {
    let (_, learning) = lifetime.training_of(task);
    if learning.is_empty() {
        return Vec::new();
    }
    let runs: Vec<Vec<f64>> = match averaging {
        SteAveragingMethod::Metrics => lifetime
            .experts_of(task)
            .iter()
            .map(SteRun::training_performance)
            .collect(),
        SteAveragingMethod::Time => average_over_time(lifetime.experts_of(task)).into_iter().collect(),
    };
    let relative = |run: Vec<f64>| {
        let num = run.len().min(learning.len());
        learning[..num].iter().sum::<f64>() / run[..num].iter().sum::<f64>()
    };
    runs.into_iter().map(relative).collect()
}

/// The values, with nothing in place of those that are no finite numbers.
pub(super) fn with_gaps(values: &[f64]) -> Vec<Option<f64>> {
    let finite = |value: &f64| value.is_finite().then_some(*value);
    values.iter().map(finite).collect()
}

/// The runs cut to the shortest and averaged step by step; `None` without runs.
pub(super) fn average_over_time(runs: &[SteRun]) -> Option<Vec<f64>> {
    let runs: Vec<Vec<f64>> = runs.iter().map(SteRun::training_performance).collect();
    let shortest = runs.iter().map(Vec::len).min()?;
    let mean_at = |index: usize| runs.iter().map(|run| run[index]).sum::<f64>() / runs.len() as f64;
    Some((0..shortest).map(mean_at).collect())
}
