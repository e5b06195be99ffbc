//! Performance maintenance: how much of what was learnt is still there at later evaluations.
//!
//! Not here: what learning one task does to another, see `transfer`.

use crate::BlockType;
use crate::lifetime::Lifetime;
use crate::report::RegimeMetrics;
use crate::statistics::mean;

/// Differences of one task, in runs of consecutive regimes of the task.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Maintenance {
    /// Against the most recent reference evaluation.
    pub(super) mrlep: Vec<Vec<f64>>,
    /// Against the most recent learning regime.
    pub(super) mrtlp: Vec<Vec<f64>>,
}

/// Compares each evaluation of a task with what it was right after learning.
///
/// The first evaluation after each learning regime is its reference. Every later evaluation that is no reference
/// gives one difference of terminal performances; runs of such evaluations end where the task is learnt again.
pub(super) fn of_task(lifetime: &Lifetime, regimes: &[RegimeMetrics], task: &str) -> Maintenance {
    let mut found = Maintenance::default();
    // Terminal performance of the most recent learning regime; whether its reference is still to come.
    let (mut learnt, mut awaits_reference) = (None, false);
    let mut reference: Option<f64> = None;
    let mut continues_run = false;
    for regime in lifetime.regimes_of(task) {
        let term_perf = regimes[regime.regime_num].term_perf;
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

/// Mean over all differences; `None` where there is none.
pub(super) fn mean_of_runs(runs: &[Vec<f64>]) -> Option<f64> {
    mean(&runs.concat())
}

fn push(runs: &mut Vec<Vec<f64>>, difference: f64, continues_run: bool) {
    match runs.last_mut() {
        Some(run) if continues_run => run.push(difference),
        _ => runs.push(vec![difference]),
    }
}
