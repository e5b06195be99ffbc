//! Terminal performance: the performance at the end of a regime.

use super::assessment::Assessment;
use super::metric::Metric;
use crate::statistics::mean;
use crate::{BlockType, Definitions, MetricsError};

/// `term_perf` and `exp_to_term_perf` of every regime.
pub(super) struct TerminalPerformance;

impl Metric for TerminalPerformance {
    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        for regime in assessment.lifetime().regimes() {
            let (value, experiences) = end(
                &regime.per_experience(),
                regime.block_type,
                assessment.options().definitions,
            );
            assessment.set_regime(regime.regime_num, "term_perf", Some(value));
            assessment.set_regime(regime.regime_num, "exp_to_term_perf", Some(experiences));
        }
        Ok(())
    }
}

/// The mean over the end of a regime, which is at least one experience, and the number of experiences before the middle of the end.
///
/// QUIRK: the end begins at `(1 − 0.1) · n` in floating point, rounded down. Under the published definitions it begins at nine
/// tenths of n, rounded down. A test checks that the two agree below a million experiences.
fn end(per_experience: &[f64], block_type: BlockType, definitions: Definitions) -> (f64, usize) {
    let num = per_experience.len();
    let (begin, experiences) = match (block_type, definitions) {
        (BlockType::Test, _) => (0, num / 2),
        (BlockType::Train, Definitions::Reference) => end_in_floating_point(num),
        (BlockType::Train, Definitions::Published) => end_in_integers(num),
    };
    (mean(&per_experience[begin..]).unwrap_or(0.0), experiences)
}

/// Where the last tenth begins, and its midpoint. The casts are exact: both products lie in `0..num`.
fn end_in_floating_point(num: usize) -> (usize, usize) {
    let num = num as f64;
    (((1.0 - 0.1) * num) as usize, ((1.0 - 0.1 / 2.0) * num) as usize)
}

fn end_in_integers(num: usize) -> (usize, usize) {
    (num * 9 / 10, num * 19 / 20)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn end_is_the_last_tenth_of_learning_or_the_whole_evaluation() {
        let check = |num: u32, block_type: BlockType, value: f64, experiences: usize| {
            let values: Vec<f64> = (0..num).map(f64::from).collect();
            for &definitions in Definitions::ALL {
                let found = end(&values, block_type, definitions);
                assert_eq!(found, (value, experiences), "{num} {block_type} {definitions}");
            }
        };
        check(1, BlockType::Train, 0.0, 0);
        check(10, BlockType::Train, 9.0, 9);
        check(15, BlockType::Train, 13.5, 14);
        check(100, BlockType::Train, 94.5, 95);
        check(1, BlockType::Test, 0.0, 0);
        check(21, BlockType::Test, 10.0, 10);
    }

    #[test]
    fn floating_point_and_integer_ends_agree_below_a_million() {
        let differ = (0..1_000_000).find(|num| end_in_floating_point(*num) != end_in_integers(*num));
        assert_eq!(differ, None);
    }
}
