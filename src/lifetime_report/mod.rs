//! [`write_report`]: lifetimes on one HTML page, with the distances between their blocks.

mod failed;
mod neighbours;

use std::collections::BTreeMap;
use std::path::PathBuf;

use driftworld_metrics::{LifetimeMetrics, Log, Options, SmoothingMethod, compare_agents, over_repeats};
use driftworld_report::{
    Chapter, ChapterOptions, Comparison, Figure, FigureOptions, MAX_LIFETIMES, Report, ReportError,
};

use crate::figure_files::{Files, drawn};
use crate::log_names::called_in;
use crate::scoring::{ScoredLog, ScoringRequest, Setup, own_scale, score_logs};
use crate::{Failure, Warn, log_folders};
use neighbours::Neighbours;

/// The lifetimes on a page, and how they are shown.
#[derive(Clone, Debug, Default)]
pub struct ReportRequest {
    /// The logs, in the given folders or below them, with the scoring options; `recursive` is ignored.
    pub scoring: ScoringRequest,
    /// The page's heading; by default the lifetime's name.
    pub title: Option<String>,
    /// The date shown on the report; without one, the same logs give the same bytes.
    pub date: Option<String>,
    /// A distance matrix file for the distances between blocks; by default they are measured from the scenario in the log.
    pub distances: Option<PathBuf>,
    /// Task specs that the logs name. Logs may name any file, so only built-in tasks and these are read.
    pub tasks: Vec<PathBuf>,
    /// Which figures are shown.
    pub figures: Vec<Figure>,
    /// How they are drawn.
    pub figure_options: FigureOptions,
    /// A folder that the figures are also written to.
    pub plots: Option<PathBuf>,
    /// The address of a workbench; the page links to the worlds in which the last evaluation failed.
    pub studio: Option<String>,
    /// The command line to show on the page.
    pub command: Option<String>,
}

impl ReportRequest {
    /// The request for a full page on the logs in or below these folders.
    pub fn of<P: Into<PathBuf>>(logs: impl IntoIterator<Item = P>) -> Self {
        Self {
            scoring: ScoringRequest::of(logs),
            figures: Figure::ALL.to_vec(),
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
    let logs = log_folders::below(&asked.logs)?;
    if logs.len() > MAX_LIFETIMES {
        let (found, limit) = (logs.len(), MAX_LIFETIMES);
        return Err(ReportError::TooManyLifetimes { found, limit }.into());
    }
    request.studio.as_deref().map_or(Ok(()), failed::check_address)?;
    let setup = Setup::new(logs, asked)?;
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
        let chapter = chapter_options(&log, &mut neighbours, request, options);
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
            metrics: compare_agents(&scores, &others, &asked.intervals)?,
            others_lifetime: others.into_iter().next().filter(|_| num_others == 1),
            names,
        });
    }
    let overall = if scores.len() > 1 {
        over_repeats(&scores, &asked.intervals)?
    } else {
        Vec::new()
    };
    let report = Report {
        title: request.title.clone().filter(|title| !title.trim().is_empty()),
        chapters,
        overall,
        intervals: asked.intervals,
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
) -> ChapterOptions {
    let (distances, distance_note) = neighbours.of(&log.log, &log.lifetime);
    ChapterOptions {
        figures: FigureOptions {
            distances,
            names: called_in(&log.log),
            ..request.figure_options.clone()
        },
        shown: request.figures.clone(),
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
