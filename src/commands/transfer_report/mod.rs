//! `driftworld transfer-report`: tests whether similar variants transferred more, from logs and distances.

mod words;

use std::path::PathBuf;

use crate::curriculum::{TransferOptions, transfer_report};
use crate::metrics::{NormalizationMethod, Options, SmoothingMethod, TransferMethod};
use crate::similarity::MAX_RELABELLINGS;
use clap::Args;

use super::output;
use crate::numbers::documented;
use crate::report::picture::scatter;
use crate::scoring::{Experts, score_logs};
use crate::{Failure, log_folders, matrix_file, overwrite};

/// Test whether similar variants transferred more.
///
/// Transfer from A to B is the effect of learning A on B: the evaluation of B after it, compared with the one before.
/// It is forward if B had not been learned yet, and backward if it had. Ordering a curriculum by distance assumes that
/// transfer grows as distance shrinks. This report tests that assumption on logged lifetimes.
///
/// Several lifetimes are pooled. For each pair of variants, the first transfer of each lifetime counts, averaged over
/// lifetimes. Use lifetimes with different orders: if all learned in one order, near variants are also early ones, and
/// the two effects are confounded.
///
/// The p-value comes from a Mantel test: variants swap labels in the distance matrix, pairs without a transfer stay
/// without one, and p is the share of relabellings with a correlation at least as strong.
#[derive(Args)]
#[command(after_help = "Examples:
  driftworld order find_objects --matrix distances.csv
  driftworld transfer-report logs --distances distances.csv --plot transfer.png
  driftworld transfer-report logs/run1 logs/run2 --distances distances.csv --json")]
pub(crate) struct TransferReport {
    /// Folders of l2logger logs, or folders of such folders.
    #[arg(required = true, value_name = "LOGS")]
    logs: Vec<PathBuf>,
    /// The distance matrix from `driftworld order --matrix`: .csv or .json.
    #[arg(long, value_name = "FILE")]
    distances: PathBuf,
    /// The column to score.
    #[arg(long, default_value = "reward", value_name = "COLUMN")]
    perf_measure: String,
    /// How to compare performance before and after.
    #[arg(long, value_parser = documented::<TransferMethod>(&MEASURES), default_value = "contrast", value_name = "MEASURE")]
    transfer_method: TransferMethod,
    /// How to normalise performance: task, run or none.
    #[arg(long, default_value = "task", value_name = "METHOD")]
    normalization_method: NormalizationMethod,
    /// The smoothing window: flat, hanning, hamming, bartlett, blackman or none.
    #[arg(long, default_value = "flat", value_name = "METHOD")]
    smoothing_method: SmoothingMethod,
    /// Number of relabellings to draw; all of them are used if there are no more.
    #[arg(long, default_value_t = 9_999, value_name = "N",
        value_parser = clap::value_parser!(u64).range(1..=MAX_RELABELLINGS))]
    relabellings: u64,
    /// Seed of the relabellings.
    #[arg(long, default_value_t = 0, allow_negative_numbers = true, value_parser = crate::numbers::seed)]
    seed: u64,
    /// Draw transfer over distance into this PNG file.
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Print the result as JSON.
    #[arg(long)]
    json: bool,
}

/// Measures of transfer.
const MEASURES: [&str; 2] = [
    "contrast: Difference over sum: −1 to 1, with 0 for no change",
    "ratio: After over before: 1 for no change",
];

impl TransferReport {
    pub(crate) fn run(self) -> Result<(), Failure> {
        if let Some(target) = &self.plot {
            overwrite::refuse_inputs(target, self.distances.to_str())?;
        }
        let distances = matrix_file::read("distances", &self.distances)?;
        let measure = self.transfer_method;
        let options = Options {
            perf_measure: self.perf_measure,
            transfer_method: measure,
            normalization_method: self.normalization_method,
            smoothing_method: self.smoothing_method,
            ..Options::default()
        };
        let lifetimes = score_logs(
            &log_folders::below(&self.logs)?,
            &Experts::default(),
            &options,
            &|text| output::warning(text),
        )?;
        let options = TransferOptions {
            measure,
            relabellings: self.relabellings,
            seed: self.seed,
        };
        let report = transfer_report(&lifetimes, &distances, &options)?;
        if self.json {
            output::json(&report)?;
        } else {
            output::line(words::report(&report))?;
        }
        let Some(path) = self.plot else { return Ok(()) };
        let picture = scatter(&words::panels(&report));
        output::write_and_report_picture(&path, &picture)
    }
}
