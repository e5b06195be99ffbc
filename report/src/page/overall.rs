//! Values over all lifetimes with their intervals, and comparisons of two agents. They are estimated elsewhere, by `driftworld_metrics`.

use driftworld_metrics::{BootstrapOptions, ComparedMetric, Estimate, Interval, RepeatedMetric};
use indexmap::IndexMap;
use maud::{Markup, html};

use super::verdict::{self, Verdict};
use super::{calm, count, number};
use crate::words::shown;

/// How likely one agent is to be better than another.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// The agent that may be better.
    pub agent: String,
    /// The one it is held against.
    pub other: String,
    /// Metric by metric.
    pub metrics: Vec<ComparedMetric>,
}

/// Both, where there are any.
pub(super) fn section(overall: &[RepeatedMetric], comparisons: &[Comparison], intervals: &BootstrapOptions) -> Markup {
    let percent = format!("{} %", number_plain(intervals.confidence * 100.0));
    html! {
        @if !overall.is_empty() || !comparisons.is_empty() {
            section.part.only id="overall" aria-labelledby="overall-name" {
                h2 id="overall-name" { "Over all lifetimes" }
                (values(overall, &percent))
                @for comparison in comparisons { (improvement(comparison, &percent)) }
                p.note { "Intervals: " (intervals.resamples) " resamples of " (intervals.resampling) ", seed " (intervals.seed) "." }
            }
        }
    }
}

fn values(rows: &[RepeatedMetric], percent: &str) -> Markup {
    html! {
        @if !rows.is_empty() {
            p.note {
                "Interquartile mean: the mean of the middle half of all values, task by task and lifetime by lifetime. In brackets, its "
                (percent) " bootstrap interval: what other repeats of the same experiment may well have shown."
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
            @for (caution, names) in cautions(rows) {
                p.note {
                    @if names.len() < rows.len() { (names.join(", ")) ": " }
                    (calm(caution)) "."
                }
            }
        }
    }
}

/// Each caution once, with the metrics it is about, in the order of the table.
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
    let judged = row
        .iqm
        .interval
        .and_then(|interval| verdict::of_interval(name, interval, row.headline.good));
    html! {
        tr {
            th scope="row" { (verdict::title(name)) }
            td.number data-name="Interquartile mean" { (estimate(row.iqm)) }
            td.number data-name="Mean" { (estimate(row.mean)) }
            td {
                @if let Some(judged) = judged { (pill(judged)) } @else { (verdict::good_from(name, row.headline.good)) }
            }
            td.number data-name="Lifetimes" { (count(row.num_runs)) }
        }
    }
}

fn estimate(found: Estimate) -> Markup {
    html! {
        b { (number(found.value)) }
        @if let Some(Interval { low, high }) = found.interval { br; " [" (number(low)) ", " (number(high)) "]" }
    }
}

fn improvement(comparison: &Comparison, percent: &str) -> Markup {
    let title = format!("{} against {}", shown(&comparison.agent), shown(&comparison.other));
    html! {
        h3 { (title) }
        p.note {
            "Probability of improvement: how likely a lifetime of " (shown(&comparison.agent)) " has the better value; 0.5 means that "
            "neither is better. In brackets, its " (percent) " bootstrap interval."
        }
        div.scroll role="region" aria-label=(title) tabindex="0" {
            table.stacked {
                thead {
                    tr {
                        th scope="col" { "Metric" }
                        th.number scope="col" { "Probability" br; "of improvement" }
                        th scope="col" { "Reading" }
                    }
                }
                tbody {
                    @for row in &comparison.metrics {
                        tr {
                            th scope="row" { (verdict::title(&row.headline.name)) }
                            td.number data-name="Probability of improvement" { (estimate(row.improvement.probability)) }
                            td { @if let Some(interval) = row.improvement.probability.interval { (pill(better(interval))) } }
                        }
                    }
                }
            }
        }
    }
}

/// A share of a hundred without needless digits.
fn number_plain(value: f64) -> String {
    let text = format!("{value:.2}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

/// What an interval says that does, or does not, hold one half.
fn better(interval: Interval) -> Verdict {
    let (class, sign, word) = match () {
        () if interval.low > 0.5 => ("good", "▲", "better"),
        () if interval.high < 0.5 => ("bad", "▼", "worse"),
        () => ("even", "●", "not told apart"),
    };
    Verdict { class, sign, word }
}

fn pill(verdict: Verdict) -> Markup {
    html! { span class={ "verdict " (verdict.class) } { span aria-hidden="true" { (verdict.sign) " " } (verdict.word) } }
}
