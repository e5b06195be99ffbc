//! Values over all lifetimes with their intervals, and comparisons of two agents.

use std::collections::BTreeMap;

use driftworld_metrics::{
    BootstrapOptions, ComparedMetric, Estimate, Improvement, Interval, LifetimeMetrics, MAX_P_VALUE, RepeatedMetric,
};
use driftworld_text::short;
use indexmap::IndexMap;
use maud::{Markup, html};

use super::pieces::{calm, count, number};
use super::verdict::{self, Verdict, pill};
use super::{metric_table, reached};
use crate::words::shown;

/// The comparison of an agent with another one.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The agent that may be better.
    pub agent: String,
    /// The agent that it is compared with.
    pub other: String,
    /// The comparison of each metric.
    pub metrics: Vec<ComparedMetric>,
    /// The other agent's lifetime, if there is only one.
    pub others_lifetime: Option<LifetimeMetrics>,
    /// Display names of tasks, keyed by their log names.
    pub names: BTreeMap<String, String>,
}

/// The values over all lifetimes and the comparisons, if there are any.
pub(super) fn section(overall: &[RepeatedMetric], comparisons: &[Comparison], intervals: &BootstrapOptions) -> Markup {
    let percent = format!("{} %", short(intervals.confidence * 100.0, 2));
    html! {
        @if !overall.is_empty() || !comparisons.is_empty() {
            section.part.only id="overall" aria-labelledby="overall-name" {
                h2 id="overall-name" { "Over all lifetimes" }
                (values(overall, &percent))
                @for comparison in comparisons { (improvement(comparison, &percent, intervals.confidence)) }
                @if !overall.is_empty() || comparisons.iter().any(is_tested) {
                    p.note { "Intervals: " (intervals.resamples) " resamples of " (intervals.resampling) ", seed " (intervals.seed) "." }
                }
            }
        }
    }
}

fn values(rows: &[RepeatedMetric], percent: &str) -> Markup {
    html! {
        @if !rows.is_empty() {
            p.note {
                "Interquartile mean: the mean of the middle half of the values of all tasks and lifetimes. In brackets: its "
                (percent) " bootstrap confidence interval."
            }
            div.scroll role="region" aria-label="Metrics over all lifetimes" tabindex="0" {
                table.stacked {
                    thead {
                        tr {
                            th scope="col" { "Metric" }
                            th.number scope="col" { "Interquartile" br; "mean" }
                            th.number scope="col" { "Mean" }
                            th scope="col" { "Reading" }
                            th.number scope="col" { "Lifetimes" }
                        }
                    }
                    tbody { @for row in rows { (value_row(row)) } }
                }
            }
            @if rows.iter().any(|row| row.iqm.t_interval.is_some()) {
                p.note {
                    "t: Student’s t interval over lifetimes, on which the reading is based. With fewer than ten lifetimes, bootstrap "
                    "intervals contain the true value less often than they claim. Student’s assumes normally distributed lifetimes."
                }
            }
            @if rows.iter().any(|row| row.null.is_some()) {
                p.note {
                    "Words like “helps” require an interval that excludes the neutral value and, for maintenance and transfer, a mean \
                     over lifetimes outside its null band, with p at most " (MAX_P_VALUE) ". Null band: as for one lifetime, \
                     over all lifetimes together."
                }
            }
            @for (caution, names) in cautions(rows) {
                p.note {
                    @if names.len() < rows.len() { (names.join(", ")) ": " }
                    (calm(caution)) "."
                }
            }
        }
    }
}

/// Each caution once, with the metrics that it concerns, in the order of the table.
fn cautions(rows: &[RepeatedMetric]) -> Vec<(&str, Vec<String>)> {
    let mut found: IndexMap<&str, Vec<String>> = IndexMap::new();
    for row in rows {
        if let Some(caution) = &row.caution {
            found
                .entry(caution)
                .or_default()
                .push(verdict::title(&row.headline.name));
        }
    }
    found.into_iter().collect()
}

