//! Hellinger distance: between the square roots of probabilities.

use driftworld_spec::Distribution;

use super::measured::Measured;
use super::overlap;
use super::part::log_beta;

/// √(½ Σ (√p − √q)²), for densities √(½ ∫ (√f − √g)²).
///
/// A metric in `0..=1`. Accepts what [`total_variation`](super::total_variation()) accepts, and two `gaussian`s in the plane or
/// two `dirichlet`s of equal length. In closed form for normal, log-normal, exponential, beta (with the same ends), Poisson,
/// geometric, gaussian and Dirichlet pairs and for everything piecewise constant or discrete; otherwise by quadrature, mostly
/// within 1e-6 (the root of a sum known within 1e-9 or better), at 13 to 700 points between neighbouring knots.
///
/// Source: Pardo 2006, "Statistical Inference Based on Divergence Measures"; √(1 − BC) with BC the Bhattacharyya coefficient.
///
/// # Example
/// ```
/// use driftworld_similarity::distribution::hellinger;
/// use driftworld_spec::Distribution::Poisson;
/// let distance = hellinger(&Poisson { mean: 1.0 }, &Poisson { mean: 4.0 }).unwrap();
/// assert!((distance.value - (1.0 - (-0.5_f64).exp()).sqrt()).abs() < 1e-12);
/// ```
pub fn hellinger(a: &Distribution, b: &Distribution) -> Option<Measured> {
    if let Some(log) = log_coefficient(a, b) {
        let log = if a == b { 0.0 } else { log.min(0.0) };
        return Some(Measured::closed((-libm::expm1(log)).sqrt()));
    }
    let half_square = |p: f64, q: f64| {
        let gap = libm::exp(p / 2.0) - libm::exp(q / 2.0);
        gap * gap / 2.0
    };
    Some(overlap::sum(a, b, half_square)?.clamped(0.0, 1.0).root())
}

