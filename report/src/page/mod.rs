//! Builds the report: one self-contained HTML page with a chapter per lifetime. The caller passes in the date and writes the
//! file.

mod chapter;
mod metric_table;
mod overall;
mod pair_table;
mod pieces;
mod reached;
mod task_table;
mod verdict;

use driftworld_metrics::{BootstrapOptions, RepeatedMetric};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde_json::Value;

pub use chapter::{Chapter, ChapterOptions};
pub use overall::Comparison;

use crate::ReportError;
use crate::figure::dark_rules;
use crate::words::shown;
use pieces::{calm, warnings};

/// Maximum number of lifetimes on one page.
pub const MAX_LIFETIMES: usize = 40;

/// Content security policy: even a tampered page loads nothing.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; form-action 'none'; base-uri 'none'";

const STYLE: &str = include_str!("style.css");

/// Everything on a page.
#[derive(Debug, Clone, Default)]
pub struct Report {
    /// The heading; by default the lifetime's name, or the number of lifetimes.
    pub title: Option<String>,
    /// One rendered chapter per lifetime.
    pub chapters: Vec<Chapter>,
    /// Metrics over all lifetimes; the section is left out if there are none.
    pub overall: Vec<RepeatedMetric>,
    /// How the intervals of `overall` and `comparisons` were bootstrapped.
    pub intervals: BootstrapOptions,
    /// Comparisons of two agents; the section is left out if there are none.
    pub comparisons: Vec<Comparison>,
    /// Warnings about the whole report; those about one lifetime are in its chapter.
    pub warnings: Vec<String>,
    /// The command that made the page; default none.
    pub command: Option<String>,
    /// The options used, as a JSON object, such as the result of `serde_json::to_value(&options)`.
    pub options: Value,
    /// The report's date as text; default none, so that the same lifetimes give the same bytes.
    pub date: Option<String>,
}

impl Report {
    /// The page as HTML: no scripts, nothing loaded from elsewhere.
    ///
    /// # Errors
    /// [`ReportError::TooManyLifetimes`] for more than [`MAX_LIFETIMES`].
    pub fn to_html(&self) -> Result<String, ReportError> {
        let (found, limit) = (self.chapters.len(), MAX_LIFETIMES);
        if found > limit {
            return Err(ReportError::TooManyLifetimes { found, limit });
        }
        let title = match (&self.title, &self.chapters[..]) {
            (Some(title), _) => shown(title),
            (None, [chapter]) => chapter.name.clone(),
            (None, chapters) => format!("{} lifetimes", chapters.len()),
        };
        let dark = dark_rules();
        let style = format!("{STYLE}@media screen and (prefers-color-scheme:dark){{{dark}}}");
        let page = html! {
            (DOCTYPE)
            html lang="en" {
                head {
                    meta charset="utf-8";
                    meta name="viewport" content="width=device-width, initial-scale=1";
                    meta http-equiv="Content-Security-Policy" content=(POLICY);
                    meta name="color-scheme" content="light dark";
                    meta name="generator" content=(concat!("driftworld ", env!("CARGO_PKG_VERSION")));
                    // Keeps browsers from requesting a favicon.
                    link rel="icon" href="data:,";
                    title { (title) " · lifelong-learning report" }
                    style { (PreEscaped(style)) }
                }
                body {
                    header.top {
                        p.kind { "Lifelong-learning report" }
                        h1 { (title) }
                        @if let Some(date) = &self.date { p.lead { (shown(date)) } }
                        (self.index())
                    }
                    main {
                        (warnings(&self.warnings))
                        (overall::section(&self.overall, &self.comparisons, &self.intervals))
                        @for (index, chapter) in self.chapters.iter().enumerate() { (self.life(index + 1, chapter)) }
                        (options_table(&self.options, self.command.as_deref()))
                    }
                    footer {
                        "Made by driftworld " (env!("CARGO_PKG_VERSION")) ". Definitions: New et al. 2022, "
                        i { "Lifelong Learning Metrics for L2M" }
                        ". This page is one file; it loads nothing and runs nothing."
                    }
                }
            }
        };
        Ok(page.into_string())
    }

