//! [`Metric`]: a measure of a lifetime.

use super::assessment::Assessment;
use crate::results::Headline;
use crate::{MetricsError, Options};

/// A measure of a lifetime. The crate's own metrics also implement this trait; a [`Scorer`](crate::Scorer) takes further ones.
///
/// A metric reads the regimes of a preprocessed lifetime and the values of earlier metrics, and sets values: for regimes
/// (columns of the regime table), for tasks (the numbers, and the lists behind them), for the lifetime. If it sets a headline
/// for tasks only, the lifetime's value is their mean or median, depending on the options. One scorer may score many lifetimes
/// in parallel, hence `Send` and `Sync`.
///
/// ```
/// use driftworld_metrics::{Assessment, BlockType, Direction, Headline, Metric, MetricsError, Options};
///
/// /// The worst mean of an evaluation, for each task.
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
    /// Any error that keeps the metric from being computed; a user's metric returns [`MetricsError::Metric`]. A missing input is not
    /// an error: the value is left out.
    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError>;
}
