//! `driftworld metrics`: what agents kept and transferred, from the logs of their lifetimes. The metrics are the library's.

mod lived;
mod many;
mod store;
mod tables;
mod yardstick;

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use crate::metrics::{BootstrapOptions, LifetimeMetrics, Options, Settings, SteStoreMode, save_all};
use clap::Args;
use driftworld_text::ShownPath;

pub(crate) use lived::{Lived, score_logs};
pub(crate) use tables::{own_scale, summary};
pub(crate) use yardstick::Yardstick;

use lived::each_lived;

use super::figures::{FigureChoice, Files, drawn};
use super::scoring::{Experts, Scoring};
use super::{Failure, log_folders, output};

/// What several lifetimes are called together, as in l2metrics.
const NAME_OF_MANY: &str = "ll_metrics";

/// Score the logs of lifetimes.
///
/// One lifetime gives a table of its metrics. Several are taken as repeats by one agent: each metric comes with its interquartile
/// mean over lifetimes and tasks and a bootstrap interval. With --against, two agents are compared, on one scale.
///
/// Options have the names they have in l2metrics, and the files are the ones it writes.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld metrics demo-out/log
  driftworld metrics LOG --ste EXPERT_LOG --perf-measure performance -O results
  driftworld metrics -R runs/mine --against runs/theirs
  driftworld metrics EXPERT_LOG -s a --ste-data experts
  driftworld metrics LOG --ste-data experts")]
#[expect(clippy::struct_excessive_bools, reason = "each is a flag of the command line")]
pub(crate) struct Metrics {
    /// Folders of logs in l2logger's format.
    #[arg(value_name = "DIR")]
    logs: Vec<PathBuf>,
    /// The same, as l2metrics has it.
    #[arg(short, long = "log-dir", value_name = "DIR", hide = true)]
    log_dir: Vec<PathBuf>,
    /// Take all logs in the folders, also up to four levels below; links are not looked into.
    #[arg(short = 'R', long)]
    recursive: bool,
    /// Folders of another agent's logs: how probably is a lifetime of the first better?
    #[arg(long, value_name = "DIR", num_args = 1..)]
    against: Vec<PathBuf>,
    /// Keep the logs as experts in the folder --ste-data, in place of those of their tasks (w) or beside them (a), and score nothing.
    #[arg(short = 's', long, value_name = "w|a", requires = "ste_data")]
    ste_store_mode: Option<SteStoreMode>,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    scoring: Scoring,
    #[command(flatten)]
    intervals: Intervals,
    /// Save results: `NAME_metrics.json`, `NAME_regime.tsv`, `NAME_settings.json`; of several lifetimes or with -R `NAME.json`,
    /// `NAME.tsv`, `NAME_regime.tsv`, `NAME_settings.json`, and `NAME_repeats.json` with intervals and comparisons.
    #[arg(short = 'S', long, help_heading = "Saving")]
    do_save: bool,
    /// Save results in this folder [default: results].
    #[arg(short = 'O', long, value_name = "DIR", help_heading = "Saving")]
    output_dir: Option<PathBuf>,
    /// Save results under this NAME [default: the log's; of several `ll_metrics`].
    #[arg(short, long, value_name = "NAME", help_heading = "Saving")]
    output: Option<String>,
    /// Draw figures, too, as PNG and SVG into the folder plots/ below --output-dir.
    #[arg(short = 'P', long, help_heading = "Saving")]
    do_plot: bool,
    /// What l2metrics' users say to keep it from writing, which this command does not do by itself.
    #[arg(long, hide = true, conflicts_with_all = ["do_save", "output_dir", "output"])]
    no_save: bool,
    /// The same of figures.
    #[arg(long, hide = true, conflicts_with = "do_plot")]
    no_plot: bool,
    #[command(flatten)]
    figures: FigureChoice,
}

/// How several lifetimes are put together, and how sure their numbers are.
#[derive(Args)]
#[command(next_help_heading = "Several lifetimes")]
pub(crate) struct Intervals {
    /// Scale each task by its range over all lifetimes, not each lifetime by its own; so it is with --against anyway.
    #[arg(long)]
    pub(crate) common_ranges: bool,
    /// How much of the bootstrap's distribution an interval holds.
    #[arg(long, value_name = "SHARE", default_value_t = BootstrapOptions::default().confidence)]
    confidence: f64,
    /// How many times lifetimes are drawn again; take 50000 for a figure to publish.
    #[arg(long, value_name = "N", default_value_t = BootstrapOptions::default().resamples)]
    resamples: u32,
    /// What is drawn again: runs (whole lifetimes) or strata (within each task, as rliable, as if a lifetime's tasks shared no luck).
    #[arg(long, value_name = "WHAT", default_value_t = BootstrapOptions::default().resampling)]
    resampling: crate::metrics::Resampling,
    /// What the draws come from.
    #[arg(long, value_name = "N", default_value_t = 0)]
    bootstrap_seed: u64,
}

