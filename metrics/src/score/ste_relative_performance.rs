//! Performance relative to a single-task expert: what the agent gathers while learning, as a part of what an agent
//! gathers that has only this task to learn.
//!
//! Not here: how fast either learns, see `sample_efficiency`.

use super::{Assessment, Metric};
use crate::lifetime::{Lifetime, SteRun};
use crate::results::{Direction, Headline};
use crate::statistics::mean;
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
        for task in lifetime.tasks() {
            let values = of_task(lifetime, task, assessment.options().ste_averaging_method);
            assessment.set_task(task, NAME, mean(&values));
            assessment.set_task(task, "ste_rel_perf_vals", Some(values));
        }
        Ok(())
    }
}

/// One value per run of the task's expert (`metrics`), or one against their average (`time`).
///
/// Sum of the first n performances of the task's learning, over that of the expert's, n being the shorter length.
/// Empty without experts or without learning; runs that add up to 0 are left out.
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
    runs.into_iter()
        .map(relative)
        .filter(|value| value.is_finite())
        .collect()
}

/// The runs cut to the shortest and averaged step by step; `None` without runs.
pub(super) fn average_over_time(runs: &[SteRun]) -> Option<Vec<f64>> {
    let runs: Vec<Vec<f64>> = runs.iter().map(SteRun::training_performance).collect();
    let shortest = runs.iter().map(Vec::len).min()?;
    let mean_at = |index: usize| runs.iter().map(|run| run[index]).sum::<f64>() / runs.len() as f64;
    Some((0..shortest).map(mean_at).collect())
}
