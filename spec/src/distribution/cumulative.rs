//! Cumulative distribution functions (CDFs) of all distributions of numbers. The inverse is in `quantile.rs`.

use super::moments::ends;
use super::special::{beta_below, normal_cdf};
use super::{Distribution, discrete, von_mises};
use crate::value::Value;

impl Distribution<f64> {
    /// Probability that a draw is at most `x`; false counts as 0 and true as 1.
    ///
    /// Headings are accumulated clockwise, starting opposite the mean direction: `x` is first wrapped into `mean − 180° ≤ x <
    /// mean + 180°`. Closed forms with an absolute error below 1e-10 (much lower, except for counts near 100,000); `von_mises`
    /// by quadrature, below 1e-12. `None` if it draws no numbers.
    pub fn cdf(&self, x: f64) -> Option<f64> {
        Some(match self {
            Self::Constant { value } => step(x >= value.as_number()?),
            Self::Choice { values, weights } => {
                let reached = |value: &Value| Some(step(value.as_number()? <= x));
                mean_of(values.iter().map(reached), weights.as_deref())?
            }
            Self::Uniform { low, high } => ((x - low) / (high - low)).clamp(0.0, 1.0),
            Self::IntegerUniform { low, high } => ((x.floor() - low + 1.0) / (high - low + 1.0)).clamp(0.0, 1.0),
            Self::Normal { mean, std } if *std == 0.0 => step(x >= *mean),
            Self::Normal { mean, std } => normal_cdf((x - mean) / std),
            Self::TruncatedNormal { mean, std, low, high } => truncated(x, *mean, *std, *low, *high),
            Self::LogNormal { .. } if x <= 0.0 => 0.0,
            Self::LogNormal { mu, sigma } if *sigma == 0.0 => step(libm::log(x) >= *mu),
            Self::LogNormal { mu, sigma } => normal_cdf((libm::log(x) - mu) / sigma),
            Self::Exponential { rate } => -libm::expm1(-rate * x.max(0.0)),
            Self::Beta { alpha, beta, low, high } => {
                let (low, width) = ends(*low, *high);
                beta_below((x - low) / width, *alpha, *beta)
            }
            Self::Triangular { low, mode, high } => triangular(x, *low, *mode, *high),
            Self::Perturb {
                value,
                noise,
                low,
                high,
            } => {
                if high.is_some_and(|high| x >= high) {
                    1.0
                } else if low.is_some_and(|low| x < low) {
                    0.0
                } else if *noise == 0.0 {
                    step(x >= *value)
                } else {
                    ((x - (value - noise)) / (2.0 * noise)).clamp(0.0, 1.0)
                }
            }
            Self::VonMises { mean, kappa } => {
                let turned = (x - mean + 180.0).rem_euclid(360.0) - 180.0;
                von_mises::cdf(turned.to_radians(), *kappa)
            }
            Self::Bernoulli { p } => {
                if x < 0.0 {
                    0.0
                } else if x < 1.0 {
                    1.0 - p
                } else {
                    1.0
                }
            }
            Self::Binomial { n, p } => discrete::binomial_cdf(x, *n, *p),
            Self::Poisson { mean } => discrete::poisson_cdf(x, *mean),
            Self::Geometric { p } => discrete::geometric_cdf(x, *p),
            Self::Mixture { parts, weights } => mean_of(parts.iter().map(|part| part.cdf(x)), weights.as_deref())?,
            _ => return None,
        })
    }
}

/// The mean of the probabilities of parts, weighted if there are weights.
fn mean_of(parts: impl Iterator<Item = Option<f64>>, weights: Option<&[f64]>) -> Option<f64> {
    let (mut sum, mut total) = (0.0, 0.0);
    for (k, part) in parts.enumerate() {
        let weight = weights.map_or(1.0, |weights| weights[k]);
        sum += weight * part?;
        total += weight;
    }
    Some(sum / total)
}

fn step(reached: bool) -> f64 {
    if reached { 1.0 } else { 0.0 }
}

fn truncated(x: f64, mean: f64, std: f64, low: f64, high: f64) -> f64 {
    if x <= low {
        return 0.0;
    }
    if x >= high {
        return 1.0;
    }
    let z = |x: f64| (x - mean) / std;
    if z(low) > 0.0 {
        // Probabilities close to 1 lose digits in the upper tail; the mirror image keeps them.
        return 1.0 - truncated(-x, -mean, std, -high, -low);
    }
    (normal_cdf(z(x)) - normal_cdf(z(low))) / (normal_cdf(z(high)) - normal_cdf(z(low)))
}

fn triangular(x: f64, low: f64, mode: f64, high: f64) -> f64 {
    if x <= low {
        0.0
    } else if x >= high {
        1.0
    } else if x < mode {
        (x - low) * (x - low) / ((high - low) * (mode - low))
    } else {
        1.0 - (high - x) * (high - x) / ((high - low) * (high - mode))
    }
}
