//! [`Part`]: one continuous family with its share of a law.

use std::f64::consts::TAU;

use driftworld_spec::Distribution;

use super::quadrature::{Node, integrate};

/// Distance from the mean, in standard deviations, beyond which a normal distribution has a probability below 1e-18.
const REACH: f64 = 9.0;

/// Standard deviations at which a normal density is split into stretches.
const BELL: [f64; 7] = [-REACH, -5.0, -2.0, 0.0, 2.0, 5.0, REACH];

/// A continuous family, with its share of a law.
#[derive(Clone, Debug)]
pub(super) struct Part {
    /// Probability of drawing from it.
    pub(super) share: f64,
    family: Distribution,
    /// Added to each number that the family draws.
    shift: f64,
    /// Logarithm of the density's divisor.
    log_scale: f64,
}

impl Part {
    /// A part of a family that has a density.
    pub(super) fn new(share: f64, family: Distribution, shift: f64) -> Self {
        let log_scale = match &family {
            Distribution::Uniform { low, high } => libm::log(high - low),
            Distribution::Normal { std, .. } | Distribution::LogNormal { sigma: std, .. } => {
                libm::log(std * TAU.sqrt())
            }
            Distribution::TruncatedNormal { mean, std, low, high } => {
                libm::log(std * TAU.sqrt() * normal_mass((low - mean) / std, (high - mean) / std))
            }
            Distribution::Exponential { rate } => -libm::log(*rate),
            Distribution::Beta { alpha, beta, low, high } => {
                log_beta(*alpha, *beta) + libm::log(high.unwrap_or(1.0) - low.unwrap_or(0.0))
            }
            Distribution::VonMises { kappa, .. } => {
                let shape = |node: Node| [libm::exp(log_bell_of_headings(node.x(), *kappa))];
                let deviation = (deviation_of_headings(*kappa) * 3.0).min(180.0);
                let [near] = integrate([0.0, deviation], 1e-12, shape).0;
                let [far] = integrate([deviation, 180.0], 1e-12, shape).0;
                libm::log(2.0 * (near + far))
            }
            _ => 0.0,
        };
        Self {
            share,
            family,
            shift,
            log_scale,
        }
    }

    pub(super) fn is_uniform(&self) -> bool {
        matches!(self.family, Distribution::Uniform { .. })
    }

    pub(super) fn draws_headings(&self) -> bool {
        matches!(self.family, Distribution::VonMises { .. })
    }

    /// The same part, shifted.
    pub(super) fn moved(&self, by: f64) -> Self {
        Self {
            shift: self.shift + by,
            ..self.clone()
        }
    }

    /// Logarithm of the density, without the share; −∞ outside the ends.
    pub(super) fn log_density(&self, node: Node) -> f64 {
        let node = node.lowered(self.shift);
        let bell = |z: f64| -0.5 * z * z;
        // A point at the very end may have been rounded past it.
        let inside = |low: f64, high: f64, log: f64| {
            let slack = 1e-12 * (high - low).min(1e6);
            if node.above(low) >= -slack && node.above(high) <= slack {
                log
            } else {
                f64::NEG_INFINITY
            }
        };
        let shape = match &self.family {
            Distribution::Uniform { low, high } => inside(*low, *high, 0.0),
            Distribution::Normal { mean, std } => bell(node.above(*mean) / std),
            Distribution::TruncatedNormal { mean, std, low, high } => {
                inside(*low, *high, bell(node.above(*mean) / std))
            }
            Distribution::LogNormal { mu, sigma } => {
                let log = libm::log(node.above(0.0).max(0.0));
                if log == f64::NEG_INFINITY {
                    return log;
                }
                bell((log - mu) / sigma) - log
            }
            Distribution::Exponential { rate } => inside(0.0, f64::INFINITY, -rate * node.above(0.0)),
            Distribution::Beta { alpha, beta, low, high } => {
                let (low, high) = (low.unwrap_or(0.0), high.unwrap_or(1.0));
                let width = high - low;
                let [left, right] = [node.above(low), -node.above(high)].map(|x| {
                    // Only a shifted part can be off by rounding.
                    if self.shift != 0.0 && x <= 0.0 && x > -1e-12 * width {
                        1e-12
                    } else {
                        x / width
                    }
                });
                if left <= 0.0 || right <= 0.0 {
                    return f64::NEG_INFINITY;
                }
                (alpha - 1.0) * libm::log(left) + (beta - 1.0) * libm::log(right)
            }
            Distribution::Triangular { low, mode, high } => {
                let (left, right) = (node.above(*low), -node.above(*high));
                let height = if left < mode - low || mode == high {
                    left / (mode - low)
                } else {
                    right / (high - mode)
                };
                inside(*low, *high, libm::log((2.0 * height / (high - low)).max(0.0)))
            }
            Distribution::VonMises { mean, kappa } => log_bell_of_headings(node.above(*mean), *kappa),
            _ => f64::NEG_INFINITY,
        };
        shape - self.log_scale
    }

