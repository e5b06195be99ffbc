//! Performance profiles: which share of all scores lies above a threshold, for many thresholds.
//!
//! Not here: drawing them.

use super::estimate::estimate_each;
use super::resample::Resample;
use super::score_table::{MAX_SCORES, wrong};
use super::{BootstrapOptions, Estimate, ScoreTable};
use crate::MetricsError;

/// Share of all runs and strata whose score is above each threshold, with a pointwise interval.
///
/// Corresponds to `score_distributions` of rliable 1.2. Where the profile of one agent lies above that of another at every
/// threshold, the first is better whatever score one asks for.
///
/// `thresholds`: in the unit of the scores, in any order. Returns shares in `0..=1`, one per threshold.
///
/// # Errors
/// [`MetricsError::Scores`] for a threshold that is not a number, [`MetricsError::BadOption`] for options that
/// [`estimate`](super::estimate()) refuses as well and for so many thresholds and resamples that the shares fill more memory than
/// a hundred tables.
pub fn performance_profile(
    table: &ScoreTable,
    thresholds: &[f64],
    options: &BootstrapOptions,
) -> Result<Vec<Estimate>, MetricsError> {
    if thresholds.iter().any(|threshold| threshold.is_nan()) {
        return Err(wrong("thresholds of the profile".to_owned(), "NaN", "numbers"));
    }
    options.check(table.num_scores())?;
    let limit = 100 * MAX_SCORES;
    if thresholds.len().saturating_mul(options.resamples as usize) > limit {
        return Err(MetricsError::BadOption {
            option: "resamples",
            found: format!("{} for {} thresholds", options.resamples, thresholds.len()),
            expected: format!("a product of at most {limit}"),
        });
    }
    let sorted = Resample::new(table).scores;
    let firsts: Vec<usize> = thresholds
        .iter()
        .map(|threshold| sorted.partition_point(|score| score <= threshold))
        .collect();
    // How many were drawn at each position or after it.
    let mut above = vec![0; sorted.len() + 1];
    Ok(estimate_each(table, thresholds.len(), options, |resample, shares| {
        for position in (0..sorted.len()).rev() {
            above[position] = above[position + 1] + resample.counts[position];
        }
        for (share, first) in shares.iter_mut().zip(&firsts) {
            *share = f64::from(above[*first]) / f64::from(above[0]);
        }
    }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_profile_falls_from_all_to_none() {
        let runs = [("1", [("a", 1.0), ("b", 2.0)]), ("2", [("a", 3.0), ("b", 4.0)])];
        let table = ScoreTable::from_runs(runs).unwrap();
        let thresholds = [f64::NEG_INFINITY, 0.5, 1.0, 2.5, 4.0];
        let profile = performance_profile(&table, &thresholds, &BootstrapOptions::default()).unwrap();
        let shares: Vec<f64> = profile.iter().map(|point| point.value).collect();
        assert_eq!(shares, [1.0, 1.0, 0.75, 0.5, 0.0]);
        let interval = profile[3].interval.unwrap();
        assert_eq!(
            (interval.low, interval.high),
            (0.0, 1.0),
            "each stratum has one score on either side"
        );
    }

    #[test]
    fn thresholds_must_be_numbers() {
        let table = ScoreTable::from_runs([("1", [("a", 1.0)])]).unwrap();
        let error = performance_profile(&table, &[f64::NAN], &BootstrapOptions::default()).unwrap_err();
        assert_eq!(
            error.to_string(),
            "scores, thresholds of the profile: found NaN, expected numbers"
        );
    }
}
