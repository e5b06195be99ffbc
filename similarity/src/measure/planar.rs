//! Distance between distributions of points: by their means and spreads.

use driftworld_spec::Distribution;

/// Mean and standard deviation along each axis of a distribution of points, in metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Mean.
    pub mean: [f64; 2],
    /// Standard deviation along x and y; none of the declared distributions correlates the two but `points`, whose
    /// correlation is left aside.
    pub std: [f64; 2],
}

impl Moments {
    /// The moments of a distribution of points; `None` for one of other values.
    pub fn of(distribution: &Distribution) -> Option<Self> {
        Some(match distribution {
            Distribution::Box { low, high } => Self {
                mean: [0, 1].map(|axis| f64::midpoint(low[axis], high[axis])),
                std: [0, 1].map(|axis| (high[axis] - low[axis]) / 12.0_f64.sqrt()),
            },
            Distribution::Disc { center, radius } => Self {
                mean: *center,
                std: [radius / 2.0; 2],
            },
            Distribution::Annulus { center, inner, outer } => Self {
                mean: *center,
                std: [((inner * inner + outer * outer) / 4.0).sqrt(); 2],
            },
            Distribution::Gaussian { mean, std } => Self {
                mean: *mean,
                std: [*std; 2],
            },
            Distribution::Points { values } => {
                let count = values.len() as f64;
                let mean = [0, 1].map(|axis| values.iter().map(|point| point[axis]).sum::<f64>() / count);
                let variance = [0, 1].map(|axis| {
                    values
                        .iter()
                        .map(|point| (point[axis] - mean[axis]).powi(2))
                        .sum::<f64>()
                        / count
                });
                Self {
                    mean,
                    std: variance.map(f64::sqrt),
                }
            }
            _ => return None,
        })
    }
}

/// Bures–Wasserstein distance of the moments: √(|m₁ − m₂|² + |s₁ − s₂|²), in metres.
///
/// A metric on moments, so a pseudo-metric on distributions; equal to Wasserstein-2 between normal distributions, and a
/// lower bound of it otherwise. `None` if either draws no points. Source: Gelbrich 1990.
pub fn bures_wasserstein(a: &Distribution, b: &Distribution) -> Option<f64> {
    let (a, b) = (Moments::of(a)?, Moments::of(b)?);
    let squares = (0..2).map(|axis| (a.mean[axis] - b.mean[axis]).powi(2) + (a.std[axis] - b.std[axis]).powi(2));
    Some(squares.sum::<f64>().sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use Distribution::{Annulus, Box, Disc, Gaussian};

    fn check(a: &Distribution, b: &Distribution, expected: f64) {
        let found = bures_wasserstein(a, b).unwrap();
        assert!(
            (found - expected).abs() < 1e-12,
            "{a:?} to {b:?}: {found}, expected {expected}"
        );
        assert_eq!(bures_wasserstein(b, a), Some(found));
    }

    #[test]
    fn means_and_spreads_add_up_as_legs_of_a_triangle() {
        let round = |x: f64, std: f64| Gaussian { mean: [x, 0.0], std };
        check(&round(0.0, 1.0), &round(3.0, 1.0), 3.0);
        check(&round(0.0, 1.0), &round(0.0, 3.0), 8.0_f64.sqrt());
        check(
            &Disc {
                center: [0.0, 0.0],
                radius: 2.0,
            },
            &round(0.0, 1.0),
            0.0,
        );
        check(
            &Annulus {
                center: [0.0, 0.0],
                inner: 0.0,
                outer: 2.0,
            },
            &Disc {
                center: [0.0, 0.0],
                radius: 2.0,
            },
            0.0,
        );
        let side = 12.0_f64.sqrt();
        check(
            &Box {
                low: [0.0, 0.0],
                high: [side, side],
            },
            &Gaussian {
                mean: [side / 2.0; 2],
                std: 1.0,
            },
            0.0,
        );
    }
}