    /// Probability of a number up to `x`, without the share. Headings accumulate from turn to turn.
    pub(super) fn cumulative(&self, x: f64) -> f64 {
        let x = x - self.shift;
        if let Distribution::VonMises { mean, .. } = self.family {
            let turns = ((x - mean + 180.0) / 360.0).floor();
            let turned = x - mean - 360.0 * turns;
            // Near the start of a turn, rounding would confuse it with the end.
            let within = if turned <= -180.0 + 1e-9 {
                0.0
            } else if turned >= 180.0 - 1e-9 {
                1.0
            } else {
                self.family.cdf(mean + turned).unwrap_or(0.0)
            };
            return turns + within;
        }
        self.family.cdf(x).unwrap_or(0.0)
    }

    /// Probability of a number above `x`, without the share; accurate in the far tail.
    pub(super) fn remaining(&self, x: f64) -> f64 {
        let y = x - self.shift;
        let tail = |z: f64| 0.5 * libm::erfc(z / std::f64::consts::SQRT_2);
        match &self.family {
            Distribution::Normal { mean, std } => tail((y - mean) / std),
            Distribution::LogNormal { mu, sigma } if y > 0.0 => tail((libm::log(y) - mu) / sigma),
            Distribution::Exponential { rate } if y > 0.0 => libm::exp(-rate * y),
            _ => 1.0 - self.cumulative(x),
        }
    }

    /// The ends of its support; infinite if unbounded.
    pub(super) fn ends(&self) -> [f64; 2] {
        let [low, high] = match &self.family {
            Distribution::Uniform { low, high }
            | Distribution::TruncatedNormal { low, high, .. }
            | Distribution::Triangular { low, high, .. } => [*low, *high],
            Distribution::Beta { low, high, .. } => [low.unwrap_or(0.0), high.unwrap_or(1.0)],
            Distribution::LogNormal { .. } | Distribution::Exponential { .. } => [0.0, f64::INFINITY],
            _ => [f64::NEG_INFINITY, f64::INFINITY],
        };
        [low + self.shift, high + self.shift]
    }

    /// Ends of stretches on which density and cumulative function are smooth enough to be integrated, unsorted. Less than
    /// 1e-17 of the probability and of the mean lies outside.
    pub(super) fn knots(&self) -> Vec<f64> {
        let [low, high] = self.ends();
        let around = |mean: f64, std: f64| -> Vec<f64> {
            let bell = BELL.iter().map(|z| mean + std * z);
            let mut knots: Vec<f64> = bell
                .filter(|x| *x > low - self.shift && *x < high - self.shift)
                .collect();
            knots.extend([low - self.shift, high - self.shift].iter().filter(|x| x.is_finite()));
            knots
        };
        let knots = match &self.family {
            Distribution::Normal { mean, std } | Distribution::TruncatedNormal { mean, std, .. } => around(*mean, *std),
            Distribution::LogNormal { mu, sigma } => {
                // The mean lies `sigma` deviations higher than the median; no stretch spans more than four powers of e.
                let [from, to] = [mu - REACH * sigma, mu + (REACH + sigma) * sigma];
                let count = ((to - from) / sigma.min(4.0)).ceil();
                (0..=count as u32)
                    .map(|k| libm::exp(from + (to - from) * f64::from(k) / count))
                    .filter(|x| x.is_finite())
                    .collect()
            }
            Distribution::Exponential { rate } => [0.0, 1.0, 3.0, 8.0, 20.0, 45.0].map(|x| x / rate).to_vec(),
            Distribution::Beta { .. } => match (self.family.mean(), self.family.variance()) {
                (Some(mean), Some(variance)) => around(mean, variance.sqrt()),
                _ => vec![low, high],
            },
            Distribution::Triangular { low, mode, high } => vec![*low, *mode, *high],
            Distribution::VonMises { mean, kappa } => {
                let deviation = deviation_of_headings(*kappa);
                let near = BELL.iter().map(|z| z * deviation).filter(|x| x.abs() < 180.0);
                near.chain([180.0]).map(|x| mean + x).collect()
            }
            Distribution::Uniform { low, high } => vec![*low, *high],
            _ => Vec::new(),
        };
        knots.into_iter().map(|x| x + self.shift).collect()
    }
}

