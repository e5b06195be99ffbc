//! `driftworld report`: writes a report on lifetimes as one page, and optionally their figures as files.

use std::path::PathBuf;
use std::sync::PoisonError;

use crate::Failure;
use crate::lifetime_report::{FigureChoice, ReportRequest, write_report};
use crate::scoring::{Intervals, ScoringRequest, ScoringSettings};
use clap::Args;
use driftworld_text::counted;

use super::output;

/// Write a report on lifetimes as one HTML page.
///
/// It shows metrics, the curriculum and learning curves.
///
/// The report is one HTML file. It loads nothing and needs no network. With several lifetimes, each has a chapter, and
/// their aggregates have confidence intervals. --against compares two agents.
///
/// The timeline shows the distance between neighbouring learning blocks. It comes from the matrix given by --distances.
/// Without one, it is measured from the scenario in the log, for variants of built-in tasks and of tasks given by
/// --task; for others it is what the run logged (column distance).
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld report demo-out/log -o report.html
  driftworld report LOG --ste EXPERT_LOGS --perf-measure performance --plots figures
  driftworld report logs --task tasks/mine.json -o report.html
  driftworld report runs/mine --against runs/theirs --distances distances.csv")]
pub(crate) struct Report {
    /// Folders of l2logger logs, or folders of such folders.
    #[arg(required = true, value_name = "LOGS")]
    logs: Vec<PathBuf>,
    /// Logs of a second agent. Reports how likely the first agent is to be better.
    #[arg(long, value_name = "DIR", num_args = 1..)]
    against: Vec<PathBuf>,
    /// The HTML file to write, or - for standard output.
    #[arg(short, long, value_name = "FILE", default_value = "report.html")]
    output: PathBuf,
    /// Print what was written as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    request: ReportRequest,
    #[command(flatten)]
    figures: FigureChoice,
    #[command(flatten)]
    settings: ScoringSettings,
    #[command(flatten)]
    intervals: Intervals,
}

impl Report {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let request = ReportRequest {
            figures: self.figures,
            scoring: ScoringRequest {
                logs: self.logs,
                recursive: true,
                against: self.against,
                power: None,
                settings: self.settings,
                intervals: self.intervals,
            },
            command: Some(command_line()),
            ..self.request
        };
        let page = write_report(&request, &|text| output::warning(text))?;
        if output::is_stdout(&self.output) {
            output::carries_data();
            return output::print(&page.html);
        }
        output::write(&self.output, page.html.as_bytes())?;
        let kilobytes = page.html.len().div_ceil(1000);
        output::wrote(
            &self.output,
            format!("{}, {kilobytes} kB", counted(page.num_lifetimes, "lifetime")),
        );
        if let (Some(folder), Some(figures)) = (&request.plots, page.figures) {
            output::wrote(folder, figures);
        }
        output::json_of_what_was_written(self.json)
    }
}

/// The command line, quoted for a shell.
fn command_line() -> String {
    let plain = |word: &str| {
        word.bytes()
            .all(|byte| byte.is_ascii_alphanumeric() || b"-_./=:,#@%+".contains(&byte))
    };
    let word = |word: std::ffi::OsString| {
        let word = word.to_string_lossy().into_owned();
        let is_plain = !word.is_empty() && plain(&word);
        if is_plain {
            word
        } else {
            format!("'{}'", word.replace('\'', "'\\''"))
        }
    };
    let mut words = vec!["driftworld".to_owned()];
    let given = super::WORDS.lock().unwrap_or_else(PoisonError::into_inner).clone();
    let mut given = given.into_iter().skip(1);
    while let Some(next) = given.next() {
        // The paths of the page and the figures do not affect the contents.
        let shown = next.to_string_lossy();
        if ["-o", "--output", "--plots"].iter().any(|option| shown == *option) {
            given.next();
        } else if !["-o", "--output=", "--plots="]
            .iter()
            .any(|start| shown.starts_with(start))
        {
            words.push(word(next));
        }
    }
    words.join(" ")
}
