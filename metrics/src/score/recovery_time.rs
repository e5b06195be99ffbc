//! Recovery time: how long a task that is learnt again takes to be as good as it was.
//!
//! Not here: how recovery changes over a lifetime, see `performance_recovery`.

use super::Assessment;
use super::saturation::ROUNDING;
use crate::Definitions;

/// Recovery time, in experiences, of the second and every later wake learning regime of a task.
///
/// The first index at which the regime reaches the terminal performance of the one before; its number of rows plus
/// one where it never does. Under the published definitions a performance that is lower by rounding reaches it, too.
pub(super) fn of_task(assessment: &Assessment<'_>, task: &str) -> Vec<f64> {
    let trained: Vec<_> = (assessment.lifetime().regimes_of(task))
        .filter(|regime| regime.is_wake_training())
        .collect();
    let time = |pair: &[&crate::Regime]| {
        let ended = assessment.term_perf(pair[0].regime_num)?;
        let wanted = match assessment.options().definitions {
            Definitions::Reference => ended,
            Definitions::Published => ended - ROUNDING * ended.abs(),
        };
        let mut performances = pair[1].per_experience().into_iter();
        let reached = performances.position(|performance| performance >= wanted);
        Some(reached.unwrap_or(pair[1].len() + 1) as f64)
    };
    trained.windows(2).filter_map(time).collect()
}
