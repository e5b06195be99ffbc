//! What a metric is, ours or a user's.
//!
//! Not here: what a metric sees, see `assessment`, and in which order metrics are computed, see `scorer`.

use super::Assessment;
use crate::results::Headline;
use crate::{MetricsError, Options};

/// A measure of a lifetime. The crate's own are computed through this trait, too; a [`Scorer`](crate::Scorer) takes
/// others beside them.
///
/// A metric looks at the regimes of a preprocessed lifetime and at what metrics before it found, and sets values: for
/// regimes (columns of the regime table), for tasks (the numbers, and the lists behind them), for the lifetime. Where
/// it sets a headline for tasks only, the lifetime's value is their mean or median, as the options say. One scorer may
/// score many lifetimes at once, hence `Send` and `Sync`.
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
    /// The values by which a lifetime is known that this metric sets under these options, in order. Their names must be its
    /// own.
    fn headlines(&self, options: &Options) -> Vec<Headline>;

    /// Computes the metric.
    ///
    /// # Errors
    /// Where it cannot be computed although the lifetime has what it needs; a value for which something is missing
    /// is not an error, it is left out. [`MetricsError::Metric`] is there for errors of a user's metric.
    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError>;
}
