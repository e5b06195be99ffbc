//! The options for scoring a lifetime, with the reference's defaults.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::MetricsError;
use crate::choice::choice;

/// Maximum length of the smoothing window, in experiences.
pub const MAX_WINDOW_LENGTH: usize = 10_000;

/// Exclusive limit on the magnitude of performances, so that no sum or quotient of them overflows.
const MAX_PERFORMANCE: f64 = 1e100;

/// Whether a number is below [`MAX_PERFORMANCE`] in magnitude; false for NaN.
pub(crate) fn is_bounded(value: f64) -> bool {
    value.abs() < MAX_PERFORMANCE
}

choice! {
    /// Whether variants of a task (`find_red`, `find_blue`) count as separate tasks.
    VariantMode, "variant mode" {
        /// Every variant is a separate task (default).
        Aware = "aware",
        /// Names are cut at their first underscore, so that all variants are one task.
        Agnostic = "agnostic",
    }
}

impl VariantMode {
    /// The name under which a task is scored: lower-case, and without its variant if variants do not count.
    pub(crate) fn scored_name(self, task_name: &str) -> String {
        let mut name = task_name.to_lowercase();
        if self == Self::Agnostic {
            name.truncate(name.find('_').unwrap_or(name.len()));
        }
        name
    }
}

choice! {
    /// How several runs of a single-task expert are combined.
    SteAveragingMethod, "STE averaging" {
        /// Compare with each run and average the results (default).
        Metrics = "metrics",
        /// Truncate the runs to the shortest, average them step by step, and compare with the average.
        Time = "time",
    }
}

choice! {
    /// How the values of the tasks are aggregated for the lifetime.
    AggregationMethod, "aggregation" {
        /// Arithmetic mean (default).
        Mean = "mean",
        /// Median.
        Median = "median",
    }
}

choice! {
    /// The baseline of an evaluation for maintenance.
    MaintenanceMethod, "maintenance" {
        /// The most recent evaluation right after learning, "most recent learning evaluation performance" (default).
        Mrlep = "mrlep",
        /// The end of the most recent learning regime, "most recent terminal learning performance".
        Mrtlp = "mrtlp",
        /// Both, as two values.
        Both = "both",
    }
}

impl MaintenanceMethod {
    /// Whether `perf_maintenance_mrlep` is requested.
    pub const fn has_mrlep(self) -> bool {
        matches!(self, Self::Mrlep | Self::Both)
    }

    /// Whether `perf_maintenance_mrtlp` is requested.
    pub const fn has_mrtlp(self) -> bool {
        matches!(self, Self::Mrtlp | Self::Both)
    }
}

choice! {
    /// How the evaluations before and after learning another task are compared.
    TransferMethod, "transfer" {
        /// after / before; 1 means no effect (default).
        Ratio = "ratio",
        /// (after − before) / (after + before); 0 means no effect.
        Contrast = "contrast",
        /// Both, as two values.
        Both = "both",
    }
}

impl TransferMethod {
    /// Whether ratios are requested.
    pub const fn has_ratio(self) -> bool {
        matches!(self, Self::Ratio | Self::Both)
    }

    /// Whether contrasts are requested.
    pub const fn has_contrast(self) -> bool {
        matches!(self, Self::Contrast | Self::Both)
    }
}

choice! {
    /// The data whose range is scaled to 1..=101.
    NormalizationMethod, "normalisation" {
        /// Each task by its own minimum and maximum (default).
        Task = "task",
        /// All tasks by the minimum and maximum of the run.
        Run = "run",
        /// Not at all.
        Off = "none",
    }
}

choice! {
    /// Shape of the smoothing window for training data.
    SmoothingMethod, "smoothing" {
        /// Moving average (default).
        Flat = "flat",
        /// Raised cosine, zero at both ends.
        Hanning = "hanning",
        /// Raised cosine on a pedestal of 0.08.
        Hamming = "hamming",
        /// Triangle, zero at both ends.
        Bartlett = "bartlett",
        /// Sum of two cosines, zero at both ends.
        Blackman = "blackman",
        /// No smoothing.
        Off = "none",
    }
}

