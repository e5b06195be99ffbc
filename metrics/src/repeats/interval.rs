//! [`Interval`]: a confidence interval.

use serde::{Deserialize, Serialize};

/// A confidence interval. With the default options, a bootstrap interval contains the value for infinitely many runs in
/// about 92 of 100 repetitions with 20 runs, in 87 with 9, in 82 with 5, in 76 with 3: few runs underestimate their own
/// variation. Student's t interval contains it in 95, if scores are normally distributed.
/// `metrics/tests/repeats_coverage.rs` simulates both.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// Lower end, in the unit of the value.
    pub low: f64,
    /// Upper end.
    pub high: f64,
}

impl Interval {
    /// Whether a number lies within, ends included.
    pub fn contains(&self, number: f64) -> bool {
        (self.low..=self.high).contains(&number)
    }
}
