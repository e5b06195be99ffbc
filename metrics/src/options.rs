//! The choices a user has when a lifetime is scored, with the reference's defaults.
//!
//! What each choice does is computed elsewhere: see `preprocess` and `score`.

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

use crate::MetricsError;
use crate::choice::choice;

/// Longest smoothing window that may be asked for, in experiences.
pub const MAX_WINDOW_LENGTH: usize = 10_000;

/// Performances must stay below this magnitude, so that no sum or quotient of them overflows.
const MAX_PERFORMANCE: f64 = 1e100;

/// Whether a number is below that in magnitude; NaN is not.
pub(crate) fn is_bounded(value: f64) -> bool {
    value.abs() < MAX_PERFORMANCE
}

choice! {
    /// Whether variants of a task (`find_red`, `find_blue`) are tasks of their own.
    VariantMode, "variant mode" {
        /// Every variant is a task of its own (default).
        Aware = "aware",
        /// Names are cut at their first underscore, so that all variants are one task.
        Agnostic = "agnostic",
    }
}

impl VariantMode {
    /// The name under which a task is scored: lower-case, and without its variant where variants do not count.
    pub(crate) fn scored_name(self, task_name: &str) -> String {
        let mut name = task_name.to_lowercase();
        if self == Self::Agnostic {
            name.truncate(name.find('_').unwrap_or(name.len()));
        }
        name
    }
}

choice! {
    /// How several runs of a single-task expert are brought together.
    SteAveragingMethod, "STE averaging" {
        /// Compare with each run and average the results (default).
        Metrics = "metrics",
        /// Cut the runs to the shortest, average them step by step and compare with that.
        Time = "time",
    }
}

choice! {
    /// How the values of the tasks become the one value of the lifetime.
    AggregationMethod, "aggregation" {
        /// Arithmetic mean (default).
        Mean = "mean",
        /// Median.
        Median = "median",
    }
}

choice! {
    /// What an evaluation is compared with when maintenance is computed.
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
    /// Whether `perf_maintenance_mrlep` is asked for.
    pub const fn has_mrlep(self) -> bool {
        matches!(self, Self::Mrlep | Self::Both)
    }

    /// Whether `perf_maintenance_mrtlp` is asked for.
    pub const fn has_mrtlp(self) -> bool {
        matches!(self, Self::Mrtlp | Self::Both)
    }
}

choice! {
    /// How an evaluation before learning another task is compared with the one after.
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
    /// Whether the ratios are asked for.
    pub const fn has_ratio(self) -> bool {
        matches!(self, Self::Ratio | Self::Both)
    }

    /// Whether the contrasts are asked for.
    pub const fn has_contrast(self) -> bool {
        matches!(self, Self::Contrast | Self::Both)
    }
}

choice! {
    /// Over which data the range 1..=101 is stretched.
    NormalizationMethod, "normalisation" {
        /// Each task by its own smallest and largest performance (default).
        Task = "task",
        /// All tasks by the smallest and largest performance of the run.
        Run = "run",
        /// Not at all.
        Off = "none",
    }
}

choice! {
    /// Shape of the window that training data are smoothed with.
    SmoothingMethod, "smoothing" {
        /// Moving average (default).
        Flat = "flat",
        /// Raised cosine, zero at both ends.
        Hanning = "hanning",
        /// Raised cosine on a pedestal of 0.08.
        Hamming = "hamming",
        /// Triangle, zero at both ends.
        Bartlett = "bartlett",
        /// Two cosines, zero at both ends.
        Blackman = "blackman",
        /// No smoothing.
        Off = "none",
    }
}

choice! {
    /// Whose definitions the metrics follow where the reference's program departs from its own documents.
    ///
    /// Under `published`, task parameters split regimes; saturation looks at data that were smoothed once; the last
    /// tenth of a regime is reckoned in whole numbers; of several tasks that were learned between two evaluations of
    /// another, each is said to have transferred; and files are not rounded.
    #[derive(Default)]
    Definitions, "definitions" {
        /// What l2metrics 3.1 computes, to its last peculiarity (default).
        #[default]
        Reference = "reference",
        /// What its documents define.
        Published = "published",
    }
}

