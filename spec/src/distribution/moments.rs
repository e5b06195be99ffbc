//! Mean and variance of distributions of numbers, and the type [`Moments`] for distributions of points or colours.

use std::array;

use super::Distribution;
use super::special::{normal_cdf, normal_density};
use crate::value::Value;

/// Mean and covariance of points in metres, or of red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments<const N: usize> {
    /// The mean.
    pub mean: [f64; N],
    /// The covariance matrix.
    pub covariance: [[f64; N]; N],
}

impl<const N: usize> Moments<N> {
    /// The moments of a single point.
    pub(super) fn point(mean: [f64; N]) -> Self {
        Self::of(mean, |_, _| 0.0)
    }

    pub(super) fn of(mean: [f64; N], covariance: impl Fn(usize, usize) -> f64) -> Self {
        let covariance = array::from_fn(|i| array::from_fn(|j| covariance(i, j)));
        Self { mean, covariance }
    }

    /// The moments of a mixture of parts, equally weighted if no weights are given.
    pub(super) fn mixed(parts: &[Self], weights: Option<&[f64]>) -> Self {
        let weight = |k: usize| weights.map_or(1.0, |weights| weights[k]);
        let total: f64 = (0..parts.len()).map(weight).sum();
        let average = |of: &dyn Fn(&Self) -> f64| {
            let each = parts.iter().enumerate().map(|(k, part)| weight(k) * of(part));
            each.sum::<f64>() / total
        };
        let mean = array::from_fn(|k| average(&|part| part.mean[k]));
        Self::of(mean, |i, j| {
            average(&|part| part.covariance[i][j] + (part.mean[i] - mean[i]) * (part.mean[j] - mean[j]))
        })
    }
}

impl Distribution<f64> {
    /// The mean; `p` for a Bernoulli distribution, the mean direction in degrees for headings.
    ///
    /// `None` if it draws no numbers. Always a closed form.
    pub fn mean(&self) -> Option<f64> {
        self.mean_and_variance().map(|(mean, _)| mean)
    }

    /// The variance, in squared units; p (1 − p) for a Bernoulli distribution.
    ///
    /// `None` if it draws no numbers, and for `von_mises`.
    pub fn variance(&self) -> Option<f64> {
        if matches!(self, Self::VonMises { .. }) {
            return None;
        }
        self.mean_and_variance().map(|(_, variance)| variance)
    }

    fn mean_and_variance(&self) -> Option<(f64, f64)> {
        Some(match self {
            Self::Constant { value } => (value.as_number()?, 0.0),
            Self::Choice { values, weights } => {
                let numbers = values.iter().map(Value::as_number).collect::<Option<Vec<f64>>>()?;
                weighted(
                    &numbers.into_iter().map(|number| (number, 0.0)).collect::<Vec<_>>(),
                    weights.as_deref(),
                )
            }
            Self::Uniform { low, high } => (f64::midpoint(*low, *high), square(high - low) / 12.0),
            Self::IntegerUniform { low, high } => (f64::midpoint(*low, *high), (square(high - low + 1.0) - 1.0) / 12.0),
            Self::Normal { mean, std } => (*mean, std * std),
            Self::TruncatedNormal { mean, std, low, high } => truncated(*mean, *std, *low, *high),
            Self::LogNormal { mu, sigma } => {
                let mean = libm::exp(mu + sigma * sigma / 2.0);
                (mean, libm::expm1(sigma * sigma) * mean * mean)
            }
            Self::Exponential { rate } => (1.0 / rate, 1.0 / (rate * rate)),
            Self::Beta { alpha, beta, low, high } => {
                let (low, width) = ends(*low, *high);
                let sum = alpha + beta;
                (
                    low + width * alpha / sum,
                    width * width * alpha * beta / (sum * sum * (sum + 1.0)),
                )
            }
            Self::Triangular { low, mode, high } => {
                let squares = low * low + mode * mode + high * high - low * mode - low * high - mode * high;
                ((low + mode + high) / 3.0, squares / 18.0)
            }
            Self::Perturb {
                value,
                noise,
                low,
                high,
            } => clipped(*value, *noise, *low, *high),
            Self::VonMises { mean, .. } => (mean.rem_euclid(360.0), f64::NAN),
            Self::Bernoulli { p } => (*p, p * (1.0 - p)),
            Self::Binomial { n, p } => (n * p, n * p * (1.0 - p)),
            Self::Poisson { mean } => (*mean, *mean),
            Self::Geometric { p } => ((1.0 - p) / p, (1.0 - p) / (p * p)),
            Self::Mixture { parts, weights } => {
                let parts = parts.iter().map(Self::mean_and_variance).collect::<Option<Vec<_>>>()?;
                weighted(&parts, weights.as_deref())
            }
            _ => return None,
        })
    }
}

/// The lower end and the width of a rescaled beta distribution.
pub(super) fn ends(low: Option<f64>, high: Option<f64>) -> (f64, f64) {
    let low = low.unwrap_or(0.0);
    (low, high.unwrap_or(1.0) - low)
}

/// Clips a number to limits.
pub(super) fn cut(x: f64, low: Option<f64>, high: Option<f64>) -> f64 {
    x.max(low.unwrap_or(f64::NEG_INFINITY))
        .min(high.unwrap_or(f64::INFINITY))
}

fn square(x: f64) -> f64 {
    x * x
}

/// Mean and variance of a mixture, given the mean and variance of each part.
fn weighted(parts: &[(f64, f64)], weights: Option<&[f64]>) -> (f64, f64) {
    let parts = parts
        .iter()
        .map(|(mean, variance)| Moments::of([*mean], |_, _| *variance));
    let Moments { mean, covariance } = Moments::mixed(&parts.collect::<Vec<_>>(), weights);
    (mean[0], covariance[0][0])
}

fn truncated(mean: f64, std: f64, low: f64, high: f64) -> (f64, f64) {
    let (a, b) = ((low - mean) / std, (high - mean) / std);
    if a > 0.0 {
        // Probabilities close to 1 lose digits in the upper tail; the mirror image keeps them.
        let (mirrored, variance) = truncated(-mean, std, -high, -low);
        return (-mirrored, variance);
    }
    let mass = normal_cdf(b) - normal_cdf(a);
    if mass <= 0.0 {
        // So narrow that the density is flat and the difference vanishes in rounding.
        return (f64::midpoint(low, high), square(high - low) / 12.0);
    }
    let (at_a, at_b) = (normal_density(a), normal_density(b));
    let edge = |end: f64, density: f64| if end.is_finite() { end * density } else { 0.0 };
    let shift = (at_a - at_b) / mass;
    let variance = 1.0 + (edge(a, at_a) - edge(b, at_b)) / mass - shift * shift;
    (mean + std * shift, (std * std * variance).max(0.0))
}

/// A uniform number around a value, clipped to limits: a flat part between two atoms.
fn clipped(value: f64, noise: f64, low: Option<f64>, high: Option<f64>) -> (f64, f64) {
    let cut = |x: f64| cut(x, low, high);
    if noise == 0.0 {
        return (cut(value), 0.0);
    }
    let (from, to) = (value - noise, value + noise);
    let (left, right) = (cut(from), cut(to));
    if left == right {
        return (left, 0.0);
    }
    let width = to - from;
    let (flat_from, flat_to) = (from.max(left), to.min(right));
    let parts = [
        (left, 0.0),
        (f64::midpoint(flat_from, flat_to), square(flat_to - flat_from) / 12.0),
        (right, 0.0),
    ];
    weighted(
        &parts,
        Some(&[flat_from - from, flat_to - flat_from, to - flat_to].map(|part| part / width)),
    )
}
