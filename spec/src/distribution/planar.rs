//! Distributions of points: maps from random numbers to points, means and covariances.

use std::f64::consts::TAU;

use super::{Distribution, Moments, Spread};
use crate::value::Value;

impl Moments<2> {
    fn round(mean: [f64; 2], variance: f64) -> Self {
        Self::of(mean, |i, j| if i == j { variance } else { 0.0 })
    }

    fn rectangle(low: [f64; 2], high: [f64; 2]) -> Self {
        let mean = [0, 1].map(|axis| f64::midpoint(low[axis], high[axis]));
        let variance = |axis: usize| (high[axis] - low[axis]) * (high[axis] - low[axis]) / 12.0;
        Self::of(mean, |i, j| if i == j { variance(i) } else { 0.0 })
    }
}

impl Distribution<f64> {
    /// The point for two random numbers in 0..1; for `poisson_disc`, ignoring its spacing. `None` for distributions that need
    /// more or fewer numbers.
    #[inline]
    pub fn point_at(&self, [u, v]: [f64; 2]) -> Option<[f64; 2]> {
        let ring = |[x, y]: [f64; 2], inner: f64, outer: f64| {
            let radius = (inner * inner + (outer * outer - inner * inner) * u).sqrt();
            [x + radius * libm::cos(TAU * v), y + radius * libm::sin(TAU * v)]
        };
        Some(match self {
            Self::Box { low, high } | Self::PoissonDisc { low, high, .. } => {
                [low[0] + (high[0] - low[0]) * u, low[1] + (high[1] - low[1]) * v]
            }
            Self::Disc { center, radius } => ring(*center, 0.0, *radius),
            Self::Annulus { center, inner, outer } => ring(*center, *inner, *outer),
            Self::Gaussian { mean, .. } => {
                let [[xx, xy], [_, yy]] = self.gaussian_covariance()?;
                let normal = Self::Normal { mean: 0.0, std: 1.0 };
                let (a, b) = (normal.quantile(u)?, normal.quantile(v)?);
                // Cholesky factor: x depends on the first number, y on both.
                let along = xx.sqrt();
                let shared = if along > 0.0 { xy / along } else { 0.0 };
                let across = (yy - shared * shared).max(0.0).sqrt();
                [mean[0] + along * a, mean[1] + shared * a + across * b]
            }
            _ => return None,
        })
    }

    /// Exact mean and covariance: of one pass for points taken in turn, and ignoring the spacing of a `poisson_disc`. `None`
    /// if it draws no points.
    pub fn planar_moments(&self) -> Option<Moments<2>> {
        let points = |points: &[[f64; 2]], weights: Option<&[f64]>| {
            let parts = points.iter().map(|point| Moments::point(*point));
            Moments::mixed(&parts.collect::<Vec<_>>(), weights)
        };
        Some(match self {
            Self::Constant {
                value: Value::Point(point),
            } => Moments::point(*point),
            Self::Choice { values, weights } => {
                let at = |value: &Value| match value {
                    Value::Point(point) => Some(*point),
                    _ => None,
                };
                let values = values.iter().map(at).collect::<Option<Vec<_>>>()?;
                points(&values, weights.as_deref())
            }
            Self::Box { low, high } | Self::PoissonDisc { low, high, .. } => Moments::rectangle(*low, *high),
            Self::Disc { center, radius } => Moments::round(*center, radius * radius / 4.0),
            Self::Annulus { center, inner, outer } => Moments::round(*center, (inner * inner + outer * outer) / 4.0),
            Self::Gaussian { mean, .. } => Moments {
                mean: *mean,
                covariance: self.gaussian_covariance()?,
            },
            Self::Points { values, .. } => points(values, None),
            Self::Grid {
                low,
                high,
                columns,
                rows,
                jitter,
                ..
            } => {
                let moments = Moments::rectangle(*low, *high);
                // Cell centres have (n² − 1)/n² of the rectangle's variance; jitter restores some of the rest.
                let jitter = jitter.unwrap_or(0.0);
                let axis = |variance: f64, n: f64| variance * (1.0 - (1.0 - jitter * jitter) / (n * n));
                let [[x, _], [_, y]] = moments.covariance;
                Moments {
                    covariance: [[axis(x, *columns), 0.0], [0.0, axis(y, *rows)]],
                    ..moments
                }
            }
            Self::Mixture { parts, weights } => {
                let parts = parts.iter().map(Self::planar_moments);
                Moments::mixed(&parts.collect::<Option<Vec<_>>>()?, weights.as_deref())
            }
            _ => return None,
        })
    }

    /// The covariance matrix of a `gaussian` in square metres; `None` for any other distribution.
    pub fn gaussian_covariance(&self) -> Option<[[f64; 2]; 2]> {
        let Self::Gaussian {
            std,
            correlation,
            covariance,
            ..
        } = self
        else {
            return None;
        };
        if let Some(covariance) = covariance {
            return Some(*covariance);
        }
        let [x, y] = match std.as_ref()? {
            Spread::Round(std) => [*std; 2],
            Spread::Axes(axes) => *axes,
        };
        let both = correlation.unwrap_or(0.0) * x * y;
        Some([[x * x, both], [both, y * y]])
    }
}