/// Logarithm of Σ √(p q), if there is a formula.
fn log_coefficient(a: &Distribution, b: &Distribution) -> Option<f64> {
    use Distribution::{Beta, Dirichlet, Exponential, Gaussian, Geometric, LogNormal, Normal, Poisson};
    Some(match (a, b) {
        (Normal { mean: m, std: s }, Normal { mean: n, std: t })
        | (LogNormal { mu: m, sigma: s }, LogNormal { mu: n, sigma: t })
            if *s > 0.0 && *t > 0.0 =>
        {
            let squares = s * s + t * t;
            0.5 * libm::log1p(-(s - t) * (s - t) / squares) - 0.25 * (m - n) * (m - n) / squares
        }
        (Exponential { rate: r }, Exponential { rate: s }) => {
            let share = (r - s) / (r + s);
            0.5 * libm::log1p(-share * share)
        }
        (Poisson { mean: m }, Poisson { mean: n }) => {
            let gap = m.sqrt() - n.sqrt();
            -0.5 * gap * gap
        }
        (Geometric { p }, Geometric { p: q }) => 0.5 * libm::log(p * q) - libm::log1p(-((1.0 - p) * (1.0 - q)).sqrt()),
        (
            Beta { alpha, beta, low, high },
            Beta {
                alpha: gamma,
                beta: delta,
                low: other_low,
                high: other_high,
            },
        ) if (low, high) == (other_low, other_high) => {
            log_beta(f64::midpoint(*alpha, *gamma), f64::midpoint(*beta, *delta))
                - 0.5 * (log_beta(*alpha, *beta) + log_beta(*gamma, *delta))
        }
        (Dirichlet { alpha }, Dirichlet { alpha: beta }) if alpha.len() == beta.len() => {
            let log = |shapes: &mut dyn Iterator<Item = f64>| {
                let (mut logs, mut sum) = (0.0, 0.0);
                for shape in shapes {
                    logs += libm::lgamma(shape);
                    sum += shape;
                }
                logs - libm::lgamma(sum)
            };
            let mut middle = alpha.iter().zip(beta).map(|(a, b)| f64::midpoint(*a, *b));
            log(&mut middle) - 0.5 * (log(&mut alpha.iter().copied()) + log(&mut beta.iter().copied()))
        }
        (Gaussian { mean: m, .. }, Gaussian { mean: n, .. }) => {
            let (s, t) = (a.gaussian_covariance()?, b.gaussian_covariance()?);
            let determinant = |m: [[f64; 2]; 2]| m[0][0] * m[1][1] - m[0][1] * m[1][0];
            let mean = [0, 1].map(|i| [0, 1].map(|j| f64::midpoint(s[i][j], t[i][j])));
            let (of_s, of_t, of_mean) = (determinant(s), determinant(t), determinant(mean));
            if of_s <= 0.0 || of_t <= 0.0 {
                return None;
            }
            let [x, y] = [m[0] - n[0], m[1] - n[1]];
            let distance = (x * x * mean[1][1] - 2.0 * x * y * mean[0][1] + y * y * mean[0][0]) / of_mean;
            -0.125 * distance + 0.25 * libm::log(of_s * of_t) - 0.5 * libm::log(of_mean)
        }
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution::Method;
    use Distribution::{Beta, Exponential, Gaussian, Geometric, LogNormal, Normal, Poisson, TruncatedNormal};
    use driftworld_spec::Spread;

    /// Compares the closed form with the sum or the quadrature.
    #[track_caller]
    fn check(a: &Distribution, b: &Distribution) {
        let found = hellinger(a, b).unwrap();
        assert_eq!(found.method, Method::Closed);
        let gap = |p: f64, q: f64| libm::exp(p / 2.0) - libm::exp(q / 2.0);
        let expected = overlap::sum(a, b, |p, q| gap(p, q) * gap(p, q) / 2.0)
            .unwrap()
            .root()
            .value;
        assert!((found.value - expected).abs() < 1e-9, "{found:?}, expected {expected}");
    }

    #[test]
    fn closed_forms_match_the_quadrature() {
        let beta = |alpha: f64, beta: f64| Beta {
            alpha,
            beta,
            low: None,
            high: Some(3.0),
        };
        check(&Normal { mean: 1.0, std: 2.0 }, &Normal { mean: 4.0, std: 0.5 });
        check(&LogNormal { mu: 1.0, sigma: 2.0 }, &LogNormal { mu: 0.0, sigma: 0.5 });
        check(&Exponential { rate: 1.0 }, &Exponential { rate: 5.0 });
        check(&Poisson { mean: 3.0 }, &Poisson { mean: 5.0 });
        check(&Geometric { p: 0.3 }, &Geometric { p: 0.01 });
        check(&beta(2.0, 5.0), &beta(0.5, 0.5));
        check(&beta(0.2, 50.0), &beta(30.0, 0.3));
    }

    #[test]
    fn gaussians_that_differ_along_one_axis_match_normals() {
        let plane = |x: f64, std: f64| Gaussian {
            mean: [x, 0.0],
            std: Some(Spread::Axes([std, 1.0])),
            correlation: None,
            covariance: None,
        };
        let line = |mean: f64, std: f64| Normal { mean, std };
        let expected = hellinger(&line(0.0, 1.0), &line(1.0, 2.0)).unwrap().value;
        assert!((hellinger(&plane(0.0, 1.0), &plane(1.0, 2.0)).unwrap().value - expected).abs() < 1e-12);
    }

    #[test]
    fn normal_truncated_far_out_matches_the_normal() {
        let whole = Normal { mean: 0.0, std: 1.0 };
        let cut = TruncatedNormal {
            mean: 0.0,
            std: 1.0,
            low: -8.0,
            high: 8.0,
        };
        assert!(hellinger(&whole, &cut).unwrap().value < 1e-5);
    }
}