impl Definitions {
    /// Whether these are the reference program's.
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde hands fields over by reference")]
    pub(crate) const fn is_reference(&self) -> bool {
        matches!(self, Self::Reference)
    }
}

/// Noise that is added to every performance after it was smoothed, clamped and normalised, as the reference does, to see how far
/// metrics depend on small differences.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// Mean of the noise, in normalised units (1..=101 unless normalisation is off).
    pub mean: f64,
    /// Standard deviation, in the same units; not negative.
    pub std: f64,
    /// What the noise is drawn from: the same seed, the same noise, on every machine; default 0.
    #[serde(default)]
    pub seed: u64,
}

/// Smallest and largest performance a task can have, in the log's unit.
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

/// What agents earn in a task that know nothing of it, and all, in the log's unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Anchors {
    /// The best of agents that know nothing, such as one that acts at random and one that stands still: scaled to 1.
    pub floor: f64,
    /// An expert's: scaled to 101.
    pub ceiling: f64,
    /// What agents earn that cannot tell the task from others that look alike, for each set of such tasks.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unlabelled: Vec<Unlabelled>,
}

/// What the best known agents earn in a task that they cannot tell from others, in the log's unit. They are the best in
/// the mean over all of these tasks, and may be bad in this one.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Unlabelled {
    /// The tasks that look alike, this one included: lower-case names as logs have them.
    pub among: Vec<String>,
    /// One that does the same in all of them.
    pub fixed: f64,
    /// One that may find out within an episode which it is.
    pub finds_out: f64,
}

/// Floors and ceilings by task, lower-case names as logs have them.
pub type Scales = IndexMap<String, Anchors>;

/// The choices under which a lifetime is scored. [`Options::default`] is what l2metrics does when asked for nothing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Column of the log that holds the performance; default `reward`.
    pub perf_measure: String,
    /// Whether variants of a task count as tasks; default aware.
    pub variant_mode: VariantMode,
    /// How several runs of a single-task expert are averaged; default metrics.
    pub ste_averaging_method: SteAveragingMethod,
    /// From tasks to lifetime; default mean.
    pub aggregation_method: AggregationMethod,
    /// What maintenance compares with; default mrlep.
    pub maintenance_method: MaintenanceMethod,
    /// How transfer compares; default ratio.
    pub transfer_method: TransferMethod,
    /// How performances are scaled; default per task.
    pub normalization_method: NormalizationMethod,
    /// Window shape; default flat.
    pub smoothing_method: SmoothingMethod,
    /// Whether evaluation regimes are smoothed too; default no.
    pub smooth_eval_data: bool,
    /// Window length in experiences, at most [`MAX_WINDOW_LENGTH`]; default none: a fifth of the data, at most 100.
    pub window_length: Option<usize>,
    /// Whether performances outside the given range, or else the 0.1 and 0.9 quantiles, are clipped; default no.
    pub clamp_outliers: bool,
    /// Known range per task, lower-case name; default none: taken from the data. When given, every task needs one.
    pub data_range: Option<DataRanges>,
    /// Floor and ceiling per task, lower-case name; default none. A task without one, or with a ceiling that is not
    /// above its floor, is scaled by its own range. Ranges in `data_range` come before.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scales: Option<Scales>,
    /// Normal noise on the lifetime's performances, not on the experts'; default none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub noise: Option<Noise>,
    /// Whose definitions count; default the reference's.
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
    /// Checks what the types cannot: window length and data ranges.
    ///
    /// # Errors
    /// [`MetricsError::BadOption`] for a window of 0 or over [`MAX_WINDOW_LENGTH`], or a range that is not finite or
    /// has its minimum above its maximum.
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
    fn words_are_read_back_and_strangers_are_told_the_words() {
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
    fn options_survive_json_and_missing_ones_take_their_default() {
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