choice! {
    /// Which definitions the metrics follow where the reference's program departs from its own documentation.
    ///
    /// Under `published`, task parameters split regimes; saturation uses data smoothed only once; the last tenth
    /// of a regime is computed in integers; if several tasks were learned between two evaluations of another task,
    /// transfer is credited to each of them; and values in files are not rounded.
    #[derive(Default)]
    Definitions, "definitions" {
        /// The behaviour of l2metrics 3.1, including its peculiarities (default).
        #[default]
        Reference = "reference",
        /// The definitions in its documentation.
        Published = "published",
    }
}

impl Definitions {
    /// Whether these are the definitions of the reference program.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes fields by reference")]
    pub(crate) const fn is_reference(&self) -> bool {
        matches!(self, Self::Reference)
    }
}

/// Noise added to every performance after smoothing, clamping and normalisation, as in the reference, to see how sensitive
/// metrics are to small differences.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// Mean of the noise, in normalised units (1..=101 unless normalisation is off).
    pub mean: f64,
    /// Standard deviation, in the same units; not negative.
    pub std: f64,
    /// Seed of the noise: the same seed gives the same noise on every machine; default 0.
    #[serde(default)]
    pub seed: u64,
}

/// Minimum and maximum performance of a task, in the log's unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DataRange {
    /// Performance that is scaled to 1.
    pub min: f64,
    /// Performance that is scaled to 101.
    pub max: f64,
}

impl DataRange {
    /// The range from one performance to another.
    pub const fn new(min: f64, max: f64) -> Self {
        Self { min, max }
    }
}

/// Ranges by task, lower-case names.
pub type DataRanges = IndexMap<String, DataRange>;

/// Rewards in a task, in the log's unit, of agents without knowledge of the task and of an expert.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Anchors {
    /// Reward of the best agent that knows nothing, such as one that acts at random or stands still: scaled to 1.
    pub floor: f64,
    /// Reward of an expert: scaled to 101.
    pub ceiling: f64,
    /// Rewards of agents that cannot distinguish the task from others that look the same, for each set of such tasks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unlabelled: Vec<Unlabelled>,
}

/// Rewards in a task, in the log's unit, of the best known agents that cannot distinguish it from others. These agents
/// are the best on average over all of these tasks, and may be bad in this one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Unlabelled {
    /// The tasks that look alike, including this one: lower-case names as in logs.
    pub among: Vec<String>,
    /// Reward of an agent that behaves the same way in all of them.
    pub fixed: f64,
    /// Reward of an agent that may infer the task within an episode.
    pub finds_out: f64,
}

/// Floors and ceilings by task, lower-case names as in logs.
pub type Scales = IndexMap<String, Anchors>;

/// The options for scoring a lifetime. [`Options::default`] matches l2metrics' defaults.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Column of the log with the performance; default `reward`.
    pub perf_measure: String,
    /// Whether variants count as separate tasks; default aware.
    pub variant_mode: VariantMode,
    /// How several runs of a single-task expert are combined; default metrics.
    pub ste_averaging_method: SteAveragingMethod,
    /// How tasks are aggregated for the lifetime; default mean.
    pub aggregation_method: AggregationMethod,
    /// The baseline for maintenance; default mrlep.
    pub maintenance_method: MaintenanceMethod,
    /// The comparison for transfer; default ratio.
    pub transfer_method: TransferMethod,
    /// Scaling of performances; default per task.
    pub normalization_method: NormalizationMethod,
    /// Window shape; default flat.
    pub smoothing_method: SmoothingMethod,
    /// Whether evaluation regimes are smoothed as well; default no.
    pub smooth_eval_data: bool,
    /// Window length in experiences, at most [`MAX_WINDOW_LENGTH`]; by default a fifth of the data, at most 100.
    pub window_length: Option<usize>,
    /// Whether performances outside the given range, or by default the 0.1 and 0.9 quantiles, are clipped; default no.
    pub clamp_outliers: bool,
    /// Known range per task, lower-case name; by default taken from the data. If given, every task needs one.
    pub data_range: Option<DataRanges>,
    /// Floor and ceiling per task, lower-case name; default none. A task without them, or with a ceiling that is not above its
    /// floor, is scaled by its own range. Ranges in `data_range` take precedence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scales: Option<Scales>,
    /// Gaussian noise on the lifetime's performances, but not on the experts'; default none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise: Option<Noise>,
    /// The definitions; default the reference's.
    #[serde(skip_serializing_if = "Definitions::is_reference")]
    pub definitions: Definitions,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            perf_measure: "reward".to_owned(),
            variant_mode: VariantMode::Aware,
            ste_averaging_method: SteAveragingMethod::Metrics,
            aggregation_method: AggregationMethod::Mean,
            maintenance_method: MaintenanceMethod::Mrlep,
            transfer_method: TransferMethod::Ratio,
            normalization_method: NormalizationMethod::Task,
            smoothing_method: SmoothingMethod::Flat,
            smooth_eval_data: false,
            window_length: None,
            clamp_outliers: false,
            data_range: None,
            scales: None,
            noise: None,
            definitions: Definitions::Reference,
        }
    }
}

