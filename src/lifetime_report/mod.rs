//! [`write_report`]: lifetimes on one HTML page, with the distances between their blocks.

mod failed;
mod figures;
mod neighbours;

use std::collections::BTreeMap;
use std::path::PathBuf;

use clap::Args;
use driftworld_metrics::{LifetimeMetrics, Log, Options, SmoothingMethod, compare_agents, over_repeats};
use driftworld_report::{
    Chapter, ChapterOptions, Comparison, Figure, FigureOptions, MAX_LIFETIMES, Report, ReportError,
};
use serde::Deserialize;

pub use figures::FigureChoice;

use crate::figure_files::{Files, drawn};
use crate::log_names::called_in;
use crate::scoring::{ScoredLog, ScoringRequest, Setup, own_scale, score_logs};
use crate::{Failure, Warn, log_folders};
use neighbours::Neighbours;

/// The lifetimes on a page, and how they are shown: arguments of `driftworld report` and of Python's `report`.
#[derive(Args, Clone, Debug, Default, Deserialize)]
#[group(skip)]
#[serde(default, deny_unknown_fields)]
pub struct ReportRequest {
    /// The logs, in the given folders or below them, with the scoring options; `recursive` is ignored.
    #[arg(skip)]
    #[serde(skip)]
    pub scoring: ScoringRequest,
    /// Which figures are shown, and how.
    #[arg(skip)]
    #[serde(skip)]
    pub figures: FigureChoice,
    /// Title of the report [default: the lifetime's name].
    #[arg(long, value_name = "WORDS")]
    pub title: Option<String>,
    /// Date to print on the report.
    ///
    /// Without it, the same logs always give the same bytes.
    #[arg(long, value_name = "WORDS")]
    pub date: Option<String>,
    /// A distance matrix from `driftworld order --matrix`: .csv or .json.
    #[arg(long, value_name = "FILE")]
    pub distances: Option<PathBuf>,
    /// A task spec to measure distances with. Repeatable.
    ///
    /// Logs may name any file, so only built-in tasks and these specs are read.
    #[arg(long = "task", value_name = "FILE")]
    pub tasks: Vec<PathBuf>,
    /// The address of a workbench, as `driftworld studio` prints it, to link to worlds in which the last evaluation failed.
    #[arg(long, value_name = "URL")]
    pub studio: Option<String>,
    /// Also write the figures into this folder, as `NAME_raw.png`, `NAME_raw.svg` and so on.
    ///
    /// NAME is the name of the log.
    #[arg(long, value_name = "DIR")]
    pub plots: Option<PathBuf>,
    /// The command line to show on the page.
    #[arg(skip)]
    #[serde(skip)]
    pub command: Option<String>,
}

impl ReportRequest {
    /// The request for a full page on the logs in or below these folders.
    pub fn of<P: Into<PathBuf>>(logs: impl IntoIterator<Item = P>) -> Self {
        Self {
            scoring: ScoringRequest::of(logs),
            ..Self::default()
        }
    }
}

/// A finished page.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Page {
    /// Self-contained HTML.
    pub html: String,
    /// Number of lifetimes on it.
    pub num_lifetimes: usize,
    /// Describes the figures written beside it; `None` if none were requested.
    pub figures: Option<String>,
}

