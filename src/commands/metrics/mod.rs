//! `driftworld metrics`: scores what agents retained and transferred, from the logs of their lifetimes.

mod power_table;
mod reached_table;
mod tables;

use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::Failure;
use crate::figure_files::{Files, drawn};
use crate::lifetime_report::FigureChoice;
use crate::log_names::called_in;
use crate::metrics::{SteStoreMode, store_ste};
use crate::report::FigureOptions;
use crate::scoring::{Intervals, Scores, ScoringRequest, ScoringSettings, score, score_looking};
use clap::Args;

use super::output;
use crate::variant_names::VariantNames;

/// Score the logs of lifetimes.
///
/// One lifetime gives a table of its metrics. Several count as repeated runs of one agent: each metric comes with its
/// interquartile mean over lifetimes and tasks, and a bootstrap confidence interval. --against compares two agents on
/// one scale.
///
/// Options and output files have the same names as in l2metrics.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld metrics demo-out/log
  driftworld metrics LOG --ste EXPERT_LOG --perf-measure performance --save results
  driftworld metrics -R runs/mine --against runs/theirs
  driftworld metrics -R runs/mine --power 10
  driftworld metrics EXPERT_LOG -s a --ste-data experts
  driftworld metrics LOG --ste-data experts")]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub(crate) struct Metrics {
    /// Folders of l2logger logs.
    #[arg(value_name = "DIR")]
    logs: Vec<PathBuf>,
    /// The same, under l2metrics' name.
    #[arg(short, long = "log-dir", value_name = "DIR", hide = true)]
    log_dir: Vec<PathBuf>,
    /// Search the folders for logs, up to four levels deep. Links are not followed.
    #[arg(short = 'R', long)]
    recursive: bool,
    /// Logs of a second agent. Reports how likely the first agent is to be better.
    #[arg(long, value_name = "DIR", num_args = 1..)]
    against: Vec<PathBuf>,
    /// Report how many lifetimes of each agent it takes to show a difference of this size, in each metric's own unit.
    ///
    /// With a power of 80 %, by Welch's t test at 5 %, given how much these lifetimes vary. Also reports the smallest
    /// difference that the given number of lifetimes can show.
    #[arg(long, value_name = "DELTA", allow_negative_numbers = true)]
    power: Option<f64>,
    /// Store the logs as experts in --ste-data, and score nothing.
    ///
    /// w replaces the experts of their tasks, a adds to them.
    #[arg(short = 's', long, value_name = "w|a", requires = "ste_data")]
    ste_store_mode: Option<SteStoreMode>,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    settings: ScoringSettings,
    #[command(flatten)]
    intervals: Intervals,
    /// Save the results in this folder.
    ///
    /// For one lifetime: `NAME_metrics.json`, `NAME_regime.tsv`, `NAME_settings.json`. For several, or with -R:
    /// `NAME.json`, `NAME.tsv`, `NAME_regime.tsv`, `NAME_settings.json`, and `NAME_repeats.json` with intervals and
    /// comparisons.
    #[arg(long, value_name = "DIR", conflicts_with = "output_dir", help_heading = "Saving")]
    save: Option<PathBuf>,
    /// Also draw figures as PNG and SVG, into this folder.
    #[arg(long, value_name = "DIR", help_heading = "Saving")]
    plots: Option<PathBuf>,
    /// Save the results in the folder results/.
    #[arg(short = 'S', long, help_heading = "Saving, as l2metrics spells it")]
    do_save: bool,
    /// The same as --save.
    #[arg(
        short = 'O',
        long,
        value_name = "DIR",
        help_heading = "Saving, as l2metrics spells it"
    )]
    output_dir: Option<PathBuf>,
    /// Save results under this name [default: the log's name, or `ll_metrics` for several logs].
    #[arg(short, long, value_name = "NAME", help_heading = "Saving, as l2metrics spells it")]
    output: Option<String>,
    /// Draw figures into plots/ in the folder of the results.
    #[arg(short = 'P', long, help_heading = "Saving, as l2metrics spells it")]
    do_plot: bool,
    /// l2metrics' option not to save. Nothing is saved by default.
    #[arg(long, hide = true, conflicts_with_all = ["save", "do_save", "output_dir", "output"])]
    no_save: bool,
    /// l2metrics' option not to plot. Nothing is plotted by default.
    #[arg(long, hide = true, conflicts_with_all = ["plots", "do_plot"])]
    no_plot: bool,
    #[command(flatten)]
    figures: FigureChoice,
}

impl Metrics {
    pub(crate) fn run(self) -> Result<(), Failure> {
        // Invalid options are refused even if nothing is drawn.
        let _ = (self.figures.shown()?, self.figures.options()?);
        let request = self.request();
        if let (Some(mode), Some(data)) = (self.ste_store_mode, &self.settings.expert_store) {
            return store(&request.folders()?, mode, data);
        }
        let scores = self.score(&request)?;
        if self.json {
            output::json(&scores)?;
        } else {
            let folders = [request.folders()?, request.against.clone()].concat();
            output::line(tables::scores(&scores, &VariantNames::of_logs(&folders)))?;
        }
        let saves = self.save.is_some() || self.output_dir.is_some() || self.output.is_some();
        if !self.do_save && !saves {
            return Ok(());
        }
        for file in scores.save(&self.folder(), self.output.as_deref())? {
            output::wrote(&file, "");
        }
        Ok(())
    }

    fn request(&self) -> ScoringRequest {
        ScoringRequest {
            logs: self.logs.iter().chain(&self.log_dir).cloned().collect(),
            recursive: self.recursive,
            against: self.against.clone(),
            power: self.power,
            settings: self.settings.clone(),
            intervals: self.intervals.clone(),
        }
    }

    /// Scores the logs; if requested, also draws and writes figures.
    fn score(&self, request: &ScoringRequest) -> Result<Scores, Failure> {
        if !self.do_plot && self.plots.is_none() {
            return score(request, &|text| output::warning(text));
        }
        let (shown, options) = (self.figures.shown()?, self.figures.options()?);
        let folder = self.plots.clone().unwrap_or_else(|| self.folder().join("plots"));
        let files = Mutex::new(Files::new(&folder));
        let scores = score_looking(request, &|text| output::warning(text), |log| {
            let options = FigureOptions {
                names: called_in(&log.log),
                ..options.clone()
            };
            let drawn = drawn(&log.lifetime, &log.metrics.metrics_column, &shown, &options)?;
            // A panic while holding the lock would already have ended the process.
            files.lock().unwrap_or_else(PoisonError::into_inner).write(&drawn)
        })?;
        let files = files.into_inner().unwrap_or_else(PoisonError::into_inner);
        output::wrote(&folder, files.what());
        Ok(scores)
    }

    /// The folder for results.
    fn folder(&self) -> PathBuf {
        let folder = self.save.as_ref().or(self.output_dir.as_ref());
        folder.cloned().unwrap_or_else(|| "results".into())
    }
}

/// Stores the logs in the folder.
///
/// If several logs of one task replace stored ones, the first replaces them and the others are added as further runs.
fn store(logs: &[PathBuf], mode: SteStoreMode, data: &Path) -> Result<(), Failure> {
    let mut replaced: Vec<String> = Vec::new();
    for log in logs {
        let task = crate::metrics::read_ste_log(log)?.task_name().to_owned();
        let mode = if replaced.contains(&task) {
            SteStoreMode::Append
        } else {
            mode
        };
        let stored = store_ste(data, log, mode)?;
        output::wrote(&stored.dir, format!("an expert of {}", stored.task_name));
        replaced.push(task);
    }
    Ok(())
}
