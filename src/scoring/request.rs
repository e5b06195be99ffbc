//! [`ScoringRequest`]: which logs are scored, by which settings, and what they are compared with.

use std::path::PathBuf;

use driftworld_metrics::{
    AggregationMethod, BootstrapOptions, DataRanges, Definitions, MaintenanceMethod, Noise, NormalizationMethod,
    Options, Scales, SmoothingMethod, SteAveragingMethod, TransferMethod, VariantMode,
};

use super::{Experts, settings};
use crate::{Failure, argument, log_folders};

/// Which logs are scored, and how.
#[derive(Clone, Debug, Default)]
pub struct ScoringRequest {
    /// Folders of logs; those of the settings file where there are none.
    pub logs: Vec<PathBuf>,
    /// Take all logs in the folders, also up to four levels below; links are not looked into.
    pub recursive: bool,
    /// Folders of another agent's logs, or of folders of such: how probably is a lifetime of the first better?
    pub against: Vec<PathBuf>,
    /// How each lifetime is scored.
    pub settings: ScoringSettings,
    /// Scale each task by its range over all lifetimes, not each lifetime by its own; so it is with `against` anyway.
    pub common_ranges: bool,
    /// Say how many lifetimes show a difference of this much, in each metric's own unit; needs several lifetimes.
    pub power: Option<f64>,
    /// How intervals over several lifetimes are made.
    pub intervals: BootstrapOptions,
}

impl ScoringRequest {
    /// The request to score these logs as is usual.
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
            let hint = if self.settings.experts.len() > 1 {
                format!("; {} took all folders after it: put the log before it", argument("ste"))
            } else {
                String::new()
            };
            return Err(Failure::usage(format!(
                "found no DIR, expected one or more folders of logs{hint}"
            )));
        }
        if self.recursive {
            log_folders::below(&named)
        } else {
            log_folders::named(&named)
        }
    }
}

/// How a lifetime is scored, and with which experts it is compared. What is `None` is as the file of settings says, or
/// as is usual.
#[derive(Clone, Debug, Default)]
pub struct ScoringSettings {
    /// Folders of single-task-expert logs to compare with.
    pub experts: Vec<PathBuf>,
    /// The folder where experts are kept; those of the lifetime's tasks are taken.
    pub expert_store: Option<PathBuf>,
    /// A JSON file of settings, l2metrics' or ours, to start from.
    pub file: Option<PathBuf>,
    /// The column that holds the performance; default `reward`.
    pub perf_measure: Option<String>,
    /// Whether variants of a task count as tasks; default aware.
    pub variant_mode: Option<VariantMode>,
    /// How several runs of an expert are brought together; default metrics.
    pub ste_averaging_method: Option<SteAveragingMethod>,
    /// How the values of the tasks become the lifetime's; default mean.
    pub aggregation_method: Option<AggregationMethod>,
    /// What maintenance compares with; default mrlep.
    pub maintenance_method: Option<MaintenanceMethod>,
    /// How transfer compares before and after; default ratio.
    pub transfer_method: Option<TransferMethod>,
    /// How performances are scaled; default task.
    pub normalization_method: Option<NormalizationMethod>,
    /// How learning curves are smoothed; default flat.
    pub smoothing_method: Option<SmoothingMethod>,
    /// Smooth evaluations too.
    pub smooth_eval_data: bool,
    /// How long the smoothing window is, in experiences; default a fifth of a regime, at most 100.
    pub window_length: Option<usize>,
    /// Clip performances to the given ranges, or else to the 0.1 and 0.9 quantiles of each task.
    pub clamp_outliers: bool,
    /// The range of each task.
    pub data_range: Option<DataRanges>,
    /// The floor and ceiling of tasks; not together with `data_range`.
    pub scales: Option<Scales>,
    /// Normal noise on every performance of the lifetime, in normalised units.
    pub noise: Option<Noise>,
    /// Follow the published definitions where the reference's program departs from them.
    pub strict_definitions: bool,
}

impl ScoringSettings {
    /// The options: defaults, then the file, then what is said here.
    pub(crate) fn options(&self) -> Result<Options, Failure> {
        let mut options = match &self.file {
            Some(path) => settings::load(path)?.options,
            None => Options::default(),
        };
        if self.scales.is_some() && (self.data_range.is_some() || options.data_range.is_some()) {
            return Err(Failure::usage(format!(
                "{}: found ranges of tasks, too, expected one of the two",
                argument("scales")
            )));
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
        options.data_range = self.data_range.clone().or(options.data_range);
        options.scales = self.scales.clone().or(options.scales);
        options.noise = self.noise.or(options.noise);
        if self.strict_definitions {
            options.definitions = Definitions::Published;
        }
        Ok(options)
    }

    /// The experts to compare with.
    pub(crate) fn experts(&self) -> Result<Experts, Failure> {
        Experts::new(&self.experts, self.expert_store.as_deref())
    }

    /// The log that the file of settings was saved for.
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
