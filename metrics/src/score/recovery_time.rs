//! Recovery time: how long a task that is learnt again takes to be as good as it was.
//!
//! Not here: how recovery changes over a lifetime, see `performance_recovery`.

use crate::lifetime::Lifetime;
use crate::report::RegimeMetrics;

/// Recovery time, in experiences, of the second and every later wake learning regime of a task.
///
/// The first index at which the regime reaches the terminal performance of the one before; its number of rows plus
/// one where it never does. They are listed even where there are too few for `perf_recovery`; the reference lists
/// none when the whole lifetime has only one.
pub(super) fn of_task(lifetime: &Lifetime, regimes: &[RegimeMetrics], task: &str) -> Vec<f64> {
    let trained: Vec<_> = lifetime
        .regimes_of(task)
        .filter(|regime| regime.is_wake_training())
        .collect();
    trained
        .windows(2)
        .map(|pair| {
            let wanted = regimes[pair[0].regime_num].term_perf;
            let reached = pair[1]
                .per_experience()
                .iter()
                .position(|performance| *performance >= wanted);
            reached.unwrap_or(pair[1].len() + 1) as f64
        })
        .collect()
}
