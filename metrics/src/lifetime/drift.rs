//! Drifts: regimes in which the variant changes gradually, and the tasks that they count towards.

use indexmap::IndexSet;

use super::Regime;
use crate::log::{Rows, TaskParams};
use crate::{BlockType, Options};

/// Task parameters with the variants at the start and end of a drift.
const ENDS: [&str; 2] = ["variant", "to"];

/// Column with the progress of a drift, 0..=1.
const PROGRESS: &str = "progress";

/// The two ends of a drift, and the nearer one for each row.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Drift {
    /// Its first task, under the name used for scoring.
    pub from: String,
    /// Its last task, under the name used for scoring.
    pub to: String,
    /// For each row, whether the last task is nearer: the column `progress` is at least 0.5, or, without such a column, the row is
    /// in the second half of the regime.
    pub is_nearer_to: Vec<bool>,
}

impl Drift {
    /// Detects a drift in a stretch of rows of one task. The parameters `variant` and `to` of a drift give its ends, and its task
    /// is called `TASK_VARIANTtoOTHER`, or `TASK_VARIANTtoTASKOTHER` between tasks. `None` if there is no drift, or if both ends
    /// are scored as one task.
    pub(super) fn of(rows: &Rows, stretch: &[usize], params: &TaskParams, options: &Options) -> Option<Self> {
        let first = *stretch.first()?;
        let name = rows.task_names().of(first).to_lowercase();
        let (head, tail) = name.split_once('_')?;
        let [from, to] = ENDS.map(|key| params.get(key).and_then(|word| word.as_str()));
        let (from, to) = (from?, to?);
        // An end in a different task is written as `task#variant`.
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
        let is_nearer_to = |(index, row): (usize, &usize)| match progress {
            Some(progress) => progress[*row] >= 0.5,
            None => 2 * index >= stretch.len(),
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

    /// Whether the drift has rows nearer to its first task, whether it has rows nearer to its last, and whether it ends nearer to
    /// its last.
    fn passes(&self) -> [bool; 3] {
        [
            self.is_nearer_to.contains(&false),
            self.is_nearer_to.contains(&true),
            self.is_nearer_to.last() == Some(&true),
        ]
    }
}

/// The ASCII letters and digits of a task's or variant's name, in lower case, as in logs; `x` if there are none.
pub fn logged_word(name: &str) -> String {
    let plain: String = name.chars().filter(char::is_ascii_alphanumeric).collect();
    if plain.is_empty() {
        "x".to_owned()
    } else {
        plain.to_lowercase()
    }
}

/// Sets the tasks that each learning regime counts towards: its own task, or, for a drift, the ends that it comes near and that
/// also occur elsewhere in the lifetime. A drift from an already learned task to another counts only as learning the other, so
/// its effect on the first task counts as an effect of learning the other.
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
            let near_ends = [(near_from && !only_to, &drift.from), (near_to, &drift.to)];
            regime.learns = (near_ends.into_iter())
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
