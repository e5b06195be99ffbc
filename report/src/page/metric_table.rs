//! The table of metrics: each value, what it says, whether that is good, and how the tasks differ in it.

use driftworld_metrics::{Lifetime, LifetimeMetrics, NULL_PERMUTATIONS, NullBand, SummaryRow};
use maud::{Markup, html};

use super::{described, number, verdict};
use crate::ReportError;
use crate::figure::{strip, thinned_count};
use crate::words::{note_shown, shown};

pub(super) fn table(lifetime: &Lifetime, metrics: &LifetimeMetrics) -> Result<Markup, ReportError> {
    let scaled = lifetime.normalization_data_range().is_some();
    let mut rows = Vec::new();
    let mut absent = Vec::new();
    for row in metrics.summary() {
        let name: &str = &row.name;
        let Some(value) = row.value else {
            absent.push(verdict::title(name));
            continue;
        };
        let marks = per_task(lifetime, metrics, name);
        let drawing = strip(&marks, Some(value), verdict::neutral(row.good))?;
        rows.push(html! {
            tr {
                th scope="row" {
                    b { (verdict::title(name)) }
                    span.says { (sentence(&row.explanation)) }
                    code { (shown(name)) }
                }
                td.number { span.value { (number(value)) } }
                td {
                    (judged(name, value, &marks, &row, scaled))
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
            strong { "One lifetime cannot distinguish an effect from noise in learning. Several can, by confidence intervals. " }
            (verdict::rule(scaled))
        }
        @if !metrics.null_bands.is_empty() {
            p.note {
                "Null band: the central 95 % of values when the evaluation rows of each world are permuted across evaluations "
                (NULL_PERMUTATIONS) " times, as if the agent never changed. No effect is named inside it. “no null”: decided by learning, too."
            }
        }
        @for note in metrics.notes.iter().chain(&metrics.cautions) { p.note { strong { "Note: " } (note_shown(note)) "." } }
        @if scaled {
            p.note {
                "Tasks are scaled to 1…101, by default by this lifetime’s own worst and best. Such values cannot be compared between lifetimes: a random agent may score "
                "above an expert. Compare the logged means above."
            }
        }
        p.note {
            "Coloured marks: each task, for transfer each pair in the colour of the task learnt. Vertical line: the lifetime's value. Dashes: no effect."
            @if !absent.is_empty() { " Not computed: " (absent.join("; ")) "." }
        }
    })
}

/// The explanation as a sentence.
fn sentence(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters
        .next()
        .map(|letter| letter.to_uppercase().to_string())
        .unwrap_or_default();
    first + letters.as_str()
}

/// Where the value would lie if the agent had never changed.
fn null_band(band: Option<NullBand>) -> Markup {
    html! {
        @if let Some(band) = band { "null band " (number(band.low)) " to " (number(band.high)) ", p " (number(band.p)) }
        @else { "no null" }
    }
}

fn judged(name: &str, value: f64, marks: &[(usize, f64)], row: &SummaryRow, scaled: bool) -> Markup {
    let tasks: Vec<f64> = marks.iter().map(|mark| mark.1).collect();
    let found = verdict::of_lifetime(name, value, &tasks, row.good, scaled);
    html! {
        @if let Some(found) = found.map(|found| verdict::beside_null(found, row.null_band, row.good)) {
            span class={ "verdict " (found.class) } { span aria-hidden="true" { (found.sign) " " } (found.word) }
        }
    }
}

/// The values of a metric for each task, by the task's place; of pairs, the first value of each, by the learnt task's place.
fn per_task(lifetime: &Lifetime, metrics: &LifetimeMetrics, name: &str) -> Vec<(usize, f64)> {
    let places = lifetime.tasks().iter().enumerate();
    let of_task = |(place, task): (usize, &String)| -> Vec<(usize, f64)> {
        let Some(values) = metrics.task_metrics.get(task) else {
            return Vec::new();
        };
        let firsts = (values.pairs(name).into_iter().flatten()).filter_map(|(_, values)| values.first().copied());
        firsts.chain(values.number(name)).map(|value| (place, value)).collect()
    };
    places.flat_map(of_task).collect()
}
