//! Distance between distributions of points: by their means and spreads.

use driftworld_spec::Distribution;

/// Bures–Wasserstein distance of mean and covariance: √(|m₁ − m₂|² + tr A + tr B − 2 tr √(√A B √A)), in metres.
///
/// A metric on moments, so a pseudometric on distributions; equal to Wasserstein-2 between normal distributions, and a lower
/// bound on it otherwise. `None` if either draws no points. Source: Gelbrich 1990.
pub fn bures_wasserstein(a: &Distribution, b: &Distribution) -> Option<f64> {
    let (a, b) = (a.planar_moments()?, b.planar_moments()?);
    if a == b {
        return Some(0.0);
    }
    let distance: f64 = (0..2).map(|axis| (a.mean[axis] - b.mean[axis]).powi(2)).sum();
    let trace = |m: [[f64; 2]; 2]| m[0][0] + m[1][1];
    let determinant = |m: [[f64; 2]; 2]| (m[0][0] * m[1][1] - m[0][1] * m[1][0]).max(0.0);
    let (a, b) = (a.covariance, b.covariance);
    // For a 2 × 2 matrix M, tr √M = √(tr M + 2 √det M); here tr M = tr AB and det M = det A det B.
    let product = a[0][0] * b[0][0] + a[0][1] * b[1][0] + a[1][0] * b[0][1] + a[1][1] * b[1][1];
    let both = (product + 2.0 * (determinant(a) * determinant(b)).sqrt())
        .max(0.0)
        .sqrt();
    Some((distance + trace(a) + trace(b) - 2.0 * both).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use Distribution::{Annulus, Box, Disc, Gaussian};

    #[track_caller]
    fn check(a: &Distribution, b: &Distribution, expected: f64) {
        let found = bures_wasserstein(a, b).unwrap();
        assert!(
            (found - expected).abs() < 1e-7,
            "{a:?} to {b:?}: {found}, expected {expected}"
        );
        assert_eq!(bures_wasserstein(b, a), Some(found));
    }

    #[test]
    fn differences_of_mean_and_spread_combine_as_a_hypotenuse() {
        let round = |x: f64, std: f64| Gaussian {
            mean: [x, 0.0],
            std: Some(driftworld_spec::Spread::Round(std)),
            correlation: None,
            covariance: None,
        };
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
                std: Some(driftworld_spec::Spread::Round(1.0)),
                correlation: None,
                covariance: None,
            },
            0.0,
        );
    }
}