impl Options {
    /// Checks constraints that the types cannot express: window length, noise, scales and data ranges.
    ///
    /// # Errors
    /// [`MetricsError::BadOption`] for a window of 0 or over [`MAX_WINDOW_LENGTH`], a number that is not below 1e100 in
    /// magnitude, a negative standard deviation, or a range with its minimum above its maximum.
    pub(crate) fn check(&self) -> Result<(), MetricsError> {
        if let Some(length) = self.window_length
            && !(1..=MAX_WINDOW_LENGTH).contains(&length)
        {
            return Err(MetricsError::bad_option(
                "window_length",
                length.to_string(),
                format!("1 to {MAX_WINDOW_LENGTH} experiences"),
            ));
        }
        if let Some(noise) = self.noise
            && (!is_bounded(noise.mean) || !is_bounded(noise.std) || noise.std < 0.0)
        {
            return Err(MetricsError::bad_option(
                "noise",
                format!("mean {:e}, standard deviation {:e}", noise.mean, noise.std),
                "two numbers below 1e100 in magnitude, the second not negative",
            ));
        }
        for (task, anchors) in self.scales.iter().flatten() {
            if !is_bounded(anchors.floor) || !is_bounded(anchors.ceiling) {
                return Err(MetricsError::bad_option(
                    "scales",
                    format!("{:e} to {:e} for task {task}", anchors.floor, anchors.ceiling),
                    "two numbers below 1e100 in magnitude",
                ));
            }
        }
        for (task, range) in self.data_range.iter().flatten() {
            if !is_bounded(range.min) || !is_bounded(range.max) || range.min > range.max {
                return Err(MetricsError::bad_option(
                    "data_range",
                    format!("{:?} to {:?} for task {task}", range.min, range.max),
                    "two numbers below 1e100 in magnitude, the smaller one first",
                ));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_round_trip_and_an_unknown_word_lists_the_known_ones() {
        for &method in SmoothingMethod::ALL {
            assert_eq!(method.name().parse::<SmoothingMethod>().unwrap(), method);
        }
        let error = "gauss".parse::<SmoothingMethod>().unwrap_err().to_string();
        assert_eq!(
            error,
            "smoothing: found \"gauss\", expected one of flat, hanning, hamming, bartlett, blackman, none"
        );
    }

    #[test]
    fn options_round_trip_through_json_with_defaults() {
        let options = Options {
            window_length: Some(7),
            ..Options::default()
        };
        let text = serde_json::to_string(&options).unwrap();
        assert_eq!(serde_json::from_str::<Options>(&text).unwrap(), options);
        assert_eq!(serde_json::from_str::<Options>("{}").unwrap(), Options::default());
        assert!(
            serde_json::from_str::<Options>(r#"{"smoothing": "flat"}"#).is_err(),
            "a misspelt option is refused"
        );
    }

    #[test]
    fn windows_and_ranges_out_of_bounds_are_refused() {
        let check = |options: &str, expected: &str| {
            let options: Options = serde_json::from_str(options).unwrap();
            assert_eq!(options.check().unwrap_err().to_string(), expected);
        };
        check(
            r#"{"window_length": 0}"#,
            "option window_length: found 0, expected 1 to 10000 experiences",
        );
        check(
            r#"{"data_range": {"a": {"min": 2, "max": 1}}}"#,
            "option data_range: found 2.0 to 1.0 for task a, expected two numbers below 1e100 in magnitude, the smaller one first",
        );
        let (min, max) = (f64::NAN, 1.0);
        let options = Options {
            data_range: Some([("a".to_owned(), DataRange { min, max })].into()),
            ..Options::default()
        };
        assert!(options.check().is_err());
    }
}
