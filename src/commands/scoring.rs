//! The options by which lifetimes are scored, under l2metrics' names: for `metrics` and `report` alike. What they do is
//! the library's.

use std::path::{Path, PathBuf};

use crate::Failure;
use crate::metrics::{
    AggregationMethod, BootstrapOptions, MaintenanceMethod, Noise, NormalizationMethod, Resampling, SmoothingMethod,
    SteAveragingMethod, TransferMethod, VariantMode,
};
use crate::scoring::{ScoringSettings, data_ranges};
use clap::Args;

/// How a lifetime is scored, and with which experts it is compared.
#[derive(Args, Default)]
#[command(next_help_heading = "Scoring")]
pub(crate) struct Scoring {
    /// Folders of single-task-expert logs to compare with.
    #[arg(long, value_name = "DIR", num_args = 1..)]
    ste: Vec<PathBuf>,
    /// The folder where `driftworld metrics --ste-store-mode` keeps experts; those of the lifetime's tasks are taken.
    #[arg(long, value_name = "DIR")]
    ste_data: Option<PathBuf>,
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
    /// A JSON file with the range of each task: `{"find_red": {"min": 0, "max": 10}}`.
    #[arg(short, long, value_name = "FILE")]
    data_range_file: Option<PathBuf>,
    /// Add normal noise to every performance of the lifetime, in normalised units.
    #[arg(short = 'N', long, num_args = 2, value_names = ["MEAN", "STD"], allow_negative_numbers = true)]
    noise: Option<Vec<f64>>,
    /// What the noise is drawn from.
    #[arg(long, value_name = "N", default_value_t = 0, requires = "noise")]
    noise_seed: u64,
    /// Follow the published definitions where the reference's program departs from them; docs/metrics.md says where.
    #[arg(long)]
    strict_definitions: bool,
    /// Start from the settings in this JSON file, l2metrics' or ours; flags beside it win.
    #[arg(short = 'c', long, value_name = "FILE")]
    load_settings: Option<PathBuf>,
}

impl Scoring {
    /// The same for the library.
    pub(crate) fn settings(&self) -> Result<ScoringSettings, Failure> {
        let noise = self.noise.as_deref().and_then(|noise| match noise {
            [mean, std] => Some(Noise {
                mean: *mean,
                std: *std,
                seed: self.noise_seed,
            }),
            // The parser takes two.
            _ => None,
        });
        Ok(ScoringSettings {
            experts: self.ste.clone(),
            expert_store: self.ste_data.clone(),
            file: self.load_settings.clone(),
            perf_measure: self.perf_measure.clone(),
            variant_mode: self.variant_mode,
            ste_averaging_method: self.ste_averaging_method,
            aggregation_method: self.aggregation_method,
            maintenance_method: self.maintenance_method,
            transfer_method: self.transfer_method,
            normalization_method: self.normalization_method,
            smoothing_method: self.smoothing_method,
            smooth_eval_data: self.smooth_eval_data,
            window_length: self.window_length,
            clamp_outliers: self.clamp_outliers,
            data_range: self.data_range_file.as_deref().map(data_ranges).transpose()?,
            noise,
            strict_definitions: self.strict_definitions,
        })
    }

    /// Where experts are kept.
    pub(crate) fn ste_data(&self) -> Option<&Path> {
        self.ste_data.as_deref()
    }
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
    resampling: Resampling,
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
