//! Aggregates over all runs and strata: mean, median, interquartile mean.

use super::resample::Resample;
use crate::statistics::{mean, median};

/// How the scores of all runs and strata are aggregated. The numbers match rliable 1.2, see `tests/oracles/`.
///
/// Mean and median weight strata equally. The interquartile mean weights scores equally, so if runs lack scores, strata with
/// more scores count for more.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Aggregate {
    /// Mean of the strata's means. Sensitive to outliers.
    Mean,
    /// Median of the strata's means. Insensitive to most strata: nearly half of the means may be 0 without changing it.
    Median,
    /// Mean of the middle half of all scores (interquartile mean): ⌊n/4⌋ are left out at either end. Recommended: robust to
    /// outliers, but still uses every stratum.
    Iqm,
}

impl Aggregate {
    /// The aggregate of a resample.
    pub(super) fn of(self, resample: &Resample) -> f64 {
        let value = match self {
            Self::Mean => mean(&resample.stratum_means().collect::<Vec<_>>()),
            Self::Median => median(resample.stratum_means().collect()),
            Self::Iqm => Some(middle_mean(resample)),
        };
        value.expect("a table has a score, and a resample draws at least one")
    }
}

/// Mean without the lowest and the highest quarter, like `scipy.stats.trim_mean(scores, 0.25)`.
fn middle_mean(resample: &Resample) -> f64 {
    let num_drawn = resample.num_drawn();
    let num_trimmed = num_drawn / 4;
    let (first, end) = (num_trimmed, num_drawn - num_trimmed);
    let (mut sum, mut position) = (0.0, 0);
    for (score, count) in resample.scores.iter().zip(&resample.counts) {
        let next = position + u64::from(*count);
        let counted = next.min(end).saturating_sub(position.max(first));
        sum += score * counted as f64;
        position = next;
    }
    sum / (end - first) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ScoreTable;

    fn check(scores: &[f64], aggregate: Aggregate, expected: f64) {
        let runs = scores
            .iter()
            .enumerate()
            .map(|(run, score)| (run.to_string(), [("a", *score)]));
        let table = ScoreTable::from_runs(runs).unwrap();
        assert_eq!(aggregate.of(&Resample::new(&table)), expected, "{scores:?}");
    }

    #[test]
    fn interquartile_mean_drops_whole_scores_at_either_end() {
        check(&[7.0], Aggregate::Iqm, 7.0);
        check(&[1.0, 2.0, 9.0], Aggregate::Iqm, 4.0);
        check(&[1.0, 2.0, 4.0, 900.0], Aggregate::Iqm, 3.0);
        check(&[1.0, 2.0, 3.0, 4.0, 900.0], Aggregate::Iqm, 3.0);
        check(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 900.0], Aggregate::Iqm, 3.5);
    }

    #[test]
    fn strata_have_equal_weight_in_mean_and_median() {
        let runs = [
            ("1", vec![("a", 1.0), ("b", 10.0), ("c", 0.0)]),
            ("2", vec![("a", 3.0)]),
        ];
        let resample = Resample::new(&ScoreTable::from_runs(runs).unwrap());
        assert_eq!(Aggregate::Mean.of(&resample), 4.0);
        assert_eq!(Aggregate::Median.of(&resample), 2.0);
    }
}
