//! `driftworld report`: lifetimes on one page, and their figures as files. Pages are the library's.

use std::path::{Path, PathBuf};

use crate::Failure;
use crate::lifetime_report::{ReportRequest, write_report};
use crate::scoring::ScoringRequest;
use clap::Args;
use driftworld_text::ShownPath;

use super::figures::FigureChoice;
use super::output;
use super::scoring::{Intervals, Scoring};

/// Show lifetimes on one page: metrics, curriculum, curves.
///
/// The page is one HTML file that loads nothing and needs no network. Of several lifetimes each has a chapter, and together they
/// have intervals; with --against, two agents are compared.
///
/// The timeline says how far apart neighbouring learning blocks are: by the matrix that --distances names, or else, for
/// logs of `driftworld run`, as measured now from the scenario in the log: between variants of built-in tasks, and of
/// those that --task names.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld report demo-out/log -o report.html
  driftworld report LOG --ste EXPERT_LOGS --perf-measure performance --plots figures
  driftworld report logs --task tasks/mine.json -o report.html
  driftworld report runs/mine --against runs/theirs --distances distances.csv")]
pub(crate) struct Report {
    /// Folders of logs in l2logger's format, or folders of such folders.
    #[arg(required = true, value_name = "LOGS")]
    logs: Vec<PathBuf>,
    /// Folders of another agent's logs: how probably is a lifetime of the first better?
    #[arg(long, value_name = "DIR", num_args = 1..)]
    against: Vec<PathBuf>,
    /// The page to write; - for standard output.
    #[arg(short, long, value_name = "FILE", default_value = "report.html")]
    output: PathBuf,
    /// What stands on top of the page [default: the lifetime's name].
    #[arg(long, value_name = "WORDS")]
    title: Option<String>,
    /// When the report was made, to be written on it; left out, the same logs give the same bytes.
    #[arg(long, value_name = "WORDS")]
    date: Option<String>,
    /// A distance matrix, as `driftworld order --matrix` writes it: .csv, .json or .npy.
    #[arg(long, value_name = "FILE")]
    distances: Option<PathBuf>,
    /// A task spec that the logs name, for the distances between their blocks; may be given several times. Logs may
    /// name any file, so that only built-in tasks and these are looked at.
    #[arg(long = "task", value_name = "FILE")]
    tasks: Vec<PathBuf>,
    /// Write the figures into this folder too: `NAME_raw.png`, `NAME_raw.svg` and so on; NAME is the log's.
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
    #[command(flatten)]
    figures: FigureChoice,
    #[command(flatten)]
    scoring: Scoring,
    #[command(flatten)]
    intervals: Intervals,
}

impl Report {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let request = ReportRequest {
            figures: self.figures.shown()?,
            figure_options: self.figures.options()?,
            scoring: ScoringRequest {
                logs: self.logs,
                recursive: true,
                against: self.against,
                settings: self.scoring.settings()?,
                common_ranges: self.intervals.common_ranges,
                intervals: self.intervals.options(),
            },
            title: self.title,
            date: self.date,
            distances: self.distances,
            tasks: self.tasks,
            plots: self.plots,
        };
        let page = write_report(&request, &|text| output::warning(text))?;
        if self.output == Path::new("-") {
            return output::print(&page.html);
        }
        output::write(&self.output, page.html.as_bytes())?;
        let many = if page.num_lifetimes == 1 {
            "lifetime"
        } else {
            "lifetimes"
        };
        let (path, kilobytes) = (self.output.shown(), page.html.len().div_ceil(1000));
        output::line(format!("{path}: {} {many}, {kilobytes} kB", page.num_lifetimes))?;
        page.figures.map_or(Ok(()), output::line)
    }
}
