//! Bootstrap options, such as the number and unit of resamples, and the intervals that result.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use serde::{Deserialize, Serialize};

use super::{Interval, Resampling};
use crate::MetricsError;
use crate::statistics::quantile;

/// Maximum number of resamples per interval.
pub const MAX_RESAMPLES: u32 = 1_000_000;

/// Maximum number of scores drawn per interval, over all resamples: about a minute's work.
pub const MAX_SCORES_DRAWN: u64 = 10_000_000_000;

/// Options of bootstrap intervals.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct BootstrapOptions {
    /// Share of repetitions of the whole experiment whose interval should contain the true value; between 0 and 1, default
    /// 0.95.
    pub confidence: f64,
    /// Number of resamples, at most [`MAX_RESAMPLES`]; default 2,000. With the default, the 2.5 % left out at each end vary by
    /// 0.35 % (one standard deviation), less than the uncertainty from a handful of runs. Use 50,000, as rliable does, for a
    /// figure to publish.
    pub resamples: u32,
    /// The unit of resampling; default whole runs.
    pub resampling: Resampling,
    /// Seed of the resamples; default 0. The same seed gives the same interval on every machine.
    pub seed: u64,
}

impl Default for BootstrapOptions {
    fn default() -> Self {
        Self {
            confidence: 0.95,
            resamples: 2_000,
            resampling: Resampling::Runs,
            seed: 0,
        }
    }
}

impl BootstrapOptions {
    /// Checks the options for tables with this number of scores.
    pub(super) fn check(&self, num_scores: usize) -> Result<(), MetricsError> {
        let wrong = |option: &'static str, found: String, expected: String| {
            Err(MetricsError::bad_option(option, found, expected))
        };
        if !(self.confidence > 0.0 && self.confidence < 1.0) {
            let expected = "a number between 0 and 1, e.g. 0.95";
            return wrong("confidence", self.confidence.to_string(), expected.to_owned());
        }
        let (resamples, confidence) = (self.resamples, self.confidence);
        // At least one resample must lie beyond each end of the interval; otherwise the ends would be meaningless.
        let min = (2.0 / (1.0 - confidence)).round().max(1.0);
        if f64::from(resamples) < min {
            let expected = format!("at least {min} for a confidence of {confidence}");
            return wrong("resamples", resamples.to_string(), expected);
        }
        let max = (MAX_SCORES_DRAWN / num_scores.max(1) as u64).min(u64::from(MAX_RESAMPLES));
        if u64::from(resamples) > max {
            let expected = format!("at most {max} for {num_scores} scores");
            return wrong("resamples", resamples.to_string(), expected);
        }
        Ok(())
    }

    /// The random stream of the resamples: `ChaCha` with 8 rounds, the same on every machine.
    pub(super) fn rng(&self) -> ChaCha8Rng {
        ChaCha8Rng::seed_from_u64(self.seed)
    }

    /// The interval between the percentiles that leave out equal shares at both ends.
    pub(super) fn interval(&self, values: &mut [f64]) -> Interval {
        values.sort_unstable_by(f64::total_cmp);
        let left_out = (1.0 - self.confidence) / 2.0;
        let percentile = |share| quantile(values, share).expect("there is at least one resample");
        Interval {
            low: percentile(left_out),
            high: percentile(1.0 - left_out),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_leave_out_equal_shares_at_both_ends() {
        let options = BootstrapOptions {
            confidence: 0.9,
            ..BootstrapOptions::default()
        };
        let mut values: Vec<f64> = (0..=100).rev().map(f64::from).collect();
        let interval = options.interval(&mut values);
        assert!(
            (interval.low - 5.0).abs() < 1e-12 && (interval.high - 95.0).abs() < 1e-12,
            "{interval:?}"
        );
    }

    #[test]
    fn meaningless_options_are_refused() {
        let check = |confidence: f64, resamples: u32, num_scores: usize, expected: &str| {
            let options = BootstrapOptions {
                confidence,
                resamples,
                ..BootstrapOptions::default()
            };
            assert_eq!(options.check(num_scores).unwrap_err().to_string(), expected);
        };
        let between = |found| format!("option confidence: found {found}, expected a number between 0 and 1, e.g. 0.95");
        check(95.0, 2_000, 1, &between("95"));
        check(f64::NAN, 2_000, 1, &between("NaN"));
        check(
            0.95,
            0,
            1,
            "option resamples: found 0, expected at least 40 for a confidence of 0.95",
        );
        check(
            0.999,
            500,
            1,
            "option resamples: found 500, expected at least 2000 for a confidence of 0.999",
        );
        check(
            0.95,
            2_000_000,
            10,
            "option resamples: found 2000000, expected at most 1000000 for 10 scores",
        );
        let many = "option resamples: found 50000, expected at most 10000 for 1000000 scores";
        check(0.95, 50_000, 1_000_000, many);
        assert!(BootstrapOptions::default().check(1_000_000).is_ok());
    }

    #[test]
    fn options_round_trip_through_json() {
        let options = BootstrapOptions {
            resampling: Resampling::Runs,
            seed: 7,
            ..BootstrapOptions::default()
        };
        let text = serde_json::to_string(&options).unwrap();
        assert_eq!(
            text,
            r#"{"confidence":0.95,"resamples":2000,"resampling":"runs","seed":7}"#
        );
        assert_eq!(serde_json::from_str::<BootstrapOptions>(&text).unwrap(), options);
    }
}
