//! In which world each row of a lifetime took place, as far as its log says so.
//!
//! Not here: what rows of one world are good for, see `score::exchange`.

use std::collections::HashMap;

use indexmap::IndexSet;

use super::{Lifetime, Regime};
use crate::{Log, TaskParams};

/// Column with the number of a row's world among those of its variant and seed.
pub(super) const INDEX: &str = "world_index";

/// Parameter of a task with the seed of its worlds.
const SEED: &str = "seed";

/// The world of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct World {
    /// Number of the task's name as it was logged, with its variant: two variants have two worlds of one number.
    pub(crate) task: u32,
    /// Number of seed and index, the same for all tasks.
    pub(crate) number: u32,
}

/// The seed of the worlds of rows with these parameters, as it is written; empty without one.
pub(super) fn seed_of(params: &TaskParams) -> String {
    params.get(SEED).map(ToString::to_string).unwrap_or_default()
}

/// The world of each row of each regime, in their order; `None` where the log does not say. `log` is the one that the lifetime was
/// prepared from.
pub(crate) fn worlds(log: &Log, lifetime: &Lifetime) -> Vec<Vec<Option<World>>> {
    let rows = &log.rows;
    let params = rows.task_params();
    let mut seeds: IndexSet<String> = IndexSet::new();
    let seeds: Vec<usize> = (params.values().iter())
        .map(|params| seeds.insert_full(seed_of(params)).0)
        .collect();
    let index = rows.metric(INDEX);
    let mut numbers: HashMap<(usize, u64), u32> = HashMap::new();
    let mut world = |row: usize| {
        let index = index?[row];
        if !index.is_finite() {
            return None;
        }
        // Rows are bounded far below what a u32 counts.
        let next = numbers.len() as u32;
        let seed = seeds[params.ids()[row] as usize];
        Some(World {
            task: rows.task_names().ids()[row],
            number: *numbers.entry((seed, index.to_bits())).or_insert(next),
        })
    };
    let of_regime = |regime: &Regime| regime.rows.iter().map(|row| world(*row)).collect();
    lifetime.regimes().iter().map(of_regime).collect()
}
