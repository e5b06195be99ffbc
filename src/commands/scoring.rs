//! The options by which lifetimes are scored, under l2metrics' names: for `metrics` and `report` alike. What they do is the library's.

use std::path::PathBuf;

use clap::Args;
use driftworld::metrics::{
    AggregationMethod, MaintenanceMethod, NormalizationMethod, Options, SmoothingMethod, SteAveragingMethod, SteLog,
    TransferMethod, VariantMode, read_ste_log,
};

use super::Failure;

/// How a lifetime is scored, and with which experts it is compared.
#[derive(Args, Default)]
#[command(next_help_heading = "Scoring")]
pub(crate) struct Scoring {
    /// Folders of single-task-expert logs to compare with.
    #[arg(long, value_name = "DIR", num_args = 1..)]
    ste: Vec<PathBuf>,
    /// The column that holds the performance [default: reward].
    #[arg(short, long, value_name = "COLUMN")]
    perf_measure: Option<String>,
    /// Whether variants of a task count as tasks: aware (default) or agnostic.
    #[arg(short = 'r', long, value_name = "MODE")]
    variant_mode: Option<VariantMode>,
    /// How several runs of an expert are brought together: metrics (default) or time.
    #[arg(short = 'v', long, value_name = "METHOD")]
    ste_averaging_method: Option<SteAveragingMethod>,
    /// How the values of the tasks become the lifetime's: mean (default) or median.
    #[arg(short, long, value_name = "METHOD")]
    aggregation_method: Option<AggregationMethod>,
    /// What maintenance compares with: mrlep (default), mrtlp or both.
    #[arg(short, long, value_name = "METHOD")]
    maintenance_method: Option<MaintenanceMethod>,
    /// How transfer compares before and after: ratio (default), contrast or both.
    #[arg(short, long, value_name = "METHOD")]
    transfer_method: Option<TransferMethod>,
    /// How performances are scaled: task (default), run or none.
    #[arg(short, long, value_name = "METHOD")]
    normalization_method: Option<NormalizationMethod>,
    /// How learning curves are smoothed: flat (default), hanning, hamming, bartlett, blackman or none.
    #[arg(short = 'g', long, value_name = "METHOD")]
    smoothing_method: Option<SmoothingMethod>,
    /// Smooth evaluations too.
    #[arg(short = 'G', long)]
    smooth_eval_data: bool,
    /// How long the smoothing window is, in experiences [default: a fifth of a regime, at most 100].
    #[arg(short, long, value_name = "N")]
    window_length: Option<usize>,
    /// Clip performances to the given ranges, or else to the 0.1 and 0.9 quantiles of each task.
    #[arg(short = 'x', long)]
    clamp_outliers: bool,
}

impl Scoring {
    /// The library's options.
    pub(crate) fn options(&self) -> Result<Options, Failure> {
        let default = Options::default();
        Ok(Options {
            perf_measure: self.perf_measure.clone().unwrap_or(default.perf_measure),
            variant_mode: self.variant_mode.unwrap_or(default.variant_mode),
            ste_averaging_method: self.ste_averaging_method.unwrap_or(default.ste_averaging_method),
            aggregation_method: self.aggregation_method.unwrap_or(default.aggregation_method),
            maintenance_method: self.maintenance_method.unwrap_or(default.maintenance_method),
            transfer_method: self.transfer_method.unwrap_or(default.transfer_method),
            normalization_method: self.normalization_method.unwrap_or(default.normalization_method),
            smoothing_method: self.smoothing_method.unwrap_or(default.smoothing_method),
            smooth_eval_data: self.smooth_eval_data,
            window_length: self.window_length,
            clamp_outliers: self.clamp_outliers,
            ..default
        })
    }

    /// The experts' logs.
    pub(crate) fn experts(&self) -> Result<Vec<SteLog>, Failure> {
        Ok(self.ste.iter().map(read_ste_log).collect::<Result<Vec<_>, _>>()?)
    }
}
