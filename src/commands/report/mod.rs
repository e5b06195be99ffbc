//! `driftworld report`: lifetimes on one page, and their figures as files. Scores are `metrics`', pages and figures `report`'s.

mod neighbours;

use std::path::{Path, PathBuf};

use crate::metrics::{LifetimeMetrics, Options, SmoothingMethod, compare_agents, over_repeats};
use crate::report::{Chapter, ChapterOptions, Comparison, Figure, FigureOptions, MAX_LIFETIMES, ReportError};
use clap::Args;
use driftworld_text::ShownPath;

use super::figures::{FigureChoice, Files, drawn};
use super::metrics::{Intervals, Lived, Yardstick, own_scale, score_logs};
use super::scoring::Scoring;
use super::{Failure, log_folders, output};
use neighbours::Neighbours;

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
        let (shown, figures) = (self.figures.shown()?, self.figures.options()?);
        let logs = log_folders::below(&self.logs)?;
        if logs.len() > MAX_LIFETIMES {
            let (found, limit) = (logs.len(), MAX_LIFETIMES);
            return Err(ReportError::TooManyLifetimes { found, limit }.into());
        }
        let Yardstick {
            options,
            experts,
            others,
        } = Yardstick::new(&logs, &self.against, &self.scoring, &self.intervals)?;
        let mut neighbours = Neighbours::new(self.distances.as_deref(), &self.tasks, options.variant_mode)?;
        let mut files = self.plots.as_deref().map(Files::new);
        let mut failures: Vec<String> = Vec::new();
        let mut chapters = Vec::new();
        let mut scores: Vec<LifetimeMetrics> = Vec::new();
        for (log, name) in logs.iter().zip(&log_folders::names(&logs)) {
            let name = (logs.len() > 1).then_some(name.as_str());
            let lived = match Lived::read(log, name, &experts, &options) {
                Ok(lived) => lived,
                Err(failure) => {
                    failures.push(failure.text().to_owned());
                    continue;
                }
            };
            let chapter = options_of(&lived, &mut neighbours, &figures, &shown, &options);
            chapters.push(Chapter::write(&lived.lifetime, &lived.metrics, &chapter)?);
            if let Some(files) = &mut files {
                files.write(&drawn(
                    &lived.lifetime,
                    &lived.metrics.metrics_column,
                    &chapter.shown,
                    &chapter.figures,
                )?)?;
            }
            scores.push(lived.metrics);
        }
        if !failures.is_empty() {
            return Err(Failure::input(failures.join("\n")));
        }
        let intervals = self.intervals.options();
        let mut comparisons = Vec::new();
        if !self.against.is_empty() {
            let others = score_logs(&others, &experts, &options)?;
            comparisons.push(Comparison {
                agent: called(&self.logs),
                other: called(&self.against),
                metrics: compare_agents(&scores, &others, &intervals)?,
            });
        }
        let overall = if scores.len() > 1 {
            over_repeats(&scores, &intervals)?
        } else {
            Vec::new()
        };
        let report = crate::report::Report {
            title: self.title.filter(|title| !title.trim().is_empty()),
            chapters,
            overall,
            intervals,
            comparisons,
            // One lifetime has one scale.
            warnings: own_scale(&options)
                .filter(|_| logs.len() > 1)
                .map(str::to_owned)
                .into_iter()
                .collect(),
            options: serde_json::to_value(&options)?,
            date: self.date,
        };
        let html = report.to_html()?;
        if self.output == Path::new("-") {
            return output::print(&html);
        }
        output::write(&self.output, html.as_bytes())?;
        let many = if logs.len() == 1 { "lifetime" } else { "lifetimes" };
        let (path, kilobytes) = (self.output.shown(), html.len().div_ceil(1000));
        output::line(format!("{path}: {} {many}, {kilobytes} kB", logs.len()))?;
        files.map_or(Ok(()), |files| output::line(files.told()))
    }
}

/// How the chapter of a lifetime is written.
fn options_of(
    lived: &Lived,
    neighbours: &mut Neighbours,
    figures: &FigureOptions,
    shown: &[Figure],
    options: &Options,
) -> ChapterOptions {
    let (distances, distance_note) = neighbours.of(&lived.log, &lived.lifetime);
    ChapterOptions {
        figures: FigureOptions {
            distances,
            ..figures.clone()
        },
        shown: shown.to_vec(),
        smoothed: options.smoothing_method != SmoothingMethod::Off,
        warnings: lived.warnings.clone(),
        distance_note,
    }
}

/// The page of one lifetime, with all figures.
pub(crate) fn page_of(title: &str, lived: &Lived, options: &Options) -> Result<String, Failure> {
    let mut neighbours = Neighbours::new(None, &[], options.variant_mode)?;
    let chapter = options_of(lived, &mut neighbours, &FigureOptions::default(), &Figure::ALL, options);
    let report = crate::report::Report {
        title: Some(title.to_owned()),
        chapters: vec![Chapter::write(&lived.lifetime, &lived.metrics, &chapter)?],
        options: serde_json::to_value(options)?,
        ..crate::report::Report::default()
    };
    Ok(report.to_html()?)
}

/// What the lifetimes under these folders are called together: by the folder, or the first of several.
fn called(folders: &[PathBuf]) -> String {
    let name = |path: &PathBuf| {
        let path = path.canonicalize().unwrap_or_else(|_| path.clone());
        path.file_name().map_or_else(
            || path.display().to_string(),
            |name| name.to_string_lossy().into_owned(),
        )
    };
    match folders {
        [] => String::new(),
        [only] => name(only),
        [first, rest @ ..] => format!("{} and {} more", name(first), rest.len()),
    }
}
