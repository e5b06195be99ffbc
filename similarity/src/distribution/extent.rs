//! Where nearly all numbers of a distribution lie: what distances are normalised by. The distances are beside.

use driftworld_spec::Distribution;

use super::law::{Law, draws_headings};

/// Probability of a normal number three standard deviations below its mean.
const TAIL: f64 = 0.001_349_898_031_630_094_6;

/// The range that nearly all of a distribution's numbers lie in: its ends, or where it has none the quantiles that three
/// standard deviations of a normal have (0.135% of the numbers lie beyond each).
///
/// `None` if it draws no numbers.
///
/// # Example
/// ```
/// use driftworld_similarity::distribution::extent;
/// use driftworld_spec::Distribution::{Normal, Uniform};
/// assert_eq!(extent(&Uniform { low: 1.0, high: 5.0 }), Some([1.0, 5.0]));
/// let [low, high] = extent(&Normal { mean: 0.0, std: 1.0 }).unwrap();
/// assert!((low + 3.0).abs() < 1e-9 && (high - 3.0).abs() < 1e-9);
/// ```
pub fn extent(distribution: &Distribution) -> Option<[f64; 2]> {
    if draws_headings(distribution) {
        return Some([0.0, 360.0]);
    }
    let [low, high] = match distribution {
        Distribution::Poisson { .. } | Distribution::Geometric { .. } => [0.0, f64::INFINITY],
        Distribution::Binomial { n, .. } => [0.0, *n],
        other => Law::of(other)?.ends(),
    };
    Some([
        if low.is_finite() {
            low
        } else {
            distribution.quantile(TAIL)?
        },
        if high.is_finite() {
            high
        } else {
            distribution.quantile(1.0 - TAIL)?
        },
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    use Distribution::{Poisson, Uniform, VonMises};

    #[test]
    fn headings_lie_all_round_and_counts_where_nearly_all_of_them_are() {
        assert_eq!(extent(&VonMises { mean: 0.0, kappa: 1.0 }), Some([0.0, 360.0]));
        assert_eq!(extent(&Uniform { low: -10.0, high: 0.0 }), Some([-10.0, 0.0]));
        assert_eq!(extent(&Poisson { mean: 1.0 }), Some([0.0, 5.0]));
    }
}