/// Writes the page of lifetimes. `warn` receives warnings for each log.
///
/// # Errors
/// [`Failure`] if a log cannot be read or scored (the failure names every such log), or a figure cannot be written.
pub fn write_report(request: &ReportRequest, warn: Warn<'_>) -> Result<Page, Failure> {
    let asked = &request.scoring;
    let (intervals, figures) = (
        asked.intervals.options(),
        (request.figures.shown()?, request.figures.options()?),
    );
    let logs = log_folders::below(&asked.logs)?;
    if logs.len() > MAX_LIFETIMES {
        let (found, limit) = (logs.len(), MAX_LIFETIMES);
        return Err(ReportError::TooManyLifetimes { found, limit }.into());
    }
    request.studio.as_deref().map_or(Ok(()), failed::check_address)?;
    let setup = Setup::new(logs, asked, warn)?;
    let Setup {
        logs,
        options,
        experts,
        others,
    } = &setup;
    let mut neighbours = Neighbours::new(request.distances.as_deref(), &request.tasks, options.variant_mode)?;
    let mut files = request.plots.as_deref().map(Files::new);
    let mut failures = Vec::new();
    let mut chapters = Vec::new();
    let mut scores: Vec<LifetimeMetrics> = Vec::new();
    let mut names = BTreeMap::new();
    for (log, name) in logs.iter().zip(&log_folders::names(logs)) {
        let name = (logs.len() > 1).then_some(name.as_str());
        let log = match ScoredLog::read(log, name, experts, options, warn) {
            Ok(log) => log,
            Err(failure) => {
                failures.push(failure);
                continue;
            }
        };
        let chapter = chapter_options(&log, &mut neighbours, request, options, &figures);
        names.extend(chapter.figures.names.clone());
        chapters.push(Chapter::write(&log.lifetime, &log.metrics, &chapter)?);
        if let Some(files) = &mut files {
            let column = &log.metrics.metrics_column;
            files.write(&drawn(&log.lifetime, column, &chapter.shown, &chapter.figures)?)?;
        }
        scores.push(log.metrics);
    }
    if !failures.is_empty() {
        return Err(Failure::of_several(&failures.iter().collect::<Vec<_>>()));
    }
    let mut comparisons = Vec::new();
    if !asked.against.is_empty() {
        let others = score_logs(others, experts, options, warn)?;
        let num_others = others.len();
        comparisons.push(Comparison {
            agent: called(&asked.logs),
            other: called(&asked.against),
            metrics: compare_agents(&scores, &others, &intervals)?,
            others_lifetime: others.into_iter().next().filter(|_| num_others == 1),
            names,
        });
    }
    let overall = if scores.len() > 1 {
        over_repeats(&scores, &intervals)?
    } else {
        Vec::new()
    };
    let report = Report {
        title: request.title.clone().filter(|title| !title.trim().is_empty()),
        chapters,
        overall,
        intervals,
        comparisons,
        // A single lifetime has only one scale.
        warnings: own_scale(options).filter(|_| logs.len() > 1).into_iter().collect(),
        options: serde_json::to_value(options)?,
        command: request.command.clone(),
        date: request.date.clone(),
    };
    Ok(Page {
        html: report.to_html()?,
        num_lifetimes: logs.len(),
        figures: files.map(|files| files.what()),
    })
}

/// How the chapter of a lifetime is written.
fn chapter_options(
    log: &ScoredLog,
    neighbours: &mut Neighbours,
    request: &ReportRequest,
    options: &Options,
    (shown, drawn): &(Vec<Figure>, FigureOptions),
) -> ChapterOptions {
    let (distances, distance_note) = neighbours.of(&log.log, &log.lifetime);
    ChapterOptions {
        figures: FigureOptions {
            distances,
            names: called_in(&log.log),
            ..drawn.clone()
        },
        shown: shown.clone(),
        smoothed: options.smoothing_method != SmoothingMethod::Off,
        facts: facts(&log.log),
        worlds: neighbours.worlds_of(&log.log),
        failed: request
            .studio
            .iter()
            .flat_map(|studio| failed::links(&log.log, studio))
            .collect(),
        warnings: log.warnings.clone(),
        distance_note,
    }
}

/// A log's information on its agent and its scenario.
fn facts(log: &Log) -> Vec<(String, String)> {
    let extra = &log.scenario_info.extra;
    let word = |place: &str, key: &str| extra.get(place)?.get(key)?.as_str();
    let found = [
        ("agent", extra.get("agent").and_then(serde_json::Value::as_str)),
        ("policy", word("made_from", "policy")),
        ("scenario", word("scenario", "name")),
    ];
    let said = found
        .into_iter()
        .filter_map(|(name, value)| Some((name.to_owned(), value?.to_owned())));
    said.collect()
}

/// A common name for the lifetimes under these folders: the folder's name, or the first name and the number of others.
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
