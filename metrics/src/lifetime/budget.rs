//! The training budget of a task: the number of learning experiences, including those before deployment, and their worlds.

use std::collections::{BTreeMap, BTreeSet};

use super::regime::Regime;
use super::usable::is_deployed;
use super::worlds::{INDEX, seed_of};
use crate::log::{ExpStatus, Log};
use crate::{BlockType, Options};

/// The training budget of a task.
#[derive(Debug, Clone, PartialEq, Default)]
pub(crate) struct Budget {
    /// Learning experiences that count.
    pub(crate) learned: usize,
    /// Learning experiences before deployment.
    pub(crate) before: usize,
    /// The worlds of the learning experiences that count, by seed and index; `None` if any is not logged.
    pub(crate) worlds: Option<BTreeSet<(String, u64)>>,
}

impl Budget {
    /// The budget of the given rows of a log.
    fn of(log: &Log, deployed: &[usize], before: usize) -> Self {
        let params = log.rows.task_params();
        let index = log.rows.metric(INDEX);
        let world = |row: &usize| {
            let index = index?[*row];
            index.is_finite().then(|| (seed_of(params.of(*row)), index.to_bits()))
        };
        Self {
            learned: deployed.len(),
            before,
            worlds: deployed.iter().map(world).collect(),
        }
    }

    /// The budget of an expert's whole training.
    pub(crate) fn of_expert(log: &Log) -> Self {
        let learned = complete_learning(log);
        let (deployed, before): (Vec<usize>, Vec<usize>) =
            learned.partition(|row| is_deployed(log.rows.task_params().of(*row)));
        Self::of(log, &deployed, before.len())
    }
}

fn complete_learning(log: &Log) -> impl Iterator<Item = usize> {
    let rows = &log.rows;
    (0..rows.len())
        .filter(|row| rows.exp_statuses()[*row] == ExpStatus::Complete && rows.block_types()[*row] == BlockType::Train)
}

/// The training budget of each task of a lifetime with these regimes, which must have been prepared from this log with these
/// options. Rows of a drift count towards its nearer end.
pub(crate) fn budgets(log: &Log, regimes: &[Regime], options: &Options) -> BTreeMap<String, Budget> {
    let mut learned: BTreeMap<&str, (Vec<usize>, usize)> = BTreeMap::new();
    for regime in regimes.iter().filter(|regime| regime.block_type == BlockType::Train) {
        for (index, row) in regime.rows.iter().enumerate() {
            learned.entry(task_learned(regime, index)).or_default().0.push(*row);
        }
    }
    let names = log.rows.task_names();
    let scored: Vec<String> = (names.values().iter())
        .map(|name| options.variant_mode.scored_name(name))
        .collect();
    for row in complete_learning(log).filter(|row| !is_deployed(log.rows.task_params().of(*row))) {
        learned.entry(&scored[names.ids()[row] as usize]).or_default().1 += 1;
    }
    let budget =
        |(task, (deployed, before)): (&str, (Vec<usize>, usize))| (task.to_owned(), Budget::of(log, &deployed, before));
    learned.into_iter().map(budget).collect()
}

/// The task that is learned in a row of a regime; in a drift, the nearer end.
pub(crate) fn task_learned(regime: &Regime, row: usize) -> &str {
    regime
        .drift
        .as_ref()
        .map_or(&regime.task_name, |drift| drift.nearer(row))
}
