//! [`ScoringRequest`]: the logs to score, the settings, and the comparisons.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PathBufValueParser, TypedValueParser as _};
use driftworld_metrics::{
    AggregationMethod, BootstrapOptions, DataRanges, Definitions, MaintenanceMethod, Noise, NormalizationMethod,
    Options, Resampling, Scales, SmoothingMethod, SteAveragingMethod, TransferMethod, VariantMode,
};
use driftworld_text::when;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer};
use serde_json::Value;

use super::settings;
use crate::scales::ScalesFile;
use crate::{Failure, argument, log_folders, numbers, request};

/// The logs to score, and how.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct ScoringRequest {
    /// Folders of logs; by default those of the settings file.
    pub logs: Vec<PathBuf>,
    /// Whether to take all logs in the folders and up to four levels below them; links are not searched.
    pub recursive: bool,
    /// Folders of another agent's logs, or folders that contain them, to compute the probability that a lifetime of the first
    /// is better.
    pub against: Vec<PathBuf>,
    /// A difference in each metric's own unit, to compute how many lifetimes show it; needs several lifetimes.
    pub power: Option<f64>,
    /// How each lifetime is scored.
    #[serde(skip)]
    pub settings: ScoringSettings,
    /// How several lifetimes are combined.
    #[serde(skip)]
    pub intervals: Intervals,
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
            let hint = when(self.settings.experts.len() > 1, || {
                format!("; {} took all folders after it: put the log before it", argument("ste"))
            });
            return Err(Failure::usage(format!(
                "found no DIR, expected one or more folders of logs{hint}"
            )));
        }
        log_folders::found(&named, self.recursive)
    }
}

/// How a lifetime is scored, and with which experts it is compared. Missing values come from the settings file, or else
/// are the defaults.
#[derive(Args, Clone, Debug, Default, Deserialize)]
#[group(skip)]
#[command(next_help_heading = "Scoring")]
#[serde(default, deny_unknown_fields)]
pub struct ScoringSettings {
    /// Compare with the single-task experts logged in these folders.
    #[arg(long = "ste", value_name = "DIR", num_args = 1..)]
    #[serde(rename = "ste")]
    pub experts: Vec<PathBuf>,
    /// Compare with the experts stored in this folder.
    ///
    /// `driftworld metrics --ste-store-mode` stores them. Experts for the lifetime's tasks are used.
    #[arg(id = "ste_data", long = "ste-data", value_name = "DIR")]
    #[serde(rename = "ste_data")]
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
    /// Read each task's range from a JSON file: `{"find_red": {"min": 0, "max": 10}}`.
    #[arg(short, long, value_name = "FILE")]
    #[serde(skip)]
    pub data_range_file: Option<PathBuf>,
    /// The range of each task, by its name in any case.
    #[arg(skip)]
    #[serde(deserialize_with = "by_task")]
    pub data_range: Option<DataRanges>,
    /// Scale each task from its floor to its ceiling, as `driftworld scales` measures them.
    ///
    /// A task that is not in the file, or whose ceiling is not above its floor, is scaled by its own range.
    #[arg(long, value_name = "FILE", conflicts_with = "data_range_file",
        value_parser = PathBufValueParser::new().map(ScalesChoice::File))]
    #[serde(deserialize_with = "scales")]
    pub scales: Option<ScalesChoice>,
    /// Add Gaussian noise to the performance, in normalised units.
    #[arg(short = 'N', long, num_args = 2, value_names = ["MEAN", "STD"], allow_negative_numbers = true)]
    pub noise: Option<Vec<f64>>,
    /// Seed of the noise.
    #[arg(
        long,
        value_name = "N",
        default_value_t = 0,
        requires = "noise", allow_negative_numbers = true, value_parser = numbers::seed
    )]
    pub noise_seed: u64,
    /// Follow the published definitions where the reference program differs.
    ///
    /// docs/metrics.md lists the differences.
    #[arg(long)]
    pub strict_definitions: bool,
    /// Read settings from a JSON file, l2metrics' or ours. Command-line options win.
    #[arg(short = 'c', long, value_name = "FILE")]
    pub load_settings: Option<PathBuf>,
}

/// Floors and ceilings of tasks: a file that `driftworld scales` wrote, or the values.
#[derive(Clone, Debug)]
pub enum ScalesChoice {
    /// A file.
    File(PathBuf),
    /// The values of each task.
    Values(Scales),
}

