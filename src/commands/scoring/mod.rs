//! The options by which lifetimes are scored, under l2metrics' names: for `metrics` and `report` alike. What they do is the library's.

mod experts;
mod settings;

use std::path::{Path, PathBuf};

use crate::metrics::{
    AggregationMethod, Definitions, MaintenanceMethod, Noise, NormalizationMethod, Options, SmoothingMethod,
    SteAveragingMethod, TransferMethod, VariantMode,
};
use clap::Args;

pub(crate) use experts::Experts;

use super::Failure;

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
    /// The library's options: defaults, then the settings file, then flags.
    pub(crate) fn options(&self) -> Result<Options, Failure> {
        let mut options = match &self.load_settings {
            Some(path) => settings::load(path)?.options,
            None => Options::default(),
        };
        set(&mut options.perf_measure, self.perf_measure.clone());
        set(&mut options.variant_mode, self.variant_mode);
        set(&mut options.ste_averaging_method, self.ste_averaging_method);
        set(&mut options.aggregation_method, self.aggregation_method);
        set(&mut options.maintenance_method, self.maintenance_method);
        set(&mut options.transfer_method, self.transfer_method);
        set(&mut options.normalization_method, self.normalization_method);
        set(&mut options.smoothing_method, self.smoothing_method);
        options.smooth_eval_data |= self.smooth_eval_data;
        options.window_length = self.window_length.or(options.window_length);
        options.clamp_outliers |= self.clamp_outliers;
        if let Some(path) = &self.data_range_file {
            options.data_range = Some(settings::data_range(path)?.into_iter().collect());
        }
        if let Some([mean, std]) = self.noise.as_deref() {
            options.noise = Some(Noise {
                mean: *mean,
                std: *std,
                seed: self.noise_seed,
            });
        }
        if self.strict_definitions {
            options.definitions = Definitions::Published;
        }
        Ok(options)
    }

    /// The log that the settings file was saved for, for whoever names none.
    pub(crate) fn log_of_settings(&self) -> Result<Option<PathBuf>, Failure> {
        let path = self.load_settings.as_deref();
        Ok(path.map(settings::load).transpose()?.and_then(|loaded| loaded.log_dir))
    }

    /// How many experts were named.
    pub(crate) fn named_experts(&self) -> usize {
        self.ste.len()
    }

    /// Where experts are kept.
    pub(crate) fn ste_data(&self) -> Option<&Path> {
        self.ste_data.as_deref()
    }

    /// The experts to compare with.
    pub(crate) fn experts(&self) -> Result<Experts, Failure> {
        Experts::new(&self.ste, self.ste_data.as_deref())
    }
}

fn set<T>(option: &mut T, flag: Option<T>) {
    if let Some(flag) = flag {
        *option = flag;
    }
}
