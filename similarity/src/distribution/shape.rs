//! [`Shape`]: a family up to shift and scale. Two distributions of the same shape have closed forms.

use driftworld_spec::Distribution;

/// A standard form; equal for distributions that differ only in shift and scale.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    Point,
    Uniform,
    Normal,
    Exponential,
    /// Position of the mode between the ends.
    Triangular(f64),
    /// The two shape parameters.
    Beta(f64, f64),
    /// The ends, in standard deviations from the mean.
    Truncated(f64, f64),
}

impl Shape {
    /// The shape, its shift and its scale.
    pub(super) fn of(distribution: &Distribution) -> Option<(Self, f64, f64)> {
        Some(match distribution {
            Distribution::Constant { value } => (Self::Point, value.as_number()?, 1.0),
            Distribution::Uniform { low, high } => (Self::Uniform, *low, high - low),
            Distribution::Normal { mean, std } => (Self::Normal, *mean, *std),
            Distribution::Exponential { rate } => (Self::Exponential, 0.0, 1.0 / rate),
            Distribution::Triangular { low, mode, high } => {
                (Self::Triangular((mode - low) / (high - low)), *low, high - low)
            }
            Distribution::Beta { alpha, beta, low, high } => {
                let low = low.unwrap_or(0.0);
                (Self::Beta(*alpha, *beta), low, high.unwrap_or(1.0) - low)
            }
            Distribution::TruncatedNormal { mean, std, low, high } => {
                (Self::Truncated((low - mean) / std, (high - mean) / std), *mean, *std)
            }
            _ => return None,
        })
    }

    /// The smallest and the largest number of the standard form.
    fn ends(self) -> [f64; 2] {
        match self {
            Self::Point => [0.0, 0.0],
            Self::Uniform | Self::Triangular(_) | Self::Beta(..) => [0.0, 1.0],
            Self::Normal => [f64::NEG_INFINITY, f64::INFINITY],
            Self::Exponential => [0.0, f64::INFINITY],
            Self::Truncated(low, high) => [low, high],
        }
    }
}

/// Whether the families show that one quantile function is never below the other; then every optimal
/// transport moves in one direction, and the distance is the difference of the means.
pub(super) fn are_ordered(a: &Distribution, b: &Distribution) -> bool {
    use Distribution::{Bernoulli, Beta, Binomial, Geometric, IntegerUniform, Poisson, TruncatedNormal};
    let agree = |x: f64, y: f64| !(x < 0.0 && y > 0.0 || x > 0.0 && y < 0.0);
    match (a, b) {
        (Bernoulli { .. }, Bernoulli { .. })
        | (Poisson { .. }, Poisson { .. })
        | (Geometric { .. }, Geometric { .. }) => true,
        (Binomial { n, p }, Binomial { n: m, p: q }) => agree(n - m, p - q),
        (IntegerUniform { low, high }, IntegerUniform { low: l, high: h }) => agree(low - l, high - h),
        (
            Beta { alpha, beta, low, high },
            Beta {
                alpha: c,
                beta: d,
                low: l,
                high: h,
            },
        ) if (low, high) == (l, h) => agree(alpha - c, d - beta),
        (
            TruncatedNormal { std, low, high, .. },
            TruncatedNormal {
                std: s,
                low: l,
                high: h,
                ..
            },
        ) if (std, low, high) == (s, l, h) => true,
        _ => match (Shape::of(a), Shape::of(b)) {
            (Some((shape, start, stretch)), Some((other, from, by))) if shape == other => {
                let moved = start - from;
                // If only the shift differs, an infinite end is no obstacle.
                stretch == by || {
                    let [low, high] = shape.ends().map(|end| moved + (stretch - by) * end);
                    agree(low, high)
                }
            }
            _ => false,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Distribution::{Exponential, Normal, Triangular, Uniform};

    #[test]
    fn nested_distributions_are_not_ordered() {
        let uniform = |low: f64, high: f64| Uniform { low, high };
        assert!(are_ordered(&uniform(0.0, 1.0), &uniform(0.0, 3.0)));
        assert!(!are_ordered(&uniform(0.0, 1.0), &uniform(-1.0, 3.0)));
        assert!(are_ordered(&Exponential { rate: 1.0 }, &Exponential { rate: 3.0 }));
        assert!(are_ordered(
            &Normal { mean: 1.0, std: 2.0 },
            &Normal { mean: 5.0, std: 2.0 }
        ));
        assert!(!are_ordered(
            &Normal { mean: 1.0, std: 2.0 },
            &Normal { mean: 5.0, std: 1.0 }
        ));
        let tent = |high: f64| Triangular {
            low: 0.0,
            mode: high / 2.0,
            high,
        };
        assert!(are_ordered(&tent(1.0), &tent(4.0)));
    }
}
