//! Quantile functions. Worlds are sampled through them, so that variants under one seed share random numbers.

use super::moments::{cut, ends};
use super::special::{beta_quantile, normal_cdf, normal_quantile};
use super::{Distribution, discrete, von_mises};
use crate::value::{ParameterType, Value};

impl Distribution<f64> {
    /// The smallest number that a draw does not exceed with probability at least `p`, in `0..=1`.
    ///
    /// Results are identical bit for bit on every platform. Closed forms; `beta`, `von_mises` and mixtures by root finding down
    /// to the last bits. Infinite at 0 or 1 if the distribution is unbounded there; headings lie in `mean − 180..=mean + 180`
    /// degrees. `None` if it draws no numbers.
    pub fn quantile(&self, p: f64) -> Option<f64> {
        let p = p.clamp(0.0, 1.0);
        Some(match self {
            Self::Constant { value } => value.as_number()?,
            Self::Choice { values, weights } => {
                let weight = |k: usize| weights.as_ref().map_or(1.0, |weights| weights[k]);
                let numbers = values
                    .iter()
                    .enumerate()
                    .map(|(k, value)| Some((value.as_number()?, weight(k))));
                let mut atoms = numbers.collect::<Option<Vec<_>>>()?;
                atoms.retain(|atom| atom.1 > 0.0);
                atoms.sort_by(|a, b| a.0.total_cmp(&b.0));
                let total: f64 = atoms.iter().map(|atom| atom.1).sum();
                let mut below = 0.0;
                let reached = atoms.iter().find(|atom| {
                    below += atom.1 / total;
                    below >= p
                });
                reached.or(atoms.last())?.0
            }
            Self::Uniform { low, high } => low + (high - low) * p,
            Self::IntegerUniform { low, high } => (low + ((high - low + 1.0) * p).ceil() - 1.0).clamp(*low, *high),
            Self::Normal { mean, std } if *std == 0.0 => *mean,
            Self::Normal { mean, std } => mean + std * normal_quantile(p),
            Self::TruncatedNormal { mean, std, low, high } => truncated(p, *mean, *std, *low, *high),
            Self::LogNormal { mu, sigma } if *sigma == 0.0 => libm::exp(*mu),
            Self::LogNormal { mu, sigma } => libm::exp(mu + sigma * normal_quantile(p)),
            Self::Exponential { rate } => -libm::log1p(-p) / rate,
            Self::Beta { alpha, beta, low, high } => {
                let (low, width) = ends(*low, *high);
                low + width * beta_quantile(p, *alpha, *beta)
            }
            Self::Triangular { low, mode, high } => {
                let (width, rise) = (high - low, mode - low);
                if p * width < rise {
                    low + (p * width * rise).sqrt()
                } else {
                    high - ((1.0 - p) * width * (high - mode)).sqrt()
                }
            }
            Self::Perturb {
                value,
                noise,
                low,
                high,
            } => cut(value + noise * (2.0 * p - 1.0), *low, *high),
            Self::VonMises { mean, kappa } => mean + von_mises::quantile(p, *kappa).to_degrees(),
            Self::Bernoulli { p: odds } => f64::from(u8::from(p > 1.0 - odds)),
            Self::Binomial { n, p: odds } => discrete::binomial_quantile(p, *n, *odds),
            Self::Poisson { mean } if p >= 1.0 && *mean > 0.0 => f64::INFINITY,
            Self::Poisson { mean } => discrete::poisson_quantile(p, *mean),
            Self::Geometric { p: odds } if p >= 1.0 && *odds < 1.0 => f64::INFINITY,
            Self::Geometric { p: odds } => discrete::geometric_quantile(p, *odds),
            Self::Mixture { parts, weights } => self.mixture_quantile(p, parts, weights.as_deref())?,
            _ => return None,
        })
    }

