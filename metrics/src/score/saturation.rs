//! Saturation: the best performance reached, and the time until then.

use super::assessment::Assessment;
use super::metric::Metric;
use crate::preprocess::smoothed;
use crate::{Definitions, MetricsError, SmoothingMethod};

/// `saturation` and `exp_to_sat` of every regime.
pub(super) struct Saturation;

impl Metric for Saturation {
    fn judge(&self, assessment: &mut Assessment<'_>) -> Result<(), MetricsError> {
        for regime in assessment.lifetime().regimes() {
            let peak = peak(&regime.per_experience(), assessment);
            assessment.set_regime(regime.regime_num, "saturation", Some(peak.value));
            assessment.set_regime(regime.regime_num, "exp_to_sat", Some(peak.experiences));
        }
        Ok(())
    }
}

/// Best performance, and where it is first reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Peak {
    /// Largest smoothed performance.
    pub(super) value: f64,
    /// Number of experiences before it.
    pub(super) experiences: usize,
}

/// Peak of one performance per experience; without experiences, a value of 0 after 0 experiences.
///
/// QUIRK: the data are smoothed again with a flat window of default length, on top of the preprocessing, whatever smoothing was
/// chosen there. Under the published definitions, they are not.
///
/// Additions run in a fixed order, so the result is the same on every machine. If several windows tie in exact arithmetic,
/// rounding decides which is the first maximum, and the reference's rounding may differ. With `resolves_ties`, the first
/// within a billionth is taken.
pub(super) fn peak(per_experience: &[f64], assessment: &Assessment<'_>) -> Peak {
    let resmoothed;
    let values = match assessment.options().definitions {
        Definitions::Reference => {
            resmoothed = smoothed(per_experience, None, SmoothingMethod::Flat);
            &resmoothed
        }
        Definitions::Published => per_experience,
    };
    first_maximum(values, assessment.slack(values))
}

/// The maximum, and the first index that reaches it within this slack.
fn first_maximum(values: &[f64], slack: f64) -> Peak {
    let higher = |best: f64, value: f64| if value > best { value } else { best };
    let value = values.iter().copied().reduce(higher).unwrap_or(0.0);
    let reached = values.iter().position(|other| *other >= value - slack);
    Peak {
        value,
        experiences: reached.unwrap_or(0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_maximum_counts() {
        let check = |values: &[f64], slack: f64, value: f64, experiences: usize| {
            assert_eq!(first_maximum(values, slack), Peak { value, experiences });
        };
        check(&[], 0.0, 0.0, 0);
        check(&[4.0], 0.0, 4.0, 0);
        check(&[1.0, 3.0, 2.0, 3.0], 0.0, 3.0, 1);
        check(&[-2.0, -1.0], 0.0, -1.0, 1);
        let next = f64::from_bits(0.3_f64.to_bits() + 1);
        check(&[0.1, 0.3, 0.3, next], 0.0, next, 3);
        check(&[0.1, 0.3, 0.3, next], 1e-9, next, 1);
    }
}
