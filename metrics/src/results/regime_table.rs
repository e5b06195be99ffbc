//! The values of each regime, and their table: columns of the reference's `NAME_regime.tsv`.

use driftworld_text::cell as guarded;
use indexmap::IndexSet;

use super::{LifetimeMetrics, Value, Values};
use crate::log::line;
use crate::{BlockSubtype, BlockType, Regime};

/// Number of characters of the task parameters that the table shows.
const SHOWN_PARAMS: usize = 25;

/// Columns that identify the regime.
const IDENTITY: [&str; 6] = [
    "block_num",
    "block_type",
    "block_subtype",
    "task_name",
    "regime_num",
    PARAMS,
];

/// The only one of these columns that may be absent.
const PARAMS: &str = "task_params";

/// The column with the lifetime's name.
const RUN_ID: &str = "run_id";

/// Whether the table uses this column name for something other than a value.
pub(crate) fn is_regime_column(name: &str) -> bool {
    name == RUN_ID || IDENTITY.contains(&name)
}

/// A regime with its values, in normalised units.
#[derive(Debug, Clone, PartialEq)]
pub struct RegimeMetrics {
    /// Number of the block, as logged.
    pub block_num: u64,
    /// Learning or evaluation.
    pub block_type: BlockType,
    /// Awake or asleep.
    pub block_subtype: BlockSubtype,
    /// The task.
    pub task_name: String,
    /// Index among the regimes.
    pub regime_num: usize,
    /// Parameters of its first row, as JSON.
    pub task_params: String,
    /// The metrics' values for it, by name.
    pub values: Values,
}

impl LifetimeMetrics {
    /// The regimes as tab-separated text with a header: the regime, its values, the log.
    ///
    /// The column `task_params` is present only if regimes differ in it; it holds the first 25 characters.
    pub fn regime_tsv(&self) -> String {
        tsv(std::slice::from_ref(self), Vec::push)
    }
}

/// The regimes of several lifetimes as one table, with the log in the first column, as in the reference.
pub fn regimes_tsv(lifetimes: &[LifetimeMetrics]) -> String {
    tsv(lifetimes, |row, run_id| row.insert(0, run_id))
}

fn tsv(lifetimes: &[LifetimeMetrics], put_run_id: fn(&mut Vec<String>, String)) -> String {
    let regimes = || lifetimes.iter().flat_map(|lifetime| &lifetime.regimes);
    let params_vary = regimes()
        .zip(regimes().skip(1))
        .any(|(one, next)| one.task_params != next.task_params);
    let names: IndexSet<&str> = regimes()
        .flat_map(|regime| regime.values.iter().map(|(name, _)| name))
        .collect();
    let is_shown = |column: &str| params_vary || column != PARAMS;
    let identity = IDENTITY.into_iter().filter(|column| is_shown(column));
    let mut header: Vec<String> = identity.chain(names.iter().copied()).map(str::to_owned).collect();
    put_run_id(&mut header, RUN_ID.to_owned());
    let mut text = line(header);
    for lifetime in lifetimes {
        for regime in &lifetime.regimes {
            let identity = IDENTITY
                .into_iter()
                .zip(regime.identity())
                .filter(|(column, _)| is_shown(column));
            let values = names
                .iter()
                .map(|name| regime.values.get(name).map(cell).unwrap_or_default());
            let mut row: Vec<String> = identity.map(|(_, text)| text).chain(values).collect();
            put_run_id(&mut row, guarded(&lifetime.run_id).into_owned());
            text.extend(line(row));
        }
    }
    String::from_utf8(text).expect("cells are text, and quoting adds only quotes")
}

impl RegimeMetrics {
    pub(crate) fn new(regime: &Regime, values: Values) -> Self {
        Self {
            block_num: regime.block_num,
            block_type: regime.block_type,
            block_subtype: regime.block_subtype,
            task_name: regime.task_name.clone(),
            regime_num: regime.regime_num,
            task_params: crate::log::spaced_json(&regime.task_params),
            values,
        }
    }

    fn identity(&self) -> [String; IDENTITY.len()] {
        [
            self.block_num.to_string(),
            self.block_type.to_string(),
            self.block_subtype.to_string(),
            guarded(&self.task_name).into_owned(),
            self.regime_num.to_string(),
            shortened(&self.task_params),
        ]
    }
}

/// A value in a table: numbers as they are, anything else as JSON.
pub(super) fn cell(value: &Value) -> String {
    match value {
        Value::Count(count) => count.to_string(),
        Value::Number(number) => format!("{number:?}"),
        other => serde_json::to_string(other).expect("numbers and text always serialise"),
    }
}

fn shortened(params: &str) -> String {
    match params.char_indices().nth(SHOWN_PARAMS) {
        Some((end, _)) => format!("{}...", &params[..end]),
        None => params.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_are_cut_after_25_characters() {
        let check = |params: &str, expected: &str| assert_eq!(shortened(params), expected);
        check(r#"{"a": 1}"#, r#"{"a": 1}"#);
        check(&"é".repeat(25), &"é".repeat(25));
        check(&"é".repeat(26), &format!("{}...", "é".repeat(25)));
    }
}