    /// Bisects between the smallest and largest quantile of the parts, down to two adjacent floating-point numbers.
    fn mixture_quantile(&self, p: f64, parts: &[Self], weights: Option<&[f64]>) -> Option<f64> {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (k, part) in parts.iter().enumerate() {
            if weights.is_none_or(|weights| weights[k] > 0.0) {
                let end = part.quantile(p)?;
                (low, high) = (low.min(end), high.max(end));
            }
        }
        if !low.is_finite() || !high.is_finite() || self.cdf(low)? >= p {
            return Some(if p <= 0.5 || self.cdf(low).is_some_and(|at| at >= p) {
                low
            } else {
                high
            });
        }
        loop {
            let middle = f64::midpoint(low, high);
            if middle <= low || middle >= high {
                return Some(high);
            }
            if self.cdf(middle)? < p {
                low = middle;
            } else {
                high = middle;
            }
        }
    }

    /// The value for a random number `p` in `0..1`, if one random number is enough: integers for counts, a boolean for a
    /// Bernoulli, any value for a constant or a choice.
    pub fn value_at(&self, p: f64) -> Option<Value> {
        Some(match self {
            Self::Constant { value } => value.clone(),
            Self::Choice { values, weights } => values[chosen_index(values.len(), weights.as_deref(), p)].clone(),
            Self::Bernoulli { p: odds } => Value::Boolean(p > 1.0 - odds),
            Self::IntegerUniform { low, high } => {
                // Bypasses the quantile: `floor` gives each value a half-open interval of p.
                Value::Integer((low + ((high - low + 1.0) * p).floor()).min(*high) as i64)
            }
            Self::Binomial { .. } | Self::Poisson { .. } | Self::Geometric { .. } => {
                Value::Integer(self.quantile(p)? as i64)
            }
            Self::Uniform { low, high } => Value::Number((low + (high - low) * p).min(high.next_down())),
            Self::Mixture { .. } => return None,
            Self::VonMises { .. } => Value::Number(self.quantile(p)?).cast(ParameterType::Heading)?,
            _ => Value::Number(self.quantile(p)?),
        })
    }
}

impl<N> Distribution<N> {
    /// Whether one random number determines the draw, so that [`Distribution::value_at`] returns it.
    pub fn is_scalar(&self) -> bool {
        !self.is_planar() && !self.draws_colors() && !matches!(self, Self::Mixture { .. } | Self::Dirichlet { .. })
            || matches!(self, Self::Constant { .. } | Self::Choice { .. })
    }
}

impl Distribution<f64> {
    /// Index of the part of a mixture, or of the value of a choice, for a random number `p` in `0..1`; 0 for any
    /// other distribution.
    pub fn chosen_at(&self, p: f64) -> usize {
        match self {
            Self::Choice { values, weights } => chosen_index(values.len(), weights.as_deref(), p),
            Self::Mixture { parts, weights } => chosen_index(parts.len(), weights.as_deref(), p),
            _ => 0,
        }
    }
}

/// Index of the value, out of `count`, for a random number `p` in `0..1`.
fn chosen_index(count: usize, weights: Option<&[f64]>, p: f64) -> usize {
    let Some(weights) = weights else {
        return ((count as f64 * p) as usize).min(count - 1);
    };
    let mut left = weights.iter().sum::<f64>() * p;
    for (index, weight) in weights.iter().enumerate() {
        if left < *weight {
            return index;
        }
        left -= weight;
    }
    // Rounding can leave a small remainder, which goes to the last value that can occur.
    weights.iter().rposition(|weight| *weight > 0.0).unwrap_or(0)
}

fn truncated(p: f64, mean: f64, std: f64, low: f64, high: f64) -> f64 {
    let z = |x: f64| (x - mean) / std;
    if z(low) > 0.0 {
        // Probabilities close to 1 lose digits in the upper tail; the mirror image keeps them.
        return -truncated(1.0 - p, -mean, std, -high, -low);
    }
    let (below, above) = (normal_cdf(z(low)), normal_cdf(z(high)));
    (mean + std * normal_quantile(below + (above - below) * p)).clamp(low, high)
}
