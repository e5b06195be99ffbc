//! The performance reached in each task, at the top of a lifetime: before learning, at its best, and at the end.

use std::collections::BTreeMap;

use driftworld_metrics::{EvaluationCell, EvaluationCurve, LEARNED_SHARE, LifetimeMetrics, Reached};
use maud::{Markup, html};

use super::pieces::number;
use super::verdict::{Verdict, pill};
use crate::words::shown;

/// Maximum number of rows shown; the metrics files have all tasks.
const MAX_ROWS: usize = 200;

/// The section with this title. `display_names` maps a task's log name to its display name.
pub(super) fn section(title: &str, metrics: &LifetimeMetrics, display_names: &BTreeMap<String, String>) -> Markup {
    let tasks = || metrics.reached.iter().filter(|(_, task)| !task.evaluations.is_empty());
    let scaled = metrics.reached.values().any(Reached::is_scaled);
    html! {
        @if tasks().next().is_some() {
            h3 { (title) }
            @if metrics.nothing_was_learned() {
                ul.warnings aria-label="Nothing was learned" {
                    li { "⚠ Nothing was learned: no task is better after learning than before. Ignore the readings of \
                          maintenance and transfer." }
                }
            }
            div.scroll role="region" aria-label=(title) tabindex="0" {
                table.stacked {
                    thead {
                        tr {
                            th scope="col" { "Task" }
                            th.number scope="col" { "First evaluation" }
                            th.number scope="col" { "Best after learning" }
                            th.number scope="col" { "Last evaluation" }
                            th.number scope="col" { "Forgetting" }
                            th scope="col" { "Reading" }
                        }
                    }
                    tbody {
                        @for (name, task) in tasks().take(MAX_ROWS) {
                            tr {
                                th scope="row" { (shown(display_names.get(name).unwrap_or(name))) }
                                td.number data-name="First evaluation" { (level(task.evaluations.first())) }
                                td.number data-name="Best after learning" { (level(task.best())) }
                                td.number data-name="Last evaluation" { (level(task.last())) }
                                td.number data-name="Forgetting" { (forgetting(metrics.curves.get(name))) }
                                td { @if let Some(verdict) = verdict(task) { (pill(verdict)) } }
                            }
                        }
                    }
                }
            }
            (averages(metrics))
            p.note {
                @if scaled { "In % of the way from floor to ceiling where these are known, else in the log's unit" }
                @else { "In the log's unit" }
                "; ± the standard error over worlds. “never learned”: below " (format!("{:.0}", 100.0 * LEARNED_SHARE)) " % of the expert, \
                 or of the ceiling. If neither is known, “gained” means more than two standard errors from the first to the best."
            }
        }
    }
}

/// The averages over tasks that papers report; none if tasks have different units.
fn averages(metrics: &LifetimeMetrics) -> Markup {
    let curves = || metrics.curves.values();
    let num_scaled = curves().filter(|curve| curve.is_scaled).count();
    let is_scaled = num_scaled > 0;
    let mean = |value: fn(&EvaluationCurve) -> f64| curves().map(value).sum::<f64>() / metrics.curves.len() as f64;
    let last = mean(|curve| curve.points.last().map_or(f64::NAN, |point| point.mean));
    html! {
        @if !metrics.curves.is_empty() && [0, metrics.curves.len()].contains(&num_scaled) {
            p.note {
                strong { "Average performance at the end (ACC): " (amount(last, is_scaled)) "; average forgetting: "
                    (amount(mean(|curve| curve.forgetting), is_scaled)) ". " }
                "Forgetting: the best evaluation minus the last (Chaudhry et al. 2018)."
            }
        }
    }
}

/// The best evaluation of a task minus its last.
fn forgetting(curve: Option<&EvaluationCurve>) -> String {
    curve.map_or("–".to_owned(), |curve| amount(curve.forgetting, curve.is_scaled))
}

/// A performance as a share of the way from floor to ceiling, or in the log's unit.
fn amount(value: f64, is_scaled: bool) -> String {
    if is_scaled {
        return format!("{:.0}\u{a0}%", 100.0 * value).replace('-', "−");
    }
    number(value)
}

/// Whether a task was learned; `None` if it was not evaluated after learning.
fn verdict(task: &Reached) -> Option<Verdict> {
    let (class, sign, word) = match (task.is_never_learned(), task.has_gained()?) {
        (Some(true), _) => ("bad", "▼", "never learned"),
        (Some(false), _) => ("good", "▲", "learned"),
        (None, true) => ("good", "▲", "gained"),
        (None, false) => ("bad", "▼", "no clear gain"),
    };
    Some(Verdict { class, sign, word })
}

/// The mean of an evaluation, as a fraction of the range from floor to ceiling if these are known.
fn level(found: Option<&EvaluationCell>) -> String {
    let Some(found) = found else {
        return "–".to_owned();
    };
    if let Some(score) = found.score {
        return amount(score, true);
    }
    let mean = number(found.mean);
    match found.standard_error {
        Some(error) => format!("{mean} ±\u{a0}{}", number(error)),
        None => mean,
    }
}
