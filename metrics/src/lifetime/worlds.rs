//! The world of each row of a lifetime, if its log identifies it.

use std::collections::HashMap;

use indexmap::IndexSet;

use super::regime::Regime;
use crate::{Log, TaskParams};

/// Column with the index of a row's world for its variant and seed.
pub(super) const INDEX: &str = "world_index";

/// Task parameter with the seed of its worlds.
const SEED: &str = "seed";

/// The world of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct World {
    /// Id of the task's logged name, with its variant: worlds of two variants differ even if their numbers are equal.
    pub(crate) task: u32,
    /// Id of the pair of seed and index, shared by all tasks.
    pub(crate) number: u32,
}

/// The seed of the worlds of rows with these parameters, as text; empty if there is none.
pub(super) fn seed_of(params: &TaskParams) -> String {
    params.get(SEED).map(ToString::to_string).unwrap_or_default()
}

/// The world of each row of each regime, in order; `None` if it is not logged. The regimes must have been prepared from this log.
pub(crate) fn worlds(log: &Log, regimes: &[Regime]) -> Vec<Vec<Option<World>>> {
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
        // The number of rows is far below the range of a u32.
        let next = numbers.len() as u32;
        let seed = seeds[params.ids()[row] as usize];
        Some(World {
            task: rows.task_names().ids()[row],
            number: *numbers.entry((seed, index.to_bits())).or_insert(next),
        })
    };
    let of_regime = |regime: &Regime| regime.rows.iter().map(|row| world(*row)).collect();
    regimes.iter().map(of_regime).collect()
}
