//! The table of metrics: each value, its meaning, its reading, and its spread over tasks.

use std::collections::BTreeMap;

use driftworld_metrics::{
    Lifetime, LifetimeMetrics, MAX_P_VALUE, MIN_AGREEING_SHARE, NULL_PERMUTATIONS, NullBand, ScaledBy,
};
use driftworld_text::capitalized;
use maud::{Markup, html};

use super::pieces::{described, number};
use super::verdict::{self, Verdict};
use crate::ReportError;
use crate::figure::{strip, thinned_count};
use crate::words::{note_shown, shown};

pub(super) fn table(lifetime: &Lifetime, metrics: &LifetimeMetrics) -> Result<Markup, ReportError> {
    let scaled = lifetime.normalization_data_range().is_some();
    let mut reached = metrics.reached.values();
    let has_anchors = reached.any(|task| task.scaled_by == ScaledBy::Anchors);
    let mut rows = Vec::new();
    let mut missing = Vec::new();
    let summary = metrics.summary();
    let valued = summary.iter().filter(|row| row.value.is_some());
    let computed: Vec<&str> = valued.map(|row| &*row.name).collect();
    for row in &summary {
        let name: &str = &row.name;
        let Some(value) = row.value else {
            missing.push(verdict::title(name));
            continue;
        };
        let marks = per_task(lifetime, metrics, name);
        let drawing = strip(&marks, Some(value), row.good.neutral())?;
        rows.push(html! {
            tr {
                th scope="row" {
                    b { (verdict::title(name)) }
                    span.says { (capitalized(&row.explanation)) }
                    code { (shown(name)) }
                    @if let Some(words) = verdict::in_papers(name) { span.says { "In papers: " (words) } }
                }
                td.number { span.value { (number(value)) @if let Some(error) = standard_error(row.null_band) { span.from { "±\u{a0}" (error) } } } }
                td {
                    @if let Some(reading) = row.reading { (verdict::pill(Verdict::of(reading, name))) }
                    @if let Some(contrast) = contrast_of(name).filter(|contrast| computed.contains(contrast)) {
                        span.from { "read the " (verdict::title(contrast)) ": a mean of ratios is above 1 even if nothing is transferred" }
                    }
                    span.from { (verdict::good_from(name, row.good)) }
                    span.from { (null_band(row.null_band)) }
                }
                td.marks { @if !marks.is_empty() { (described(&drawing, None, &format!("{} of each task", verdict::title(name)))) @if let Some(count) = thinned_count(marks.len()) { span.from { (count) } } } }
            }
        });
    }
    Ok(html! {
        div.card {
            table.metrics {
                thead {
                    tr {
                        th scope="col" { "Metric" }
                        th.number scope="col" { "Value" }
                        th scope="col" { "Reading" }
                        th scope="col" { "Each task" }
                    }
                }
                tbody { @for row in &rows { (row) } }
            }
        }
        p.note {
            strong { "One lifetime shows what this agent did, not what agents like it would do. Several lifetimes can show that, with confidence intervals. " }
            (reading_rule())
        }
        @if !metrics.null_bands.is_empty() {
            p.note {
                "Null band: the central 95 % of values when the evaluation rows of each world are permuted across evaluations "
                (NULL_PERMUTATIONS) " times, as if the agent never changed. “no null”: this metric cannot be tested by permuting evaluations. ±: the standard error over worlds."
            }
        }
        @for note in metrics.notes.iter().chain(&metrics.cautions) { p.note { strong { "Note: " } (note_shown(note)) "." } }
        @if scaled {
            p.note {
                @if has_anchors { "Tasks with a floor and a ceiling are scaled by these to 1…101; others" }
                @else { "Tasks are scaled to 1…101, by default" }
                " by this lifetime’s own worst and best. Such values cannot be compared between lifetimes: a random agent may score "
                "above an expert. Compare the logged means above."
            }
        }
        p.note {
            "Coloured marks: one per task; for transfer, one per pair, in the colour of the learned task. Vertical line: the lifetime's value. Dashed line: the neutral value (no effect)."
            @if !missing.is_empty() { " Not computed: " (missing.join("; ")) "." }
        }
    })
}

/// The contrast that answers the same question better than a ratio.
fn contrast_of(name: &str) -> Option<&'static str> {
    match name {
        "forward_transfer_ratio" => Some("forward_transfer_contrast"),
        "backward_transfer_ratio" => Some("backward_transfer_contrast"),
        _ => None,
    }
}

/// The values to expect if the agent had never changed.
pub(super) fn null_band(band: Option<NullBand>) -> Markup {
    html! {
        @if let Some(band) = band {
            "null band " (number(band.low)) "\u{a0}to\u{a0}" (number(band.high)) ", p\u{a0}" (number(band.p))
        }
        @else { "no null" }
    }
}

/// The standard error of a value over worlds, if known.
fn standard_error(band: Option<NullBand>) -> Option<String> {
    Some(number(band?.standard_error?))
}

/// The sentence that explains how the words are chosen.
fn reading_rule() -> String {
    format!(
        "Words like “helps” require a value outside its null band, with p at most {MAX_P_VALUE}, that differs from the neutral value \
         by at least two standard errors, if these are known. “mixed” means that less than {:.0}\u{a0}% of the effects of tasks, or of \
         pairs, by size, are on the lifetime’s side of the neutral value; “not tested” means that there is no null band.",
        100.0 * MIN_AGREEING_SHARE
    )
}

/// A metric's values, each with the index of its task; for pairs, the first value of each, with the index of the learned task.
fn per_task(lifetime: &Lifetime, metrics: &LifetimeMetrics, name: &str) -> Vec<(usize, f64)> {
    let task_indices: BTreeMap<&str, usize> = lifetime.tasks().iter().map(String::as_str).zip(0..).collect();
    let parts = metrics.parts(name).into_iter();
    parts
        .filter_map(|part| Some((*task_indices.get(part.task)?, part.value)))
        .collect()
}
