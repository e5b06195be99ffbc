//! Values over all lifetimes with their intervals, and comparisons of two agents. How they are estimated is told by the caller.

use maud::{Markup, html};

use super::{count, number, verdict};
use crate::words::shown;

/// One metric over all lifetimes.
#[derive(Debug, Clone, PartialEq)]
pub struct Overall {
    /// Name of the metric, as in the JSON.
    pub name: String,
    /// How it was brought together, such as "interquartile mean".
    pub estimate: String,
    /// Point estimate.
    pub value: f64,
    /// Lower end of its 95 % interval.
    pub low: f64,
    /// Upper end of its 95 % interval.
    pub high: f64,
    /// From how many lifetimes.
    pub runs: usize,
}

/// How likely one agent is to be better than another, in one metric.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Name of the metric, as in the JSON.
    pub name: String,
    /// The agent that may be better.
    pub agent: String,
    /// The one it is held against.
    pub other: String,
    /// Probability of improvement, 0..=1; 0.5 means that neither is better.
    pub probability: f64,
    /// Lower end of its 95 % interval.
    pub low: f64,
    /// Upper end of its 95 % interval.
    pub high: f64,
}

/// Both, where there are any.
pub(super) fn section(overall: &[Overall], comparisons: &[Comparison]) -> Markup {
    html! {
        @if !overall.is_empty() || !comparisons.is_empty() {
            section.part id="overall" aria-labelledby="overall-name" {
                h2 id="overall-name" { "Over all lifetimes" }
                (values(overall))
                (improvements(comparisons))
            }
        }
    }
}

fn values(rows: &[Overall]) -> Markup {
    html! {
        @if !rows.is_empty() {
            h3 { "Metrics with intervals" }
            div.scroll role="region" aria-label="Metrics over all lifetimes" tabindex="0" {
                table {
                    thead {
                        tr {
                            th scope="col" { "Metric" } th scope="col" { "Estimate" } th.number scope="col" { "Value" }
                            th.number scope="col" { "95 % interval" } th.number scope="col" { "Lifetimes" }
                        }
                    }
                    tbody {
                        @for row in rows {
                            tr {
                                th scope="row" { (verdict::title(&row.name)) }
                                td { (shown(&row.estimate)) }
                                td.number { b { (number(row.value)) } }
                                td.number { (number(row.low)) " to " (number(row.high)) }
                                td.number { (count(row.runs)) }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn improvements(rows: &[Comparison]) -> Markup {
    html! {
        @if !rows.is_empty() {
            h3 { "Probability of improvement" }
            p.note { "How likely a lifetime of the first agent has the higher value; 0.5 means that neither is better." }
            div.scroll role="region" aria-label="Probability of improvement" tabindex="0" {
                table {
                    thead {
                        tr {
                            th scope="col" { "Metric" } th scope="col" { "Agents" } th.number scope="col" { "Probability" }
                            th.number scope="col" { "95 % interval" } th scope="col" { "Reading" }
                        }
                    }
                    tbody {
                        @for row in rows {
                            tr {
                                th scope="row" { (verdict::title(&row.name)) }
                                td { (shown(&row.agent)) " over " (shown(&row.other)) }
                                td.number { b { (number(row.probability)) } }
                                td.number { (number(row.low)) " to " (number(row.high)) }
                                td { (reading(row)) }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// What an interval says that does, or does not, hold one half.
fn reading(row: &Comparison) -> Markup {
    let (class, sign, word) = match () {
        () if row.low > 0.5 => ("good", "▲", "better"),
        () if row.high < 0.5 => ("bad", "▼", "worse"),
        () => ("even", "●", "not told apart"),
    };
    html! { span class={ "verdict " (class) } { span aria-hidden="true" { (sign) " " } (word) } }
}
