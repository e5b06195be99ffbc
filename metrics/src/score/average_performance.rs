//! Average performance while learning and while being evaluated.
//!
//! Not here: how evaluations relate to learning, see `performance_maintenance` and `transfer`.

use crate::BlockType;
use crate::lifetime::{Lifetime, Regime};
use crate::statistics::mean;

/// Averages of a task's regimes, in order.
pub(super) struct Averages {
    pub(super) train: Vec<f64>,
    pub(super) eval: Vec<f64>,
}

/// Mean over a regime's rows; `None` for wake evaluations of a lifetime that sleeps.
pub(super) fn of(lifetime: &Lifetime, regime: &Regime) -> Option<f64> {
    if lifetime.is_assessed(regime) {
        mean(&regime.performance)
    } else {
        None
    }
}

/// Averages of a task's regimes by block type.
pub(super) fn of_task(lifetime: &Lifetime, task: &str) -> Averages {
    let of_type = |block_type: BlockType| {
        let regimes = lifetime
            .regimes_of(task)
            .filter(|regime| regime.block_type == block_type);
        regimes.filter_map(|regime| of(lifetime, regime)).collect()
    };
    Averages {
        train: of_type(BlockType::Train),
        eval: of_type(BlockType::Test),
    }
}

/// Mean of the regimes' means, each counting once however long it is.
pub(super) fn mean_of_regimes(averages: &[f64]) -> Option<f64> {
    mean(averages)
}
