//! Null bands: the range of values to expect if the agent had never changed, and the resulting reading.

use serde::{Deserialize, Serialize};

use super::reading::MAX_P_VALUE;
use super::{Direction, Reading};
use crate::statistics::quantile;

/// The unit of permutation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Exchanged {
    /// The rows of each world.
    Worlds,
    /// Rows by position in the evaluation: the log does not give their worlds, or no world is repeated.
    Positions,
    /// By world if a world is repeated, otherwise by position.
    WorldsAndPositions,
}

/// A value of a lifetime compared with those of the same log with permuted evaluations.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NullBand {
    /// The value of the lifetime.
    pub value: f64,
    /// Lower end of the central 95 % of permuted values.
    pub low: f64,
    /// Upper end of the central 95 % of permuted values.
    pub high: f64,
    /// Two-sided p-value: twice the smaller of the shares of values at least as low and at least as high, including its own;
    /// at most 1.
    pub p: f64,
    /// The unit of permutation.
    pub exchanged: Exchanged,
    /// Standard error of the value, from the errors of its evaluations over worlds, taken as independent: different worlds
    /// would give different scores. `None` if one of them is unknown, or there are more than 2,000 evaluations.
    #[serde(default)]
    pub standard_error: Option<f64>,
}

/// Relative tolerance for rounding when the same terms are summed in a different order.
const ROUNDING: f64 = 1e-9;

impl NullBand {
    /// Builds the band from the lifetime's value and the permuted values; `None` if there are no permuted values.
    pub(crate) fn new(value: f64, permuted: &[f64], exchanged: Exchanged) -> Option<Self> {
        let (low, high) = (quantile(permuted, 0.025)?, quantile(permuted, 0.975)?);
        let slack = ROUNDING * value.abs().max(1.0);
        let share = |is_extreme: &dyn Fn(f64) -> bool| {
            let extreme = permuted.iter().filter(|drawn| is_extreme(**drawn)).count();
            (extreme + 1) as f64 / (permuted.len() + 1) as f64
        };
        let below = share(&|drawn| drawn <= value + slack);
        let above = share(&|drawn| drawn >= value - slack);
        Some(Self {
            value,
            low,
            high,
            p: (2.0 * below.min(above)).min(1.0),
            exchanged,
            standard_error: None,
        })
    }

    /// Whether the value lies outside the band by more than rounding.
    pub fn is_outside(&self) -> bool {
        let slack = ROUNDING * self.value.abs().max(1.0);
        self.value < self.low - slack || self.value > self.high + slack
    }

    /// Whether the value is within two standard errors of the neutral value; `None` if either is unknown.
    pub fn is_within_two_errors(&self, good: Direction) -> Option<bool> {
        Some((self.value - good.neutral()?).abs() < 2.0 * self.standard_error?)
    }

    /// The reading from the band alone, given the good direction: good or bad if the value lies outside the band, `p` is at most
    /// 0.05, and the value is on that side of the neutral value, by at least two standard errors if its error is known.
    pub fn reading(&self, good: Direction) -> Reading {
        let is_noise = !self.is_outside() || self.p > MAX_P_VALUE || self.is_within_two_errors(good) == Some(true);
        if is_noise {
            return Reading::Unclear;
        }
        let is_high = self.value > self.high;
        match good.neutral() {
            Some(neutral) if self.value == neutral || (self.value > neutral) != is_high => Reading::Unclear,
            _ if is_high == good.is_higher() => Reading::Good,
            _ => Reading::Bad,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn band(value: f64) -> NullBand {
        let permuted: Vec<f64> = (0..=1000).map(|number| f64::from(number) / 500.0 - 1.0).collect();
        NullBand::new(value, &permuted, Exchanged::Worlds).expect("there are values")
    }

    #[test]
    fn band_is_the_central_95_percent() {
        let found = band(0.0);
        assert!(
            (found.low + 0.95).abs() < 1e-12 && (found.high - 0.95).abs() < 1e-12,
            "{found:?}"
        );
        assert_eq!(found.p, 1.0);
        assert_eq!(band(5.0).p, 2.0 / 1002.0);
        assert_eq!(NullBand::new(1.0, &[], Exchanged::Worlds), None);
    }

    #[test]
    fn good_requires_values_outside_the_band_and_beyond_the_neutral_value() {
        let check = |value: f64, good: Direction, expected: Reading| {
            assert_eq!(band(value).reading(good), expected, "{value} {good:?}");
        };
        check(0.9, Direction::HigherThan(0.0), Reading::Unclear);
        check(0.96, Direction::HigherThan(0.0), Reading::Good);
        check(-0.96, Direction::HigherThan(0.0), Reading::Bad);
        check(0.96, Direction::LowerThan(0.0), Reading::Bad);
        check(-0.96, Direction::LowerThan(0.0), Reading::Good);
        // Above the band, but still a loss: unclear.
        check(0.96, Direction::HigherThan(1.0), Reading::Unclear);
        check(-0.96, Direction::HigherThan(-2.0), Reading::Unclear);
        check(0.96, Direction::Higher, Reading::Good);
        check(0.96, Direction::Lower, Reading::Bad);
    }
}
