//! The tables of transfer from each learned task to each other task, coloured like heat maps.

use std::collections::BTreeMap;

use driftworld_metrics::{LifetimeMetrics, SummaryRow};
use maud::{Markup, html};

use super::pieces::{breakable, number};
use super::verdict::{self, Verdict};
use crate::words::shown;

/// Maximum number of tasks in a table; the metrics files have all of them.
const MAX_TASKS: usize = 24;

/// A table for each pair metric that has values. `display_names` maps a task's log name to its display name.
pub(super) fn tables(metrics: &LifetimeMetrics, display_names: &BTreeMap<String, String>) -> Markup {
    let display_name = |task: &String| display_names.get(task).unwrap_or(task).clone();
    let summary = metrics.summary();
    let tasks = &metrics.task_metrics;
    let names: Vec<&String> = tasks.keys().take(MAX_TASKS).collect();
    let has = |name: &str| {
        tasks
            .keys()
            .any(|task| metrics.pairs(task, name).is_some_and(|pairs| !pairs.is_empty()))
    };
    let rows: Vec<&SummaryRow> = summary.iter().filter(|row| has(&row.name)).collect();
    // If all are variants of one task, the task is named once.
    let task_of = |name: &&String| display_name(name).split_once('#').map(|(task, _)| task.to_owned());
    let common = names.first().and_then(task_of);
    let common = common.filter(|task| names.iter().all(|name| task_of(name).as_ref() == Some(task)));
    let label = |name: &String| match (&common, display_name(name).split_once('#')) {
        (Some(_), Some((_, variant))) => shown(variant),
        _ => shown(&display_name(name)),
    };
    let first = |from: &str, to: &str, name: &str| metrics.pairs(from, name)?.get(to)?.first().copied();
    html! {
        @if !rows.is_empty() {
            h3 { "Transfer between tasks" }
            p.note {
                "Row: the task that was learned. Column: the task that was evaluated before and after. Values are from the first time each pair occurs. ▲ better, ▼ worse after the row's task was learned, ● no clear difference, or the lifetime shows no clear effect."
            }
        }
        @for row in &rows {
            div.scroll role="region" aria-label=(verdict::title(&row.name)) tabindex="0" {
                table.pairs {
                    caption { (verdict::title(&row.name)) @if let Some(task) = &common { " · variants of " (shown(task)) } }
                    thead {
                        tr {
                            th scope="col" { "learned ↓ evaluated →" }
                            @for name in &names { th scope="col" { (breakable(&label(name))) } }
                        }
                    }
                    tbody {
                        @for from in &names {
                            tr {
                                th scope="row" { (label(from)) }
                                @for to in &names { (cell(row, first(from, to, &row.name))) }
                            }
                        }
                    }
                }
            }
        }
        @if tasks.len() > MAX_TASKS && !rows.is_empty() {
            p.note { "The first " (MAX_TASKS) " tasks are shown; the metrics file has all of them." }
        }
    }
}

fn cell(row: &SummaryRow, value: Option<f64>) -> Markup {
    let Some(value) = value else {
        return html! { td.even { span aria-hidden="true" { "·" } } };
    };
    if row.good.neutral().is_none() {
        return html! { td { (number(value)) } };
    }
    let rows = Verdict::of(verdict::of_pair(value, row.good, row.reading), &row.name);
    html! {
        td.(rows.class) { (number(value)) " " span aria-hidden="true" { (rows.sign) } }
    }
}