    /// A lifetime's section. If it is the only one, its heading repeats the page's title and is for screen readers only.
    fn life(&self, number: usize, chapter: &Chapter) -> Markup {
        let alone = self.chapters.len() == 1;
        let (id, name) = (format!("life-{number}"), format!("life-{number}-name"));
        html! {
            section.life.only[alone && self.overall.is_empty() && self.comparisons.is_empty()] id=(id) aria-labelledby=(name) {
                h2.hidden[alone] id=(name) { (chapter.name) }
                (chapter.body)
            }
        }
    }

    /// Links to the lifetimes, if there are several.
    fn index(&self) -> Markup {
        html! {
            @if self.chapters.len() > 1 {
                nav aria-label="Lifetimes" {
                    ol {
                        @for (index, chapter) in self.chapters.iter().enumerate() {
                            li { a href=(format!("#life-{}", index + 1)) { (chapter.name) } }
                        }
                    }
                }
            }
        }
    }
}

/// The table of options, with notes on how the metrics were computed.
fn options_table(options: &Value, command: Option<&str>) -> Markup {
    let rows = options.as_object().into_iter().flatten();
    let is_used = |name: &str| options.get(name).is_none_or(|method| method != "none");
    let prepared = match (is_used("smoothing_method"), is_used("normalization_method")) {
        (true, true) => "Learning is smoothed, performances are scaled to 1…101, and each",
        (true, false) => "Learning is smoothed, performances stay in the log's unit, and each",
        (false, true) => "Performances are scaled to 1…101, and each",
        (false, false) => "Performances are used as logged: each",
    };
    html! {
        section.part id="how" aria-labelledby="how-name" {
            h2 id="how-name" { "How it was computed" }
            p {
                "Complete rows with a number in the scored column form " i { "regimes" } ": uninterrupted \
                 learning or evaluation of one task. "
                (prepared) " metric is computed per task and then aggregated over tasks. "
                "A value that cannot be computed is left out, never guessed."
            }
            div.card {
                table.options {
                    caption { span { "Options used" } }
                    tbody {
                        @for (name, value) in rows {
                            tr { th scope="row" { (calm(&name.replace('_', " "))) } td { (calm(&plain(value))) } }
                        }
                        @if let Some(command) = command { tr { th scope="row" { "command" } td { code { (driftworld_text::printable(&calm(command))) } } } }
                        tr { th scope="row" { "version" } td { "driftworld " (env!("CARGO_PKG_VERSION")) } }
                    }
                }
            }
        }
    }
}

/// An option's value as text.
fn plain(value: &Value) -> String {
    match value {
        Value::Null => "not given".to_owned(),
        Value::Bool(true) => "yes".to_owned(),
        Value::Bool(false) => "no".to_owned(),
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::pieces::{count, number};
    use super::*;

    #[test]
    fn numbers_in_tables_have_about_four_digits() {
        let check = |value: f64, expected: &str| assert_eq!(number(value), expected);
        check(12.629_855, "12.63");
        check(-2.0, "−2.000");
        check(-0.000_01, "0.000");
        check(0.0, "0.000");
        check(104.26, "104.3");
        check(123_456.7, "123457");
        check(1e9, "1.000e9");
        assert_eq!(
            [0, 999, 1000, 1_234_567].map(count),
            ["0", "999", "1\u{202f}000", "1\u{202f}234\u{202f}567"]
        );
    }

    #[test]
    fn more_lifetimes_than_a_page_can_show_are_refused() {
        let report = Report {
            chapters: vec![Chapter::default(); MAX_LIFETIMES + 1],
            ..Report::default()
        };
        assert_eq!(report.to_html().unwrap_err().code(), "report/too-many-lifetimes");
    }
}
