//! Performance relative to a single-task expert: the rewards gathered while learning, divided by those of an agent that learns only
//! this task.

use super::assessment::Assessment;
use super::metric::Metric;
use crate::lifetime::{Lifetime, SteRun};
use crate::results::{Direction, Headline};
use crate::statistics::{mean, mean_of_known};
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
            let task_value = mean_of_known(&values);
            of_tasks.extend(task_value);
            assessment.set_task(task, NAME, task_value);
            assessment.set_task(task, "ste_rel_perf_vals", Some(with_gaps(&values)));
        }
        assessment.set_lifetime_of(NAME, of_tasks);
        Ok(())
    }
}

/// A caution about tasks in which the lifetime or an expert gathered 0 or less in total. A ratio is meaningless there, and the
/// larger of two losses looks better; the caution states the difference of the means, which is meaningful.
pub(super) fn caution(lifetime: &Lifetime) -> Option<String> {
    let mut found = Vec::new();
    for task in lifetime.tasks() {
        let (_, learning) = lifetime.training_of(task);
        let runs = lifetime.experts_of(task).iter().map(SteRun::training_performance);
        // Means over the shorter length, as in the ratio.
        let pairs = runs.filter_map(|run| {
            let num = run.len().min(learning.len());
            Some((mean(&learning[..num])?, mean(&run[..num])?))
        });
        let pairs: Vec<(f64, f64)> = pairs.collect();
        if pairs.iter().any(|(own, expert)| *own <= 0.0 || *expert <= 0.0) {
            let differences: Vec<f64> = pairs.iter().map(|(own, expert)| own - expert).collect();
            found.extend(mean(&differences).map(|difference| format!("{task} {difference:.3}")));
        }
    }
    (!found.is_empty()).then(|| {
        format!(
            "performances that add up to 0 or less: ste_rel_perf and sample_efficiency are meaningless for these tasks, and \
             the larger of two losses looks better; mean of the lifetime minus mean of the expert: {}",
            found.join(", ")
        )
    })
}

/// One value per run of the task's expert (`metrics`), or one for the average of all runs (`time`).
///
/// Sum of the first n performances of the task's learning, divided by the sum of the expert's first n, where n is the shorter
/// length. Empty without experts or without learning. If a run sums to 0, the value is not finite; the mean skips NaN, as in the
/// reference.
fn of_task(lifetime: &Lifetime, task: &str, averaging: SteAveragingMethod) -> Vec<f64> {
    let (_, learning) = lifetime.training_of(task);
    if learning.is_empty() {
        return Vec::new();
    }
    let runs = expert_runs(lifetime.experts_of(task), averaging, SteRun::training_performance);
    let relative = |run: Vec<f64>| {
        let num = run.len().min(learning.len());
        learning[..num].iter().sum::<f64>() / run[..num].iter().sum::<f64>()
    };
    runs.into_iter().map(relative).collect()
}

/// The values, with `None` for those that are not finite.
pub(super) fn with_gaps(values: &[f64]) -> Vec<Option<f64>> {
    let finite = |value: &f64| value.is_finite().then_some(*value);
    values.iter().map(finite).collect()
}

/// A list for each run of an expert, or only for the average over time, as requested.
pub(super) fn expert_runs(
    experts: &[SteRun],
    averaging: SteAveragingMethod,
    of_run: fn(&SteRun) -> Vec<f64>,
) -> Vec<Vec<f64>> {
    match averaging {
        SteAveragingMethod::Metrics => experts.iter().map(of_run).collect(),
        SteAveragingMethod::Time => average_over_time(experts).into_iter().collect(),
    }
}

/// The runs truncated to the shortest and averaged step by step; `None` if there are no runs.
fn average_over_time(runs: &[SteRun]) -> Option<Vec<f64>> {
    let runs: Vec<Vec<f64>> = runs.iter().map(SteRun::training_performance).collect();
    let shortest = runs.iter().map(Vec::len).min()?;
    let mean_at = |index: usize| runs.iter().map(|run| run[index]).sum::<f64>() / runs.len() as f64;
    Some((0..shortest).map(mean_at).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Log, LogWriter, LoggerInfo, NormalizationMethod, Record, ScenarioInfo, SteLog, Timestamp, read_log};

    fn log_of(name: &str, rewards: &[f64]) -> Log {
        let base = tempfile::tempdir().expect("a folder");
        let dir = base.path().join(name);
        let info = LoggerInfo::new(["reward"]).expect("one column");
        let mut writer = LogWriter::create(&dir, &info, &ScenarioInfo::default()).expect("a new log");
        for (number, reward) in (0..).zip(rewards) {
            let when = Timestamp::from_unix_micros(number as i64).expect("a time");
            let record = Record::new(0, number, crate::BlockType::Train, "a_1", when);
            writer.write(&record.with_metric("reward", *reward)).expect("a row");
        }
        drop(writer);
        read_log(&dir).expect("a log")
    }

    #[test]
    fn losses_are_shown_with_their_difference() {
        let check = |own: f64, expert: f64, expected: Option<&str>| {
            let options = Options {
                normalization_method: NormalizationMethod::Off,
                ..Options::default()
            };
            let experts = [SteLog::new(log_of("expert", &[expert; 4])).expect("one task")];
            let found = crate::score(&log_of("life", &[own; 4]), &experts, &options).expect("scores");
            let caution_text = found.cautions.iter().find(|text| text.contains("ste_rel_perf"));
            match expected {
                None => assert_eq!(caution_text, None),
                Some(end) => assert!(
                    caution_text.is_some_and(|caution_text| caution_text.ends_with(end)),
                    "{caution_text:?}"
                ),
            }
        };
        // -20 divided by -10 is 2, which is above 1 although it is twice the loss.
        check(-20.0, -10.0, Some("mean of the expert: a_1 -10.000"));
        check(20.0, -10.0, Some("mean of the expert: a_1 30.000"));
        check(-20.0, 10.0, Some("mean of the expert: a_1 -30.000"));
        check(20.0, 10.0, None);
    }
}