fn scales<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<ScalesChoice>, D::Error> {
    match Value::deserialize(deserializer)? {
        Value::String(path) => Ok(Some(ScalesChoice::File(path.into()))),
        tasks @ Value::Object(_) => Ok(by_task(tasks).map_err(D::Error::custom)?.map(ScalesChoice::Values)),
        _ => Err(D::Error::custom("expected a file, or floor and ceiling of each task")),
    }
}

/// A value for each task, by its lower-cased name.
fn by_task<'de, D, T, M>(deserializer: D) -> Result<Option<M>, D::Error>
where
    D: Deserializer<'de>,
    M: IntoIterator<Item = (String, T)> + FromIterator<(String, T)> + Deserialize<'de>,
{
    let tasks = M::deserialize(deserializer)?.into_iter();
    Ok(Some(tasks.map(|(task, value)| (task.to_lowercase(), value)).collect()))
}

impl ScoringSettings {
    /// The options: defaults, overridden by the file, overridden by these settings.
    pub(crate) fn options(&self) -> Result<Options, Failure> {
        let mut options = match &self.load_settings {
            Some(path) => settings::load(path)?.options,
            None => Options::default(),
        };
        let is_ranged = self.data_range.is_some() || self.data_range_file.is_some() || options.data_range.is_some();
        if self.scales.is_some() && is_ranged {
            return Err(Failure::in_argument(
                "scales",
                "found ranges of tasks, too, expected one of the two",
            ));
        }
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
        options.data_range = match &self.data_range_file {
            Some(path) => Some(settings::data_ranges(path)?),
            None => self.data_range.clone().or(options.data_range),
        };
        options.scales = match &self.scales {
            Some(ScalesChoice::File(path)) => Some(ScalesFile::read(path)?.anchors()),
            Some(ScalesChoice::Values(scales)) => Some(scales.clone()),
            None => options.scales,
        };
        options.noise = self.noise()?.or(options.noise);
        if self.strict_definitions {
            options.definitions = Definitions::Published;
        }
        Ok(options)
    }

    fn noise(&self) -> Result<Option<Noise>, Failure> {
        match self.noise.as_deref() {
            None if self.noise_seed != 0 => {
                let text = "options: found no noise, expected it beside ";
                Err(Failure::usage(text.to_owned() + &argument("noise_seed")))
            }
            None => Ok(None),
            Some(&[mean, std]) => Ok(Some(Noise {
                mean,
                std,
                seed: self.noise_seed,
            })),
            Some(found) => Err(Failure::in_argument(
                "noise",
                format!("found {found:?}, expected mean and standard deviation, such as [0, 0.1]"),
            )),
        }
    }

    /// The log for which the settings file was saved.
    fn log_of_file(&self) -> Result<Option<PathBuf>, Failure> {
        let path = self.load_settings.as_deref();
        Ok(path.map(settings::load).transpose()?.and_then(|loaded| loaded.log_dir))
    }
}

fn set<T>(option: &mut T, said: Option<T>) {
    if let Some(said) = said {
        *option = said;
    }
}

/// How several lifetimes are combined, and the confidence intervals.
#[derive(Args, Clone, Debug, Deserialize)]
#[group(skip)]
#[command(next_help_heading = "Several lifetimes")]
#[serde(default, deny_unknown_fields)]
pub struct Intervals {
    /// Normalise each task by its range over all lifetimes. --against always does.
    #[arg(long)]
    pub common_ranges: bool,
    /// Confidence level of the bootstrap intervals.
    #[arg(long, value_name = "SHARE", default_value_t = BootstrapOptions::default().confidence, value_parser = numbers::share)]
    pub confidence: f64,
    /// Number of bootstrap resamples. Use 50000 for a published figure.
    #[arg(long, value_name = "N", default_value_t = BootstrapOptions::default().resamples)]
    pub resamples: u32,
    /// What to resample: runs (whole lifetimes) or strata (within each task).
    ///
    /// `strata` works as in rliable: it treats the tasks of a lifetime as independent.
    #[arg(long, value_name = "WHAT", default_value_t = BootstrapOptions::default().resampling)]
    pub resampling: Resampling,
    /// Seed of the bootstrap.
    #[arg(long, value_name = "N", default_value_t = 0, allow_negative_numbers = true, value_parser = numbers::seed)]
    pub bootstrap_seed: u64,
}

impl Default for Intervals {
    fn default() -> Self {
        request::usual()
    }
}

impl Intervals {
    /// The options of the bootstrap.
    pub(crate) fn options(&self) -> BootstrapOptions {
        BootstrapOptions {
            confidence: self.confidence,
            resamples: self.resamples,
            resampling: self.resampling,
            seed: self.bootstrap_seed,
        }
    }
}