fn value_row(row: &RepeatedMetric) -> Markup {
    let name = &row.headline.name;
    html! {
        tr {
            th scope="row" { (verdict::title(name)) }
            td.number data-name="Interquartile mean" { (estimate(row.iqm)) }
            td.number data-name="Mean" { (estimate(row.mean)) }
            td {
                @if let Some(reading) = row.reading { (pill(Verdict::of(reading, name))) } @else { (verdict::good_from(name, row.headline.good)) }
                @if row.null.is_some() { span.from { (metric_table::null_band(row.null)) } }
            }
            td.number data-name="Lifetimes" { (count(row.num_runs)) }
        }
    }
}

fn estimate(found: Estimate) -> Markup {
    html! {
        b { (number(found.value)) }
        @if let Some(Interval { low, high }) = found.interval { br; " [" (number(low)) ",\u{a0}" (number(high)) "]" }
        @if let Some(Interval { low, high }) = found.t_interval { br; " t\u{a0}[" (number(low)) ",\u{a0}" (number(high)) "]" }
    }
}

fn improvement(comparison: &Comparison, percent: &str, confidence: f64) -> Markup {
    let title = format!("{} against {}", shown(&comparison.agent), shown(&comparison.other));
    html! {
        h3 { (title) }
        @if !is_tested(comparison) {
            p.note {
                "Below each agent: its value. One lifetime of each does not show which agent is better: run several, with different seeds."
            }
        } @else { p.note {
            "Below each agent: the interquartile mean of its lifetimes. Probability of improvement: the probability that a lifetime of " bdi { (shown(&comparison.agent)) } " has the better value; 0.5 means that "
            "neither is better. In brackets: its " (percent) " bootstrap interval, and Student’s t interval for few lifetimes. p: how often two "
            "equal agents would differ at least this much, by permutation of their lifetimes. Agents count as different if p is at most "
            (short(1.0 - confidence, 2)) "."
        } }
        div.scroll role="region" aria-label=(title) tabindex="0" {
            table.stacked {
                thead {
                    tr {
                        th scope="col" { "Metric" }
                        th.number scope="col" { bdi { (shown(&comparison.agent)) } }
                        th.number scope="col" { bdi { (shown(&comparison.other)) } }
                        th.number scope="col" { "Probability" br; "of improvement" }
                        th.number scope="col" { "p" }
                        th scope="col" { "Reading" }
                    }
                }
                tbody {
                    @for row in &comparison.metrics {
                        tr {
                            th scope="row" { (verdict::title(&row.headline.name)) }
                            @for (agent, value) in [&comparison.agent, &comparison.other].into_iter().zip(row.values) {
                                td.number data-name=(shown(agent)) { (estimate(value)) }
                            }
                            td.number data-name="Probability of improvement" {
                                @if row.improvement.p_value.is_some() { (estimate(row.improvement.probability)) }
                            }
                            td.number data-name="p" { (row.improvement.p_value.map_or(String::new(), number)) }
                            td { (pill(better(&row.improvement, 1.0 - confidence))) }
                        }
                    }
                }
            }
        }
        @if let Some(lifetime) = &comparison.others_lifetime {
            (reached::section(&format!("Reached by {}", shown(&comparison.other)), lifetime, &comparison.names))
        }
    }
}

/// Whether there are enough lifetimes for a test.
fn is_tested(comparison: &Comparison) -> bool {
    comparison.metrics.iter().any(|row| row.improvement.p_value.is_some())
}

/// Whether two agents differ, at significance level `alpha`.
fn better(improvement: &Improvement, alpha: f64) -> Verdict {
    // Allows for the rounding error of 1 - 0.95.
    let alpha = alpha + 1e-12;
    let (class, sign, word) = match improvement.p_value {
        Some(p) if p <= alpha && improvement.probability.value > 0.5 => ("good", "▲", "better"),
        Some(p) if p <= alpha => ("bad", "▼", "worse"),
        Some(_) if improvement.least_p_value.is_some_and(|least| least <= alpha) => {
            ("even", "●", "no clear difference")
        }
        _ => ("even", "●", "too few lifetimes"),
    };
    Verdict { class, sign, word }
}
