//! `driftworld metrics`: what an agent kept and transferred, from the log of its lifetime. The metrics are the library's.

use std::path::{Path, PathBuf};

use clap::Args;
use driftworld::metrics::{
    Direction, LifetimeMetrics, MaintenanceMethod, NormalizationMethod, Options, Settings, SmoothingMethod, SummaryRow,
    TransferMethod, VariantMode, read_log, read_ste_log, score,
};

use super::table::table;
use super::{Failure, output};

/// Score the log of a lifetime.
#[derive(Args)]
#[command(
    after_help = "Example:\n  driftworld metrics demo-out/logs/demo\n  driftworld metrics LOG --ste STE_LOG --perf-measure performance -o results"
)]
pub(crate) struct Metrics {
    /// The folder of a log in l2logger's format.
    log: PathBuf,
    /// Folders of single-task-expert logs to compare with.
    #[arg(long, value_name = "DIR", num_args = 1..)]
    ste: Vec<PathBuf>,
    /// The column that holds the performance.
    #[arg(long, default_value = "reward", value_name = "COLUMN")]
    perf_measure: String,
    /// Whether variants of a task count as tasks: aware or agnostic.
    #[arg(long, default_value = "aware", value_name = "MODE")]
    variant_mode: VariantMode,
    /// What maintenance compares with: mrlep, mrtlp or both.
    #[arg(long, default_value = "mrlep", value_name = "METHOD")]
    maintenance_method: MaintenanceMethod,
    /// How transfer compares before and after: ratio, contrast or both.
    #[arg(long, default_value = "ratio", value_name = "METHOD")]
    transfer_method: TransferMethod,
    /// How performances are scaled: task, run or none.
    #[arg(long, default_value = "task", value_name = "METHOD")]
    normalization_method: NormalizationMethod,
    /// How learning curves are smoothed: flat, hanning, hamming, bartlett, blackman or none.
    #[arg(long, default_value = "flat", value_name = "METHOD")]
    smoothing_method: SmoothingMethod,
    /// Write `NAME_metrics.json`, `NAME_regime.tsv` and `NAME_settings.json` into this folder; NAME is the log's.
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Metrics {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let options = Options {
            perf_measure: self.perf_measure,
            variant_mode: self.variant_mode,
            maintenance_method: self.maintenance_method,
            transfer_method: self.transfer_method,
            normalization_method: self.normalization_method,
            smoothing_method: self.smoothing_method,
            ..Options::default()
        };
        let scores = score_log(&self.log, &self.ste, &options)?;
        if self.json {
            output::json(&scores)?;
        } else {
            output::line(summary(&scores))?;
        }
        let Some(folder) = self.output else { return Ok(()) };
        let settings = Settings {
            log_dir: self.log.display().to_string(),
            options,
        };
        let files = scores.save(folder, &scores.run_id, &settings)?;
        for file in [files.metrics, files.regimes, files.settings] {
            output::note(format!("wrote {}", file.display()));
        }
        Ok(())
    }
}

/// Reads a log, with its warnings to standard error, and scores it.
pub(crate) fn score_log(log: &Path, experts: &[PathBuf], options: &Options) -> Result<LifetimeMetrics, Failure> {
    let log = read_log(log)?;
    log.warnings
        .iter()
        .for_each(|warning| output::note(format!("warning: {warning}")));
    let experts = experts.iter().map(read_ste_log).collect::<Result<Vec<_>, _>>()?;
    Ok(score(&log, &experts, options)?)
}

/// The lifetime's values as a table for a newcomer.
pub(crate) fn summary(scores: &LifetimeMetrics) -> String {
    let rows = scores
        .summary()
        .into_iter()
        .filter(|row| row.value.is_some())
        .map(|row| {
            [
                row.name.to_owned(),
                number(row.value),
                good(&row),
                row.explanation.to_owned(),
            ]
        });
    let head = format!(
        "{}: {} learning and {} evaluation experiences, scored by {}\n\n",
        scores.run_id, scores.num_lx, scores.num_ex, scores.metrics_column
    );
    head + &table(["metric", "value", "good", "what it says"], rows.collect(), &[1])
}

fn number(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| format!("{value:.3}"))
}

fn good(row: &SummaryRow) -> String {
    match row.good {
        Direction::Higher => "higher".to_owned(),
        Direction::HigherThan(neutral) => format!("above {neutral}"),
    }
}
