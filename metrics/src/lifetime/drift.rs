//! Drifts: regimes in which the variant changes bit by bit, and the tasks that they pass.
//!
//! Not here: what is made of it, see `score::transfer` and `score::performance_maintenance`.

use indexmap::IndexSet;

use super::Regime;
use crate::log::{Rows, TaskParams};
use crate::{BlockType, Options};

/// Parameters of a task with the variants that a drift begins and ends with.
const ENDS: [&str; 2] = ["variant", "to"];

/// Column with how far a drift has come, 0..=1.
const PROGRESS: &str = "progress";

/// The ends of a drift, and which of them each row is nearer to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drift {
    /// The task that it begins with, under the name that it is scored by.
    pub from: String,
    /// The task that it leads to, under the name that it is scored by.
    pub to: String,
    /// For each row whether the second end is nearer: the column `progress` is at least 0.5, or without such a column
    /// the row lies in the second half of the regime.
    pub is_nearer_to: Vec<bool>,
}

impl Drift {
    /// Of a stretch of rows of one task. A drift says its ends in the parameters `variant` and `to`, and is called
    /// `TASK_VARIANTtoOTHER` for them, or `TASK_VARIANTtoTASKOTHER` between tasks; anything else is none. Nor is one whose ends
    /// are scored as one task.
    pub(super) fn of(rows: &Rows, stretch: &[usize], params: &TaskParams, options: &Options) -> Option<Self> {
        let first = *stretch.first()?;
        let name = rows.task_names().of(first).to_lowercase();
        let (head, tail) = name.split_once('_')?;
        let [from, to] = ENDS.map(|key| params.get(key).and_then(|word| word.as_str()));
        let (from, to) = (from?, to?);
        // An end of another task is said as `task#variant`.
        let logged = |end: &str| match end.split_once('#') {
            Some((task, variant)) => format!("{}_{}", logged_word(task), logged_word(variant)),
            None => format!("{head}_{}", logged_word(end)),
        };
        let scored = |end: &str| options.variant_mode.scored_name(&logged(end));
        let ends = (scored(from), scored(to));
        if tail != format!("{}to{}", logged_word(from), logged_word(to)) || ends.0 == ends.1 {
            return None;
        }
        let progress = rows.metric(PROGRESS);
        let is_nearer_to = |(place, row): (usize, &usize)| match progress {
            Some(progress) => progress[*row] >= 0.5,
            None => 2 * place >= stretch.len(),
        };
        Some(Self {
            from: ends.0,
            to: ends.1,
            is_nearer_to: stretch.iter().enumerate().map(is_nearer_to).collect(),
        })
    }

    /// The end that is nearer at a row.
    pub(crate) fn nearer(&self, row: usize) -> &str {
        if self.is_nearer_to[row] { &self.to } else { &self.from }
    }

    /// Whether it comes near its first end, near its second, and is nearer to the second when it ends.
    fn passes(&self) -> [bool; 3] {
        [
            self.is_nearer_to.contains(&false),
            self.is_nearer_to.contains(&true),
            self.is_nearer_to.last() == Some(&true),
        ]
    }
}

/// The letters and digits of the name of a task or variant, lower-case, as logs have them; `x` where there are none.
pub fn logged_word(name: &str) -> String {
    let plain: String = name.chars().filter(char::is_ascii_alphanumeric).collect();
    if plain.is_empty() {
        "x".to_owned()
    } else {
        plain.to_lowercase()
    }
}

/// Says of each regime of learning which tasks it counts as learning of: its own; a drift, those of its ends that it
/// comes near to and that the lifetime has otherwise. Where it goes from one that was learned before to another, it is
/// learning of the other alone: what becomes of the first is what learning the other does to it.
pub(super) fn set_learned(regimes: &mut [Regime], tasks: &[String]) {
    let tasks: IndexSet<&str> = tasks.iter().map(String::as_str).collect();
    let mut known: IndexSet<String> = IndexSet::new();
    for regime in regimes {
        if regime.block_type == BlockType::Test {
            continue;
        }
        if let Some(drift) = &regime.drift {
            let [near_from, near_to, ends_near_to] = drift.passes();
            let only_to = near_to && ends_near_to && tasks.contains(drift.to.as_str()) && known.contains(&drift.from);
            let passed = [(near_from && !only_to, &drift.from), (near_to, &drift.to)];
            regime.learns = (passed.into_iter())
                .filter(|(is_near, task)| *is_near && tasks.contains(task.as_str()))
                .map(|(_, task)| task.clone())
                .collect();
        }
        if regime.learns.is_empty() {
            regime.learns.push(regime.task_name.clone());
        }
        known.extend(regime.learns.iter().cloned());
    }
}
