//! Performance maintenance: how much of what was learnt is still there at later evaluations.
//!
//! Not here: what learning one task does to another, see `transfer`.

use super::{Assessment, Metric};
use crate::results::{Direction, Headline};
use crate::statistics::mean;
use crate::{BlockType, MetricsError, Options};

/// `perf_maintenance_mrlep` and `perf_maintenance_mrtlp` of every task, as far as they are asked for, and the
/// differences they are the means of, `maintenance_val_…`.
pub(super) struct PerformanceMaintenance;

impl Metric for PerformanceMaintenance {
    fn headlines(&self, options: &Options) -> Vec<Headline> {
        let mrlep = Headline::new(
            "perf_maintenance_mrlep",
            "is a learnt task kept? points gained or lost since the evaluation right after learning it",
            Direction::HigherThan(0.0),
        );
        let mrtlp = Headline::new(
            "perf_maintenance_mrtlp",
            "is a learnt task kept? points gained or lost since the end of learning it",
            Direction::HigherThan(0.0),
        );
        let method = options.maintenance_method;
        let asked = [(method.has_mrlep(), mrlep), (method.has_mrtlp(), mrtlp)];
        asked
            .into_iter()
            .filter_map(|(is_asked, headline)| is_asked.then_some(headline))
            .collect()
    }

    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        let method = assessment.options().maintenance_method;
        for task in assessment.lifetime().tasks() {
            let Differences { mrlep, mrtlp } = differences(assessment, task);
            if method.has_mrlep() {
                assessment.set_task(task, "perf_maintenance_mrlep", mean(&mrlep.concat()));
                assessment.set_task(task, "maintenance_val_mrlep", Some(mrlep));
            }
            if method.has_mrtlp() {
                assessment.set_task(task, "perf_maintenance_mrtlp", mean(&mrtlp.concat()));
                assessment.set_task(task, "maintenance_val_mrtlp", Some(mrtlp));
            }
        }
        Ok(())
    }
}

/// Differences of one task, in runs of consecutive regimes of the task.
#[derive(Debug, Clone, PartialEq, Default)]
struct Differences {
    /// Against the most recent reference evaluation.
    mrlep: Vec<Vec<f64>>,
    /// Against the most recent learning regime.
    mrtlp: Vec<Vec<f64>>,
}

/// Compares each evaluation of a task with what it was right after learning.
///
/// The first evaluation after each learning regime is its reference. Every later evaluation that is no reference
/// gives one difference of terminal performances; runs of such evaluations end where the task is learnt again.
fn differences(assessment: &Assessment<'_>, task: &str) -> Differences {
    let lifetime = assessment.lifetime();
    let mut found = Differences::default();
    // Terminal performance of the most recent learning regime; whether its reference is still to come.
    let (mut learnt, mut awaits_reference) = (None, false);
    let mut reference: Option<f64> = None;
    let mut continues_run = false;
    for regime in lifetime.regimes_of(task) {
        let Some(term_perf) = assessment.term_perf(regime.regime_num) else {
            continue;
        };
        let contributes = match regime.block_type {
            BlockType::Train => {
                (learnt, awaits_reference) = (Some(term_perf), true);
                None
            }
            BlockType::Test if !lifetime.is_assessed(regime) => None,
            BlockType::Test if awaits_reference => {
                (reference, awaits_reference) = (Some(term_perf), false);
                None
            }
            BlockType::Test => reference.zip(learnt),
        };
        if let Some((reference, learnt)) = contributes {
            push(&mut found.mrlep, term_perf - reference, continues_run);
            push(&mut found.mrtlp, term_perf - learnt, continues_run);
        }
        continues_run = contributes.is_some();
    }
    found
}

fn push(runs: &mut Vec<Vec<f64>>, difference: f64, continues_run: bool) {
    match runs.last_mut() {
        Some(run) if continues_run => run.push(difference),
        _ => runs.push(vec![difference]),
    }
}
