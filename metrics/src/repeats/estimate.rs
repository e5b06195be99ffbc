//! Estimates: aggregates with their confidence intervals.

use serde::{Deserialize, Serialize};

use super::jackknife::{FEW_RUNS, t_interval};
use super::resample::Resample;
use super::{Aggregate, BootstrapOptions, Interval, ScoreTable};
use crate::MetricsError;

/// A number with its uncertainty.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Estimate {
    /// Its value for the original scores.
    pub value: f64,
    /// Its bootstrap interval; `None` if resampling cannot vary it, because there is only one run. See [`ScoreTable::caution`]
    /// for warnings to readers.
    pub interval: Option<Interval>,
    /// Its Student's t interval over runs, which assumes normal variation between runs. Only for two to nine runs, for which the
    /// bootstrap is too narrow. For a mean of runs that all have the same strata it is the textbook interval; otherwise the
    /// jackknife gives the standard error.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub t_interval: Option<Interval>,
}

impl Estimate {
    /// The recommended interval: Student's t for few runs, otherwise the bootstrap.
    pub fn best_interval(&self) -> Option<Interval> {
        self.t_interval.or(self.interval)
    }
}

/// Aggregates of a table with their percentile bootstrap intervals, all from the same resamples; with fewer than
/// [`FEW_RUNS`] runs, also with Student's t intervals.
///
/// Time `O(resamples · scores)`: 50,000 resamples of 10 runs of 10 strata take about a tenth of a second.
///
/// # Errors
/// [`MetricsError::BadOption`] for a confidence that is not between 0 and 1, too few resamples for this confidence, or more
/// than [`MAX_RESAMPLES`](super::MAX_RESAMPLES) or [`MAX_SCORES_DRAWN`](super::MAX_SCORES_DRAWN) allows.
///
/// # Example
/// See [`ScoreTable`].
pub fn estimate<const N: usize>(
    table: &ScoreTable,
    aggregates: [Aggregate; N],
    options: &BootstrapOptions,
) -> Result<[Estimate; N], MetricsError> {
    options.check(table.num_scores())?;
    let of_all = |resample: &Resample| aggregates.map(|aggregate| aggregate.of(resample));
    let mut resample = Resample::new(table);
    let mut estimates = of_all(&resample).map(|value| Estimate {
        value,
        interval: None,
        t_interval: None,
    });
    if table.varies(options.resampling) {
        let mut drawn = [(); N].map(|()| Vec::with_capacity(options.resamples as usize));
        let mut rng = options.rng();
        for _ in 0..options.resamples {
            resample.draw(options.resampling, &mut rng);
            for (drawn, value) in drawn.iter_mut().zip(of_all(&resample)) {
                drawn.push(value);
            }
        }
        for (estimate, drawn) in estimates.iter_mut().zip(&mut drawn) {
            estimate.interval = Some(options.interval(drawn));
        }
    }
    if (2..FEW_RUNS).contains(&table.num_runs()) {
        let mut left_out = Vec::new();
        for run in 0..table.num_runs() {
            if resample.leave_out(run) {
                left_out.push(of_all(&resample));
            }
        }
        for (k, estimate) in estimates.iter_mut().enumerate() {
            let values = left_out.iter().map(|values| values[k]).collect();
            estimate.t_interval = t_interval(estimate.value, &[values], options.confidence);
        }
    }
    Ok(estimates)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Resampling;

    const ALL: [Aggregate; 3] = [Aggregate::Mean, Aggregate::Median, Aggregate::Iqm];

    fn table(num_runs: u32) -> ScoreTable {
        let scores = |run: u32| [("a", f64::from(run * run % 7)), ("b", f64::from(run % 3) / 4.0)];
        ScoreTable::from_runs((0..num_runs).map(|run| (run.to_string(), scores(run)))).unwrap()
    }

    #[test]
    fn one_run_has_no_interval() {
        for resampling in [Resampling::Strata, Resampling::Runs] {
            let options = BootstrapOptions {
                resampling,
                ..BootstrapOptions::default()
            };
            assert!(
                estimate(&table(1), ALL, &options)
                    .unwrap()
                    .iter()
                    .all(|found| found.interval.is_none())
            );
            assert!(
                estimate(&table(2), ALL, &options)
                    .unwrap()
                    .iter()
                    .all(|found| found.interval.is_some())
            );
        }
    }

    /// A seed gives the same numbers on every machine. If these change, earlier results cannot be reproduced.
    #[test]
    fn intervals_are_reproducible() {
        let check = |resampling: Resampling, expected: (f64, f64)| {
            let options = BootstrapOptions {
                resampling,
                resamples: 500,
                seed: 1,
                ..BootstrapOptions::default()
            };
            let [iqm] = estimate(&table(6), [Aggregate::Iqm], &options).unwrap();
            let interval = iqm.interval.unwrap();
            assert_eq!(
                (iqm.value, (interval.low, interval.high)),
                (0.75, expected),
                "{resampling}"
            );
        };
        check(Resampling::Strata, (0.25, 1.583_333_333_333_333_3));
        check(Resampling::Runs, (0.144_791_666_666_667_1, 1.627_083_333_333_331_4));
    }

    #[test]
    fn both_resamplings_agree_for_one_stratum() {
        let table = ScoreTable::from_runs((0..9_u32).map(|run| (run.to_string(), [("a", f64::from(run))]))).unwrap();
        let interval = |resampling| {
            let options = BootstrapOptions {
                resampling,
                ..BootstrapOptions::default()
            };
            estimate(&table, [Aggregate::Mean], &options).unwrap()[0].interval
        };
        assert_eq!(interval(Resampling::Strata), interval(Resampling::Runs));
    }
}
