//! [`Shape`]: what is left of a family once it is moved and stretched to a standard place. Two of one shape have closed forms.

use driftworld_spec::Distribution;

/// A standard form; equal for distributions that are one another moved and stretched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    Point,
    Uniform,
    Normal,
    Exponential,
    /// Where the mode lies between the ends.
    Triangular(f64),
    /// The two shapes.
    Beta(f64, f64),
    /// The ends in deviations from the mean.
    Truncated(f64, f64),
}

impl Shape {
    /// The shape, where it starts or stands, and by how much it is stretched.
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

    /// The least and greatest number of the standard form.
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

/// Whether chance for chance one never draws less than the other, as far as their families show; then every optimal
/// transport goes one way, and the difference of the means is its length.
pub(super) fn one_is_never_less(a: &Distribution, b: &Distribution) -> bool {
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
                // Where only the start differs, an end at infinity is as far.
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
    fn one_inside_the_other_is_less_here_and_more_there() {
        let uniform = |low: f64, high: f64| Uniform { low, high };
        assert!(one_is_never_less(&uniform(0.0, 1.0), &uniform(0.0, 3.0)));
        assert!(!one_is_never_less(&uniform(0.0, 1.0), &uniform(-1.0, 3.0)));
        assert!(one_is_never_less(
            &Exponential { rate: 1.0 },
            &Exponential { rate: 3.0 }
        ));
        assert!(one_is_never_less(
            &Normal { mean: 1.0, std: 2.0 },
            &Normal { mean: 5.0, std: 2.0 }
        ));
        assert!(!one_is_never_less(
            &Normal { mean: 1.0, std: 2.0 },
            &Normal { mean: 5.0, std: 1.0 }
        ));
        let tent = |high: f64| Triangular {
            low: 0.0,
            mode: high / 2.0,
            high,
        };
        assert!(one_is_never_less(&tent(1.0), &tent(4.0)));
    }
}