impl Intervals {
    pub(crate) fn options(&self) -> BootstrapOptions {
        BootstrapOptions {
            confidence: self.confidence,
            resamples: self.resamples,
            resampling: self.resampling,
            seed: self.bootstrap_seed,
        }
    }
}

impl Metrics {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let logs = self.logs()?;
        if let (Some(mode), Some(data)) = (self.ste_store_mode, self.scoring.ste_data()) {
            return store::store(&logs, mode, data);
        }
        let Yardstick {
            options,
            experts,
            others,
        } = Yardstick::new(&logs, &self.against, &self.scoring, &self.intervals)?;
        let lifetimes = self.scored(&logs, &experts, &options)?;
        let mut repeats = None;
        match lifetimes.as_slice() {
            [lifetime] if !self.recursive && self.against.is_empty() => {
                if self.json {
                    output::json(lifetime)?;
                } else {
                    output::line(summary(lifetime))?;
                }
            }
            _ => {
                let others = score_logs(&others, &experts, &options)?;
                let together = many::together(&lifetimes, &others, &self.intervals.options())?;
                if self.json {
                    output::json(&together)?;
                } else {
                    output::line(tables::many(&lifetimes, &others, &together, &options))?;
                }
                repeats = Some(together.without_lifetimes()?);
            }
        }
        self.save(&lifetimes, repeats, options)
    }

    /// The scores of the logs; figures are drawn and written on the way where they are asked for.
    fn scored(&self, logs: &[PathBuf], experts: &Experts, options: &Options) -> Result<Vec<LifetimeMetrics>, Failure> {
        if !self.do_plot {
            return score_logs(logs, experts, options);
        }
        let (shown, how) = (self.figures.shown()?, self.figures.options()?);
        let files = Mutex::new(Files::new(&self.folder().join("plots")));
        let draw = |lived: Lived| {
            let drawn = drawn(&lived.lifetime, &lived.metrics.metrics_column, &shown, &how)?;
            // Whoever panics with the lock has ended the process.
            files.lock().unwrap_or_else(PoisonError::into_inner).write(&drawn)?;
            Ok(lived.metrics)
        };
        let lifetimes = each_lived(logs, experts, options, draw)?;
        let files = files.into_inner().unwrap_or_else(PoisonError::into_inner);
        output::note(format!("wrote {}", files.told()));
        Ok(lifetimes)
    }

    /// Where results are saved.
    fn folder(&self) -> PathBuf {
        self.output_dir.clone().unwrap_or_else(|| "results".into())
    }

    /// The logs that the arguments name; those of the settings file where there is no argument.
    fn logs(&self) -> Result<Vec<PathBuf>, Failure> {
        let mut named: Vec<PathBuf> = self.logs.iter().chain(&self.log_dir).cloned().collect();
        if named.is_empty() {
            named.extend(self.scoring.log_of_settings()?);
        }
        if named.is_empty() {
            let taken = self.scoring.named_experts();
            let hint = if taken > 1 {
                "; --ste took all folders behind it: name the log before"
            } else {
                ""
            };
            return Err(Failure::usage(format!(
                "found no DIR, expected the folder of a log, or several{hint}"
            )));
        }
        if self.recursive {
            log_folders::below(&named)
        } else {
            log_folders::named(&named)
        }
    }

    fn save(
        &self,
        lifetimes: &[LifetimeMetrics],
        repeats: Option<serde_json::Value>,
        options: Options,
    ) -> Result<(), Failure> {
        if !self.do_save && self.output_dir.is_none() && self.output.is_none() {
            return Ok(());
        }
        let folder = self.folder();
        let log_dir = self
            .logs
            .iter()
            .chain(&self.log_dir)
            .map(|log| log.display().to_string());
        let settings = Settings {
            log_dir: log_dir.collect::<Vec<_>>().join(" "),
            options,
        };
        let files = match lifetimes {
            [lifetime] if !self.recursive => {
                let name = self.output.as_deref().unwrap_or(&lifetime.run_id);
                let files = lifetime.save(&folder, name, &settings)?;
                vec![files.metrics, files.regimes, files.settings]
            }
            _ => {
                let name = self.output.as_deref().unwrap_or(NAME_OF_MANY);
                let files = save_all(lifetimes, &folder, name, &settings)?;
                vec![files.lifetimes, files.metrics, files.regimes, files.settings]
            }
        };
        for file in files {
            output::note(format!("wrote {}", file.shown()));
        }
        if let Some(repeats) = repeats {
            let name = self.output.as_deref().unwrap_or(NAME_OF_MANY).replace(' ', "_");
            let file = folder.join(format!("{name}_repeats.json"));
            output::write(&file, serde_json::to_string_pretty(&repeats)?.as_bytes())?;
            output::note(format!("wrote {}", file.shown()));
        }
        Ok(())
    }
}
