//! Maximum mean discrepancy between distributions of numbers. Its kin without a kernel is in `energy.rs`.

use std::f64::consts::{SQRT_2, TAU};

use driftworld_spec::Distribution;

use super::law::{Law, draws_headings, rising};
use super::measured::Measured;
use super::quadrature::rule;

/// Most pieces that two laws may be cut into together: their pairs are gone through.
const MOST_PIECES: usize = 8192;

/// Steps of the quadrature per unit.
const STEPS: usize = 8;

/// √(E k(X, X′) + E k(Y, Y′) − 2 E k(X, Y)) with the kernel k(x, y) = exp(−(x − y)² / 2 bandwidth²).
///
/// A metric in `0..√2` for one `bandwidth`, which is in the units of the numbers; differences far below it count little. A
/// Bernoulli counts as 0 and 1. `None` if either draws no numbers, draws headings or too many different ones (about 8,000
/// together, also of those that stand for a density far wider than the bandwidth), or if the bandwidth is not a finite number above 0. Closed for normal and flat distributions and single numbers
/// and for mixtures of them, within about 1e-8 where the two are close; otherwise by quadrature, mostly within 1e-6, in
/// time that grows with the square of the places.
///
/// Source: Gretton et al. 2012, "A kernel two-sample test", lemma 6.
///
/// # Example
/// ```
/// use driftworld_similarity::distribution::maximum_mean_discrepancy;
/// use driftworld_spec::Distribution::Bernoulli;
/// let apart = maximum_mean_discrepancy(&Bernoulli { p: 0.0 }, &Bernoulli { p: 1.0 }, 1.0).unwrap();
/// assert!((apart.value - (2.0 - 2.0 * (-0.5_f64).exp()).sqrt()).abs() < 1e-12);
/// ```
pub fn maximum_mean_discrepancy(a: &Distribution, b: &Distribution, bandwidth: f64) -> Option<Measured> {
    if draws_headings(a) || draws_headings(b) || !bandwidth.is_finite() || bandwidth <= 0.0 {
        return None;
    }
    let (p, q) = (Law::of(a)?.smoothed().0, Law::of(b)?.smoothed().0);
    if a == b {
        return Some(Measured::closed(0.0));
    }
    let square = |steps: usize| {
        let (of_a, of_b) = (pieces(&p, bandwidth, steps), pieces(&q, bandwidth, steps));
        (of_a.len() + of_b.len() <= MOST_PIECES).then(|| {
            let mean = |a: &[Piece], b: &[Piece]| -> f64 {
                a.iter()
                    .map(|x| b.iter().map(|y| x.kernel(y, bandwidth)).sum::<f64>())
                    .sum()
            };
            (mean(&of_a, &of_a) + mean(&of_b, &of_b) - 2.0 * mean(&of_a, &of_b)).max(0.0)
        })
    };
    let fine = square(STEPS)?;
    Some(if p.parts.is_empty() && q.parts.is_empty() {
        Measured::atoms(fine).root()
    } else if [&p, &q]
        .iter()
        .all(|law| law.parts.iter().all(|part| part.is_uniform() || part.bell().is_some()))
    {
        Measured::closed(fine).root()
    } else {
        let coarse = square(STEPS / 2)?;
        Measured::quadrature(fine, (fine - coarse).abs().max(1e-14)).root()
    })
}

/// What the mean of the kernel has a formula for.
#[derive(Clone, Copy, Debug)]
enum Piece {
    /// Share, mean and variance; a single number has variance 0.
    Bell { share: f64, mean: f64, variance: f64 },
    /// Share and ends.
    Flat { share: f64, low: f64, high: f64 },
}

impl Piece {
    /// Mean of the kernel between a number of one and a number of the other, times the shares.
    fn kernel(&self, other: &Self, h: f64) -> f64 {
        let below = |z: f64| 0.5 * libm::erfc(-z / SQRT_2);
        match (*self, *other) {
            (
                Self::Bell { share, mean, variance },
                Self::Bell {
                    share: other,
                    mean: at,
                    variance: of,
                },
            ) => {
                let square = h * h + variance + of;
                let size = if square == h * h { 1.0 } else { h / square.sqrt() };
                share * other * size * libm::exp(-0.5 * (mean - at) * (mean - at) / square)
            }
            (
                Self::Bell { share, mean, variance },
                Self::Flat {
                    share: other,
                    low,
                    high,
                },
            )
            | (
                Self::Flat {
                    share: other,
                    low,
                    high,
                },
                Self::Bell { share, mean, variance },
            ) => {
                let wide = (h * h + variance).sqrt();
                let mass = below((high - mean) / wide) - below((low - mean) / wide);
                share * other * h * TAU.sqrt() * mass / (high - low)
            }
            (
                Self::Flat { share, low, high },
                Self::Flat {
                    share: other,
                    low: from,
                    high: to,
                },
            ) => {
                // The second integral of the kernel.
                let twice = |x: f64| {
                    let z = x / h;
                    z * below(z) + libm::exp(-0.5 * z * z) / TAU.sqrt()
                };
                let sum = twice(to - low) - twice(to - high) - twice(from - low) + twice(from - high);
                share * other * h * h * TAU.sqrt() * sum / ((high - low) * (to - from))
            }
        }
    }
}

