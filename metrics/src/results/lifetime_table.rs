//! The values of several lifetimes as a table, a row each: columns of the reference's `ll_metrics.tsv`.
//!
//! Not here: the table of regimes, see `regime_table`.

use indexmap::IndexMap;
use serde_json::Value;

use super::LifetimeMetrics;
use crate::log::line;

/// Fields that are no column: too long for a cell, and in the JSON beside the table.
const LEFT_OUT: [&str; 4] = ["normalization_data_range", "as_logged", "notes", "task_metrics"];

/// A row per lifetime, the log in the first column; a column for every value that some lifetime has.
pub(super) fn lifetimes_tsv(lifetimes: &[LifetimeMetrics]) -> String {
    let rows = lifetimes
        .iter()
        .map(|lifetime| serde_json::to_value(lifetime).expect("results always become JSON"));
    let rows: Vec<Value> = rows.collect();
    let names = rows
        .iter()
        .filter_map(Value::as_object)
        .flat_map(|row| row.keys().map(String::as_str));
    let mut columns: IndexMap<&str, ()> = IndexMap::from([("run_id", ())]);
    columns.extend(names.filter(|name| !LEFT_OUT.contains(name)).map(|name| (name, ())));
    let mut text = line(columns.keys());
    for row in &rows {
        text.extend(line(columns.keys().map(|name| cell(&row[name]))));
    }
    String::from_utf8(text).expect("cells are text, and quoting adds only quotes")
}

fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => driftworld_text::cell(text).into_owned(),
        other => other.to_string(),
    }
}
