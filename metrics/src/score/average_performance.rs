//! Average performance during learning and during evaluation.

use super::assessment::Assessment;
use super::metric::Metric;
use crate::results::{Direction, Headline};
use crate::statistics::mean;
use crate::{BlockType, MetricsError, Options};

/// `avg_perf` of every regime; `avg_train_perf` and `avg_eval_perf` of every task, the means of its regimes' means, each with
/// equal weight whatever its length.
///
/// Wake evaluations of a lifetime with sleep blocks have no `avg_perf`.
pub(super) struct AveragePerformance;

impl Metric for AveragePerformance {
    fn headlines(&self, _: &Options) -> Vec<Headline> {
        vec![
            Headline::new(
                "avg_train_perf",
                "mean performance while learning; by default 1 is the worst and 101 the best seen in each task",
                Direction::Higher,
            ),
            Headline::new(
                "avg_eval_perf",
                "mean performance in evaluations; by default 1 is the worst and 101 the best seen in each task",
                Direction::Higher,
            ),
        ]
    }

    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        let lifetime = assessment.lifetime();
        for regime in lifetime.regimes().iter().filter(|regime| lifetime.is_assessed(regime)) {
            assessment.set_regime(regime.regime_num, "avg_perf", mean(&regime.performance));
        }
        for task in lifetime.tasks() {
            for (name, list, block_type) in [
                ("avg_train_perf", "avg_train_perf_vals", BlockType::Train),
                ("avg_eval_perf", "avg_eval_perf_vals", BlockType::Test),
            ] {
                let regimes = lifetime
                    .regimes_of(task)
                    .filter(|regime| regime.block_type == block_type);
                let averages: Vec<f64> = regimes
                    .filter_map(|regime| assessment.regime(regime.regime_num)?.number("avg_perf"))
                    .collect();
                assessment.set_task(task, name, mean(&averages));
                assessment.set_task(task, list, Some(averages));
            }
        }
        Ok(())
    }
}
