//! Scores a lifetime: one file per metric, and shared parts.

mod assessment;
mod average_performance;
mod exchange;
mod null_bands;
mod performance_maintenance;
mod performance_recovery;
mod sample_efficiency;
mod saturation;
mod scorer;
mod ste_relative_performance;
mod terminal_performance;
mod transfer;

pub use assessment::Assessment;
pub use null_bands::NULL_PERMUTATIONS;
pub use scorer::{Scorer, score};

use crate::results::Headline;
use crate::{MaintenanceMethod, MetricsError, Options, TransferMethod};

/// The metrics of this crate, in the order in which they are computed and shown.
fn built_in() -> Vec<Box<dyn Metric>> {
    vec![
        Box::new(saturation::Saturation),
        Box::new(terminal_performance::TerminalPerformance),
        Box::new(performance_recovery::PerformanceRecovery),
        Box::new(average_performance::AveragePerformance),
        Box::new(performance_maintenance::PerformanceMaintenance),
        Box::new(transfer::Transfer),
        Box::new(ste_relative_performance::SteRelativePerformance),
        Box::new(sample_efficiency::SampleEfficiency),
    ]
}

/// The headlines of the metrics of this crate, whatever was requested.
pub(crate) fn built_in_headlines() -> Vec<Headline> {
    let metrics = built_in();
    metrics
        .iter()
        .flat_map(|metric| metric.headlines(&all_asked()))
        .collect()
}

/// Options that request every value.
fn all_asked() -> Options {
    Options {
        maintenance_method: MaintenanceMethod::Both,
        transfer_method: TransferMethod::Both,
        ..Options::default()
    }
}

/// A measure of a lifetime. The crate's own metrics implement this trait, too; a [`Scorer`](crate::Scorer) takes further ones.
///
/// A metric reads the regimes of a preprocessed lifetime and the values of earlier metrics, and sets values: for regimes
/// (columns of the regime table), for tasks (the numbers, and the lists behind them), for the lifetime. If it sets a headline
/// for tasks only, the lifetime's value is their mean or median, depending on the options. One scorer may score many lifetimes
/// in parallel, hence `Send` and `Sync`.
///
/// ```
/// use driftworld_metrics::{Assessment, BlockType, Direction, Headline, Metric, MetricsError, Options};
///
/// /// The worst that a task came to in an evaluation.
/// struct WorstEvaluation;
///
/// impl Metric for WorstEvaluation {
///     fn headlines(&self, _: &Options) -> Vec<Headline> {
///         vec![Headline::new("worst_eval_perf", "how bad did it get? worst mean of an evaluation", Direction::Higher)]
///     }
///
///     fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
///         for task in assessment.lifetime().tasks().to_vec() {
///             let regimes = assessment.lifetime().regimes_of(&task);
///             let evaluations = regimes.filter(|regime| regime.block_type == BlockType::Test);
///             let terminal = evaluations.filter_map(|regime| assessment.term_perf(regime.regime_num));
///             assessment.set_task(&task, "worst_eval_perf", terminal.reduce(f64::min));
///         }
///         Ok(())
///     }
/// }
/// ```
pub trait Metric: Send + Sync {
    /// The main values that this metric sets with these options, in order. Their names must be unique to it. None by default.
    fn headlines(&self, _options: &Options) -> Vec<Headline> {
        Vec::new()
    }

    /// Computes the metric.
    ///
    /// # Errors
    /// If it cannot be computed although the lifetime has what it needs; a missing input is not an error, the value is then
    /// left out. [`MetricsError::Metric`] is for errors of a user's metric.
    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError>;
}