/// Logarithm of the beta function.
pub(super) fn log_beta(alpha: f64, beta: f64) -> f64 {
    libm::lgamma(alpha) + libm::lgamma(beta) - libm::lgamma(alpha + beta)
}

/// Logarithm of the density of headings, up to a constant; `turned` is in degrees from the mean.
fn log_bell_of_headings(turned: f64, kappa: f64) -> f64 {
    let half = libm::sin(turned.to_radians() / 2.0);
    -2.0 * kappa * half * half
}

/// Standard deviation, in degrees, of the normal distribution that approximates headings of this concentration.
fn deviation_of_headings(kappa: f64) -> f64 {
    (1.0 / kappa.max(0.1).sqrt()).to_degrees()
}

/// Probability of a standard normal number between two ends.
pub(super) fn normal_mass(low: f64, high: f64) -> f64 {
    let below = |z: f64| 0.5 * libm::erfc(-z / std::f64::consts::SQRT_2);
    // The upper tail loses precision next to 1: the mirror image keeps it.
    if low > 0.0 {
        below(-low) - below(-high)
    } else {
        below(high) - below(low)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use Distribution::{Beta, Exponential, LogNormal, Normal, Triangular, TruncatedNormal, Uniform, VonMises};

    /// Checks that the density is the slope of the cumulative function, and integrates to 1 between the knots.
    #[track_caller]
    fn check(family: Distribution) {
        let part = Part::new(1.0, family, 0.5);
        let mut knots = part.knots();
        knots.sort_by(f64::total_cmp);
        let mut total = 0.0;
        for ends in knots.windows(2).filter(|ends| ends[0] < ends[1]) {
            let ([mass], _) = integrate([ends[0], ends[1]], 1e-12, |node| [libm::exp(part.log_density(node))]);
            let expected = part.cumulative(ends[1]) - part.cumulative(ends[0]);
            assert!(
                (mass - expected).abs() < 1e-10,
                "{part:?} in {ends:?}: {mass}, expected {expected}"
            );
            total += mass;
        }
        let whole = if let VonMises { .. } = part.family {
            part.cumulative(*knots.last().unwrap()) - part.cumulative(knots[0])
        } else {
            1.0
        };
        assert!((total - whole).abs() < 1e-10, "{part:?}: {total}");
    }

    #[test]
    fn density_is_the_slope_of_the_cumulative_function() {
        let beta = |alpha: f64, beta: f64| Beta {
            alpha,
            beta,
            low: Some(-1.0),
            high: Some(2.0),
        };
        check(Uniform { low: 1.0, high: 4.0 });
        check(Normal { mean: 1.0, std: 4.0 });
        check(TruncatedNormal {
            mean: 1.0,
            std: 4.0,
            low: 0.0,
            high: 9.0,
        });
        check(TruncatedNormal {
            mean: 0.0,
            std: 1.0,
            low: 5.0,
            high: 9.0,
        });
        check(LogNormal { mu: 1.0, sigma: 0.5 });
        check(LogNormal { mu: -3.0, sigma: 8.0 });
        check(Exponential { rate: 3.0 });
        check(beta(2.0, 5.0));
        check(beta(0.3, 0.5));
        check(beta(900.0, 40.0));
        check(Triangular {
            low: 0.0,
            mode: 1.0,
            high: 4.0,
        });
        check(Triangular {
            low: 0.0,
            mode: 4.0,
            high: 4.0,
        });
        check(VonMises { mean: 10.0, kappa: 0.0 });
        check(VonMises {
            mean: 400.0,
            kappa: 3.0,
        });
        check(VonMises {
            mean: 0.0,
            kappa: 10_000.0,
        });
    }
}
