//! `driftworld metrics`: what an agent kept and transferred, from the log of its lifetime. The metrics are the library's.

use std::path::{Path, PathBuf};

use clap::Args;
use driftworld::metrics::{Direction, LifetimeMetrics, Options, Settings, SteLog, SummaryRow, read_log, score};

use super::scoring::Scoring;
use super::table::table;
use super::{Failure, output};

/// Score the log of a lifetime.
#[derive(Args)]
#[command(
    after_help = "Example:\n  driftworld metrics demo-out/logs/demo\n  driftworld metrics LOG --ste STE_LOG --perf-measure performance -O results"
)]
pub(crate) struct Metrics {
    /// The folder of a log in l2logger's format.
    log: PathBuf,
    #[command(flatten)]
    scoring: Scoring,
    /// Write `NAME_metrics.json`, `NAME_regime.tsv` and `NAME_settings.json` into this folder; NAME is the log's.
    #[arg(short = 'O', long, value_name = "DIR")]
    output_dir: Option<PathBuf>,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

impl Metrics {
    pub(crate) fn run(self) -> Result<(), Failure> {
        let options = self.scoring.options()?;
        let scores = score_log(&self.log, &self.scoring.experts()?, &options)?;
        if self.json {
            output::json(&scores)?;
        } else {
            output::line(summary(&scores))?;
        }
        let Some(folder) = self.output_dir else { return Ok(()) };
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
pub(crate) fn score_log(log: &Path, experts: &[SteLog], options: &Options) -> Result<LifetimeMetrics, Failure> {
    let log = read_log(log)?;
    log.warnings
        .iter()
        .for_each(|warning| output::note(format!("warning: {warning}")));
    Ok(score(&log, experts, options)?)
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