fn pieces(law: &Law, bandwidth: f64, steps: usize) -> Vec<Piece> {
    let single = |mean: f64, share: f64| Piece::Bell {
        share,
        mean,
        variance: 0.0,
    };
    let mut pieces: Vec<Piece> = law.atoms.iter().map(|(x, mass)| single(*x, *mass)).collect();
    for part in &law.parts {
        let [low, high] = part.ends();
        if let Some((mean, std)) = part.bell() {
            pieces.push(Piece::Bell {
                share: part.share,
                mean,
                variance: std * std,
            });
        } else if part.is_uniform() && high - low > 3e-3 * bandwidth {
            pieces.push(Piece::Flat {
                share: part.share,
                low,
                high,
            });
        } else if part.is_uniform() {
            // So narrow that its form does not matter, and that the formula of the flat would lose its digits.
            pieces.push(Piece::Bell {
                share: part.share,
                mean: f64::midpoint(low, high),
                variance: (high - low) * (high - low) / 12.0,
            });
        } else {
            let from = pieces.len();
            for ends in rising(part.knots()).windows(2) {
                // As many stretches as it takes for the kernel to be smooth over each.
                // What is so unlikely that its square is nothing may stay coarse.
                let mass = part.cumulative(ends[1]) - part.cumulative(ends[0]);
                let most = if mass < 1e-4 { 1.0 } else { 64.0 };
                let count = ((ends[1] - ends[0]) / (4.0 * bandwidth)).ceil().clamp(1.0, most);
                let steps = if count > 4.0 { steps / 2 } else { steps };
                let width = (ends[1] - ends[0]) / count;
                for k in 0..count as u32 {
                    let low = ends[0] + width * f64::from(k);
                    for (node, weight) in rule([low, low + width], steps) {
                        let mass = part.share * weight * libm::exp(part.log_density(node));
                        if mass > 1e-15 {
                            pieces.push(single(node.x(), mass));
                        }
                    }
                }
            }
            let sum: f64 = pieces[from..].iter().map(Piece::share).sum();
            for piece in &mut pieces[from..] {
                if let Piece::Bell { share, .. } = piece {
                    *share *= part.share / sum;
                }
            }
        }
    }
    pieces
}

impl Piece {
    fn share(&self) -> f64 {
        match self {
            Self::Bell { share, .. } | Self::Flat { share, .. } => *share,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution::Method;
    use Distribution::{Beta, Mixture, Normal, TruncatedNormal, Uniform};

    #[track_caller]
    fn check(a: &Distribution, b: &Distribution, bandwidth: f64, expected: f64, within: f64) {
        let found = maximum_mean_discrepancy(a, b, bandwidth).unwrap();
        assert!(
            (found.value - expected).abs() < within,
            "{found:?}, expected {expected}"
        );
        let back = maximum_mean_discrepancy(b, a, bandwidth).unwrap();
        assert!((back.value - expected).abs() < within);
    }

    #[test]
    fn a_flat_part_is_as_far_as_a_fine_mixture_of_bells() {
        let uniform = Uniform { low: 0.0, high: 2.0 };
        let normal = Normal { mean: 1.0, std: 0.5 };
        let exact = maximum_mean_discrepancy(&uniform, &normal, 0.7).unwrap();
        assert_eq!(exact.method, Method::Closed);
        let fine = Mixture {
            parts: (0..100)
                .map(|k| {
                    let mean = (f64::from(k) + 0.5) / 50.0;
                    Normal { mean, std: 0.0 }
                })
                .collect(),
            weights: None,
        };
        check(&fine, &normal, 0.7, exact.value, 1e-4);
        let wide = Uniform { low: 1.0, high: 5.0 };
        let flat = maximum_mean_discrepancy(&uniform, &wide, 0.7).unwrap();
        check(&fine, &wide, 0.7, flat.value, 1e-4);
    }

    #[test]
    fn quadrature_agrees_with_the_closed_form() {
        let flat = Beta {
            alpha: 1.0,
            beta: 1.0,
            low: Some(2.0),
            high: Some(3.0),
        };
        let normal = Normal { mean: 0.0, std: 1.0 };
        let cut = TruncatedNormal {
            mean: 0.0,
            std: 1.0,
            low: -9.0,
            high: 9.0,
        };
        for bandwidth in [0.1, 1.0, 10.0] {
            let exact = maximum_mean_discrepancy(&Uniform { low: 2.0, high: 3.0 }, &normal, bandwidth).unwrap();
            check(&flat, &normal, bandwidth, exact.value, 1e-7);
            check(&flat, &cut, bandwidth, exact.value, 1e-7);
        }
        assert_eq!(maximum_mean_discrepancy(&flat, &normal, 0.0), None);
    }
}
