//! Performance maintenance: how much of the performance after learning remains at later evaluations.

use std::rc::Rc;

use super::assessment::{Assessment, aggregate};
use super::metric::Metric;
use super::null_bands::Statistic;
use crate::lifetime::Lifetime;
use crate::results::{Direction, Headline};
use crate::statistics::mean;
use crate::{BlockType, MetricsError, Options};

/// `perf_maintenance_mrlep` and `perf_maintenance_mrtlp` of every task, if requested, and the differences that they average,
/// `maintenance_val_…`.
pub(super) struct PerformanceMaintenance;

impl Metric for PerformanceMaintenance {
    fn headlines(&self, options: &Options) -> Vec<Headline> {
        let mrlep = Headline::new(
            "perf_maintenance_mrlep",
            "is a learned task kept? points gained or lost since the evaluation right after learning it",
            Direction::HigherThan(0.0),
        );
        let mrtlp = Headline::new(
            "perf_maintenance_mrtlp",
            "is a learned task kept? points gained or lost since the end of learning it",
            Direction::HigherThan(0.0),
        );
        let method = options.maintenance_method;
        let requested = [(method.has_mrlep(), mrlep), (method.has_mrtlp(), mrtlp)];
        requested
            .into_iter()
            .filter_map(|(is_requested, headline)| is_requested.then_some(headline))
            .collect()
    }

    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        let method = assessment.options().maintenance_method;
        let term_perfs = assessment.term_perfs();
        for task in assessment.lifetime().tasks() {
            let runs = differences(assessment.lifetime(), task);
            let values = |value: fn(&Difference, &[f64]) -> Option<f64>| -> Vec<Vec<f64>> {
                let run = |run: &Vec<Difference>| run.iter().filter_map(|one| value(one, &term_perfs)).collect();
                let runs = runs.iter().map(run).filter(|run: &Vec<f64>| !run.is_empty());
                runs.collect()
            };
            if method.has_mrlep() {
                let mrlep = values(Difference::mrlep);
                assessment.set_task(task, "perf_maintenance_mrlep", mean(&mrlep.concat()));
                assessment.set_task(task, "maintenance_val_mrlep", Some(mrlep));
            }
            if method.has_mrtlp() {
                let mrtlp = values(Difference::mrtlp);
                assessment.set_task(task, "perf_maintenance_mrtlp", mean(&mrtlp.concat()));
                assessment.set_task(task, "maintenance_val_mrtlp", Some(mrtlp));
            }
        }
        Ok(())
    }
}

/// The requested metrics of the lifetime, as functions of terminal performances.
pub(super) fn statistics<'a>(lifetime: &Lifetime, options: &'a Options) -> Vec<Statistic<'a>> {
    let tasks = lifetime.tasks().iter();
    let tasks: Vec<Vec<Difference>> = tasks.map(|task| differences(lifetime, task).concat()).collect();
    let tasks = Rc::new(tasks);
    let method = options.maintenance_method;
    let statistic = |name, value: fn(&Difference, &[f64]) -> Option<f64>| {
        let tasks = Rc::clone(&tasks);
        Statistic::new(name, move |term_perfs| {
            let of_task = |task: &Vec<Difference>| {
                let values: Vec<f64> = task.iter().filter_map(|one| value(one, term_perfs)).collect();
                mean(&values)
            };
            aggregate(tasks.iter().filter_map(of_task).collect(), options)
        })
    };
    let mrlep = statistic("perf_maintenance_mrlep", Difference::mrlep);
    let mrtlp = statistic("perf_maintenance_mrtlp", Difference::mrtlp);
    let requested = [(method.has_mrlep(), mrlep), (method.has_mrtlp(), mrtlp)];
    let requested = requested.into_iter().filter(|(is_requested, _)| *is_requested);
    requested.map(|(_, statistic)| statistic).collect()
}

/// An evaluation and the regimes that it is compared with, by regime number.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Difference {
    evaluation: usize,
    /// The most recent reference evaluation.
    reference: usize,
    /// The most recent learning regime; `None` for a drift, whose end is on a scale of its own.
    learned: Option<usize>,
}

impl Difference {
    #[expect(clippy::unnecessary_wraps, reason = "same signature as `mrtlp`, which may be `None`")]
    fn mrlep(&self, term_perfs: &[f64]) -> Option<f64> {
        Some(term_perfs[self.evaluation] - term_perfs[self.reference])
    }

    fn mrtlp(&self, term_perfs: &[f64]) -> Option<f64> {
        Some(term_perfs[self.evaluation] - term_perfs[self.learned?])
    }
}

/// Compares each evaluation of a task with the one right after learning, in runs of consecutive regimes of the task.
///
/// The first evaluation after each learning regime is its reference. Every later evaluation that is not a reference
/// gives one difference of terminal performances; runs of such evaluations end where the task is learned again. A drift counts as
/// learning the tasks in its `learns`.
fn differences(lifetime: &Lifetime, task: &str) -> Vec<Vec<Difference>> {
    let mut found: Vec<Vec<Difference>> = Vec::new();
    // The most recent learning regime; whether its reference is still to come.
    let (mut learned, mut awaits_reference) = (None, false);
    let mut reference: Option<usize> = None;
    let mut continues_run = false;
    for regime in lifetime.regimes_about(task) {
        let number = regime.regime_num;
        let contributes = match regime.block_type {
            BlockType::Train => {
                (learned, awaits_reference) = (Some((number, regime.task_name == task)), true);
                None
            }
            BlockType::Test if !lifetime.is_assessed(regime) => None,
            BlockType::Test if awaits_reference => {
                (reference, awaits_reference) = (Some(number), false);
                None
            }
            BlockType::Test => reference.zip(learned),
        };
        if let Some((reference, learned)) = contributes {
            let difference = Difference {
                evaluation: number,
                reference,
                learned: learned.1.then_some(learned.0),
            };
            match found.last_mut() {
                Some(run) if continues_run => run.push(difference),
                _ => found.push(vec![difference]),
            }
        }
        continues_run = contributes.is_some();
    }
    found
}
