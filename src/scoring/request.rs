//! [`ScoringRequest`]: the logs to score, the settings, and the comparisons.

use std::path::PathBuf;

use clap::Args;
use driftworld_metrics::{
    AggregationMethod, BootstrapOptions, DataRanges, Definitions, MaintenanceMethod, Noise, NormalizationMethod,
    Options, Scales, SmoothingMethod, SteAveragingMethod, TransferMethod, VariantMode,
};

use driftworld_text::when;

use super::settings;
use crate::{Failure, argument, log_folders};

/// The logs to score, and how.
#[derive(Clone, Debug, Default)]
pub struct ScoringRequest {
    /// Folders of logs; by default those of the settings file.
    pub logs: Vec<PathBuf>,
    /// Whether to take all logs in the folders and up to four levels below them; links are not searched.
    pub recursive: bool,
    /// Folders of another agent's logs, or folders that contain them, to compute the probability that a lifetime of the first
    /// is better.
    pub against: Vec<PathBuf>,
    /// Scoring settings of each lifetime.
    pub settings: ScoringSettings,
    /// Whether to scale each task by its range over all lifetimes, not each lifetime by its own; always so with `against`.
    pub common_ranges: bool,
    /// A difference in each metric's own unit, to compute how many lifetimes show it; needs several lifetimes.
    pub power: Option<f64>,
    /// How intervals over several lifetimes are computed.
    pub intervals: BootstrapOptions,
}

impl ScoringRequest {
    /// The request to score these logs with default settings.
    pub fn of<P: Into<PathBuf>>(logs: impl IntoIterator<Item = P>) -> Self {
        Self {
            logs: logs.into_iter().map(Into::into).collect(),
            ..Self::default()
        }
    }

    /// The folders of the logs, each once.
    pub(crate) fn folders(&self) -> Result<Vec<PathBuf>, Failure> {
        let mut named = self.logs.clone();
        if named.is_empty() {
            named.extend(self.settings.log_of_file()?);
        }
        if named.is_empty() {
            let hint = when(self.settings.choice.experts.len() > 1, || {
                format!("; {} took all folders after it: put the log before it", argument("ste"))
            });
            return Err(Failure::usage(format!(
                "found no DIR, expected one or more folders of logs{hint}"
            )));
        }
        log_folders::found(&named, self.recursive)
    }
}

/// How a lifetime is scored, and with which experts it is compared, in the words of the command's options. `None` falls back to the
/// file of settings, then to the default.
#[derive(Args, Clone, Debug, Default)]
pub struct ScoringChoice {
    /// Compare with the single-task experts logged in these folders.
    #[arg(long = "ste", value_name = "DIR", num_args = 1..)]
    pub experts: Vec<PathBuf>,
    /// Compare with the experts stored in this folder.
    ///
    /// `driftworld metrics --ste-store-mode` stores them. Experts for the lifetime's tasks are used.
    #[arg(id = "ste_data", long = "ste-data", value_name = "DIR")]
    pub expert_store: Option<PathBuf>,
    /// The column to score [default: reward].
    #[arg(short, long, value_name = "COLUMN")]
    pub perf_measure: Option<String>,
    /// Score each variant (aware, the default) or whole tasks (agnostic).
    #[arg(short = 'r', long, value_name = "MODE")]
    pub variant_mode: Option<VariantMode>,
    /// How to combine several runs of an expert: metrics (default) or time.
    #[arg(short = 'v', long, value_name = "METHOD")]
    pub ste_averaging_method: Option<SteAveragingMethod>,
    /// How to aggregate over tasks: mean (default) or median.
    #[arg(short, long, value_name = "METHOD")]
    pub aggregation_method: Option<AggregationMethod>,
    /// The baseline of performance maintenance: mrlep (default), mrtlp or both.
    #[arg(short, long, value_name = "METHOD")]
    pub maintenance_method: Option<MaintenanceMethod>,
    /// How to compare performance before and after: ratio (default), contrast or both.
    #[arg(short, long, value_name = "METHOD")]
    pub transfer_method: Option<TransferMethod>,
    /// How to normalise performance: task (default), run or none.
    #[arg(short, long, value_name = "METHOD")]
    pub normalization_method: Option<NormalizationMethod>,
    /// The smoothing window: flat (default), hanning, hamming, bartlett, blackman or none.
    #[arg(short = 'g', long, value_name = "METHOD")]
    pub smoothing_method: Option<SmoothingMethod>,
    /// Smooth evaluation blocks too.
    #[arg(short = 'G', long)]
    pub smooth_eval_data: bool,
    /// Length of the smoothing window [default: a fifth of a regime, at most 100].
    #[arg(short, long, value_name = "N")]
    pub window_length: Option<usize>,
    /// Clip performance to the given ranges, or else to each task's 0.1 and 0.9 quantiles.
    #[arg(short = 'x', long)]
    pub clamp_outliers: bool,
}

/// Scoring settings: explicit choices, and contents of files.
#[derive(Clone, Debug, Default)]
pub struct ScoringSettings {
    /// Explicit choices.
    pub choice: ScoringChoice,
    /// A JSON file of settings to start from, l2metrics' or ours.
    pub file: Option<PathBuf>,
    /// The range of each task.
    pub data_range: Option<DataRanges>,
    /// The floor and ceiling of tasks; not together with `data_range`.
    pub scales: Option<Scales>,
    /// Normal noise on every performance of the lifetime, in normalised units.
    pub noise: Option<Noise>,
    /// Whether to follow the published definitions where the reference implementation departs from them.
    pub strict_definitions: bool,
}

impl ScoringSettings {
    /// The options: defaults, overridden by the file, overridden by these settings.
    pub(crate) fn options(&self) -> Result<Options, Failure> {
        let mut options = match &self.file {
            Some(path) => settings::load(path)?.options,
            None => Options::default(),
        };
        if self.scales.is_some() && (self.data_range.is_some() || options.data_range.is_some()) {
            return Err(Failure::in_argument(
                "scales",
                "found ranges of tasks, too, expected one of the two",
            ));
        }
        let choice = &self.choice;
        set(&mut options.perf_measure, choice.perf_measure.clone());
        set(&mut options.variant_mode, choice.variant_mode);
        set(&mut options.ste_averaging_method, choice.ste_averaging_method);
        set(&mut options.aggregation_method, choice.aggregation_method);
        set(&mut options.maintenance_method, choice.maintenance_method);
        set(&mut options.transfer_method, choice.transfer_method);
        set(&mut options.normalization_method, choice.normalization_method);
        set(&mut options.smoothing_method, choice.smoothing_method);
        options.smooth_eval_data |= choice.smooth_eval_data;
        options.window_length = choice.window_length.or(options.window_length);
        options.clamp_outliers |= choice.clamp_outliers;
        options.data_range = self.data_range.clone().or(options.data_range);
        options.scales = self.scales.clone().or(options.scales);
        options.noise = self.noise.or(options.noise);
        if self.strict_definitions {
            options.definitions = Definitions::Published;
        }
        Ok(options)
    }

    /// The log for which the settings file was saved.
    fn log_of_file(&self) -> Result<Option<PathBuf>, Failure> {
        let path = self.file.as_deref();
        Ok(path.map(settings::load).transpose()?.and_then(|loaded| loaded.log_dir))
    }
}

fn set<T>(option: &mut T, said: Option<T>) {
    if let Some(said) = said {
        *option = said;
    }
}
