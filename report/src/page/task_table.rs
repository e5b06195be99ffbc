//! The table of tasks: for how many experiences each was learned and evaluated, and its scalar metrics.

use std::collections::BTreeMap;

use driftworld_metrics::{BlockType, Lifetime, LifetimeMetrics};
use maud::{Markup, html};

use super::pieces::{count, number};
use super::verdict;
use crate::words::shown;

/// Maximum number of rows shown; the metrics files have all tasks.
const MAX_ROWS: usize = 200;

/// The whole table. `display_names` maps a task's log name to its display name.
pub(super) fn table(
    lifetime: &Lifetime,
    metrics: &LifetimeMetrics,
    display_names: &BTreeMap<String, String>,
) -> Markup {
    let names: Vec<String> = metrics.summary().iter().map(|row| row.name.to_string()).collect();
    let value = |task: &str, name: &str| metrics.task_metrics.get(task).and_then(|values| values.number(name));
    let has = |name: &String| lifetime.tasks().iter().any(|task| value(task, name).is_some());
    let columns: Vec<&String> = names.iter().filter(|name| has(name)).collect();
    let rows = |task: &str, block_type: BlockType| -> (usize, usize) {
        let regimes = lifetime
            .regimes_of(task)
            .filter(|regime| regime.block_type == block_type);
        regimes.fold((0, 0), |(blocks, rows), regime| (blocks + 1, rows + regime.len()))
    };
    html! {
        div.scroll role="region" aria-label="Tasks" tabindex="0" {
            table {
                thead {
                    tr {
                        th scope="col" { "Task" }
                        th.number scope="col" { "Learning" br; "blocks" }
                        th.number scope="col" { "Learning" br; "experiences" }
                        th.number scope="col" { "Evaluation" br; "experiences" }
                        @for name in &columns { th.number scope="col" { (heading(name)) } }
                    }
                }
                tbody {
                    @for task in lifetime.tasks().iter().take(MAX_ROWS) {
                        tr {
                            th scope="row" { (row_heading(task, display_names)) }
                            td.number { (count(rows(task, BlockType::Train).0)) }
                            td.number { (count(rows(task, BlockType::Train).1)) }
                            td.number { (count(rows(task, BlockType::Test).1)) }
                            @for name in &columns {
                                td.number { (value(task, name).map_or("–".to_owned(), number)) }
                            }
                        }
                    }
                }
            }
        }
        @if lifetime.tasks().len() > MAX_ROWS {
            p.note { "and " (count(lifetime.tasks().len() - MAX_ROWS)) " more tasks: see the metrics file." }
        }
    }
}

/// The task's display name, with its log name below if they differ.
fn row_heading(task: &str, display_names: &BTreeMap<String, String>) -> Markup {
    html! {
        @match display_names.get(task).filter(|name| *name != task) {
            Some(name) => { (shown(name)) small { "in the log " (shown(task)) } },
            None => (shown(task)),
        }
    }
}

/// Heading of a metric's narrow column, on up to two lines.
fn heading(name: &str) -> Markup {
    let lines: [&str; 2] = match name {
        "perf_recovery" => ["Recovery", ""],
        "avg_train_perf" => ["Performance", "learning"],
        "avg_eval_perf" => ["Performance", "evaluations"],
        "perf_maintenance_mrlep" => ["Maintenance", "mrlep"],
        "perf_maintenance_mrtlp" => ["Maintenance", "mrtlp"],
        "ste_rel_perf" => ["Relative to", "expert"],
        "sample_efficiency" => ["Sample", "efficiency"],
        _ => return html! { (verdict::title(name)) },
    };
    html! { (lines[0]) @if !lines[1].is_empty() { br; (lines[1]) } }
}
