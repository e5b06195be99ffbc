//! Experience logs in the l2logger format and the lifelong-learning metrics computed from them.
//!
//! A *lifetime* is a sequence of learning blocks (`train`) and evaluation blocks (`test`) over several tasks. While it
//! runs, [`LogWriter`] writes one row per experience. Afterwards [`read_log`] reads the rows of this or any other agent that
//! logs in the l2logger format, and [`score`] measures what the agent retained, transferred and recovered.
//!
//! ```
//! use driftworld_metrics::{BlockType, LogWriter, LoggerInfo, Options, Record, ScenarioInfo, Timestamp, read_log, score};
//!
//! # fn main() -> Result<(), driftworld_metrics::MetricsError> {
//! # let base = tempfile::tempdir().unwrap();
//! let dir = base.path().join("two_blocks");
//! let mut writer = LogWriter::create(&dir, &LoggerInfo::new(["reward"])?, &ScenarioInfo::default())?;
//! for (exp_num, reward) in [(0, 1.0), (1, 3.0)] {
//!     let when = Timestamp::from_unix_micros(1_600_000_000_000_000 + exp_num as i64)?;
//!     writer.write(&Record::new(0, exp_num, BlockType::Train, "find_red", when).with_metric("reward", reward))?;
//! }
//! let metrics = score(&read_log(&dir)?, &[], &Options::default())?;
//! assert_eq!(metrics.lifetime.number("avg_train_perf"), Some(51.0), "rewards 1 and 3 are scaled to 1 and 101");
//! # Ok(())
//! # }
//! ```
//!
//! The definitions follow New et al. 2022, "Lifelong Learning Metrics"; the numbers match the public package l2metrics 3.1 to
//! 1e-9. Where that package departs from its documentation, a comment marked QUIRK explains it in the file that reproduces it;
//! [`Definitions::Published`] does not reproduce it. [`over_repeats`] aggregates repeated lifetimes, [`compare_agents`] compares
//! them, and a [`Scorer`] computes user-defined [`Metric`]s. The caller passes in time stamps.

mod choice;
mod error;
mod lifetime;
mod log;
mod options;
mod preprocess;
mod repeats;
mod results;
mod score;
mod statistics;
#[cfg(test)]
#[path = "../../tests/tier.rs"]
mod tier;

pub use error::{LogLine, MetricsError};
pub use lifetime::{Drift, Lifetime, MAX_REGIMES, Regime, SteLog, experts_serving, logged_word, read_ste_log};
pub use log::{
    BlockSubtype, BlockType, Complexity, DEFAULT_WORKER, Delimiter, Difficulty, ExpStatus, KeptRows,
    LOG_FORMAT_VERSION, Log, LogCounts, LogTable, LogWarning, LogWriter, LoggerInfo, MAX_CELL_BYTES, MAX_CELLS,
    MAX_COLUMNS, MAX_FILE_BYTES, MAX_JSON_BYTES, MAX_JSON_VALUES, MAX_LISTED, MAX_LOG_FILES, MAX_RECORDS, Record, Row,
    Rows, STANDARD_COLUMNS, ScenarioInfo, ScenarioType, SharedColumn, SteStoreMode, StoredRun, StoredTask, TaskParams,
    Timestamp, Validation, begun_log, find_ste, read_log, read_log_with_texts, store_ste, validate_log,
};
pub use options::{
    AggregationMethod, Anchors, DataRange, DataRanges, Definitions, MAX_WINDOW_LENGTH, MaintenanceMethod, Noise,
    NormalizationMethod, Options, Scales, SmoothingMethod, SteAveragingMethod, TransferMethod, Unlabelled, VariantMode,
};
pub use repeats::{
    Aggregate, BootstrapOptions, Estimate, FEW_RUNS, Improvement, Interval, MAX_POWER_LIFETIMES, MAX_RESAMPLES,
    MAX_RUNS, MAX_SCORES, MAX_SCORES_DRAWN, MAX_STRATA, POWER_LEVEL, POWER_WANTED, Resampling, ScoreTable,
    StratumImprovement, estimate, lifetimes_for, probability_of_improvement, smallest_effect, student_reach,
    welch_power,
};
pub use results::{
    AsLogged, BesideExpert, ComparedMetric, CurvePoint, Direction, EvaluationCell, EvaluationCurve, Exchanged,
    ExpertFit, Headline, LEARNED_SHARE, LifetimeMetrics, MAX_P_VALUE, MIN_AGREEING_SHARE, MetricPower, NullBand,
    PairValues, Part, Reached, Reading, RegimeMetrics, RepeatedMetric, ScaledBy, Settings, SummaryRow, Value, Values,
    WholeLifetime, compare_agents, metric_power, over_repeats, regimes_tsv, save_all,
};
pub use score::{Assessment, Metric, NULL_PERMUTATIONS, Scorer, score};

/// The Rust code in `docs/metrics.md` is compiled with the doc tests.
#[cfg(doctest)]
#[doc = include_str!("../../docs/metrics.md")]
struct Documentation;
