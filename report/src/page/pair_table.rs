//! The tables of transfer: from each task that was learnt to each other one, coloured like a map of heat.

use driftworld_metrics::LifetimeMetrics;
use maud::{Markup, html};
use serde_json::Value;

use super::{number, verdict};
use crate::words::shown;

/// Tasks beyond these are in the files of metrics only.
const MOST_TASKS: usize = 24;

/// A table for each metric of pairs that has any. `tasks`: the field `task_metrics` of the metrics' JSON.
pub(super) fn tables(metrics: &LifetimeMetrics, tasks: &Value) -> Markup {
    let summary = metrics.summary();
    let names: Vec<&String> = tasks.as_object().into_iter().flatten().map(|(name, _)| name).take(MOST_TASKS).collect();
    let has = |metric: &str| names.iter().any(|task| tasks[task.as_str()][metric].as_object().is_some_and(|pairs| !pairs.is_empty()));
    let found: Vec<_> = summary.iter().filter(|row| has(row.name)).collect();
    html! {
        @if !found.is_empty() {
            h3 { "Transfer between tasks" }
            p.note {
                "Row: the task that was learnt. Column: the task that was evaluated before and after. The first time each pair occurs; ▲ helps, ▼ interferes."
            }
        }
        @for row in &found {
            div.scroll role="region" aria-label=(verdict::title(row.name)) tabindex="0" {
                table.pairs {
                    caption { (verdict::title(row.name)) }
                    thead {
                        tr {
                            th scope="col" { "learnt ↓ evaluated →" }
                            @for name in &names { th scope="col" { (shown(name)) } }
                        }
                    }
                    tbody {
                        @for from in &names {
                            tr {
                                th scope="row" { (shown(from)) }
                                @for to in &names { (cell(row, &tasks[from.as_str()][row.name][to.as_str()][0])) }
                            }
                        }
                    }
                }
            }
        }
        @if tasks.as_object().is_some_and(|all| all.len() > MOST_TASKS) && !found.is_empty() {
            p.note { "The first " (MOST_TASKS) " tasks are shown; all are in the file of metrics." }
        }
    }
}

fn cell(row: &driftworld_metrics::SummaryRow, value: &Value) -> Markup {
    let Some(value) = value.as_f64() else {
        return html! { td.even { span aria-hidden="true" { "·" } } };
    };
    match verdict::of(row.name, value, row.good) {
        Some(found) => html! {
            td class=(found.class) { (number(value)) " " span aria-hidden="true" { (found.sign) } }
        },
        None => html! { td { (number(value)) } },
    }
}
