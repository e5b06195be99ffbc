//! The von Mises law of headings, by quadrature: it has no closed form. Angles here are radians from the mean.

use std::f64::consts::PI;

use super::special::root;

/// Abscissae and weights of Gauss–Legendre quadrature with ten points, the positive half.
#[expect(clippy::excessive_precision, reason = "the numbers as published")]
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_21, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_19, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_41, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_51, 0.149_451_349_150_580_59),
    (0.973_906_528_517_171_72, 0.066_671_344_308_688_14),
];

/// Stretches that a half turn is cut into.
const STRETCHES: u32 = 8;

/// Half the range outside which less than 1e-17 of the probability lies.
fn reach(kappa: f64) -> f64 {
    (9.0 / kappa.sqrt()).min(PI)
}

/// The density but for a factor: 1 at the mean.
fn shape(angle: f64, kappa: f64) -> f64 {
    // cos θ − 1 = −2 sin²(θ/2) keeps its digits near the mean.
    let half = libm::sin(angle / 2.0);
    libm::exp(-2.0 * kappa * half * half)
}

/// ∫ f(θ) shape(θ) dθ from 0 to `to`, which is at most [`reach`].
fn integral(to: f64, kappa: f64, f: impl Fn(f64) -> f64) -> f64 {
    let half = to / f64::from(STRETCHES) / 2.0;
    (0..STRETCHES)
        .map(|stretch| {
            let middle = half * f64::from(2 * stretch + 1);
            let points = GAUSS
                .iter()
                .flat_map(|(x, weight)| [(middle - half * x, weight), (middle + half * x, weight)]);
            half * points
                .map(|(angle, weight)| weight * f(angle) * shape(angle, kappa))
                .sum::<f64>()
        })
        .sum()
}

/// Probability of an angle from −π up to `angle`, which lies in −π..=π. Absolute error below 1e-12.
pub(super) fn cdf(angle: f64, kappa: f64) -> f64 {
    let reach = reach(kappa);
    let side = integral(angle.abs().min(reach), kappa, |_| 1.0) / integral(reach, kappa, |_| 1.0) / 2.0;
    if angle < 0.0 { 0.5 - side } else { 0.5 + side }
}

/// The angle in −π..=π up to which an angle lies with probability `p`.
pub(super) fn quantile(p: f64, kappa: f64) -> f64 {
    let whole = 2.0 * integral(reach(kappa), kappa, |_| 1.0);
    root(
        p,
        [-PI, PI],
        0.0,
        |angle| cdf(angle, kappa),
        |angle| shape(angle, kappa) / whole,
    )
}

/// Length of the mean of unit vectors: 0 where every heading is alike, 1 where all are the same.
pub(super) fn resultant_length(kappa: f64) -> f64 {
    let reach = reach(kappa);
    integral(reach, kappa, libm::cos) / integral(reach, kappa, |_| 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of `scipy.stats.vonmises` and of I₁/I₀ (scipy 1.17).
    #[test]
    fn the_law_has_the_values_of_scipy() {
        for (angle, kappa, expected) in [
            (0.5, 1.0, 0.664_076_474_604_995_6),
            (-1.0, 4.0, 0.033_225_820_901_453_484),
            (0.1, 40.0, 0.735_715_417_785_551_6),
            (2.0, 0.0, 0.818_309_886_183_790_7),
        ] {
            assert!(
                (cdf(angle, kappa) - expected).abs() < 1e-12,
                "{angle}, {kappa}: {}",
                cdf(angle, kappa)
            );
            assert!((quantile(expected, kappa) - angle).abs() < 1e-10);
        }
        assert!((resultant_length(2.0) - 0.697_774_657_964_008_2).abs() < 1e-12);
        assert!((resultant_length(10_000.0) - 0.999_949_998_749_875_1).abs() < 1e-9);
    }

    #[test]
    fn the_law_is_symmetric_and_rises_from_0_to_1() {
        for kappa in [0.0, 0.1, 3.0, 200.0, 10_000.0] {
            assert!(cdf(-PI, kappa).abs() < 1e-12 && (cdf(PI, kappa) - 1.0).abs() < 1e-12);
            for k in 1..20 {
                let p = f64::from(k) / 20.0;
                assert!((cdf(quantile(p, kappa), kappa) - p).abs() < 1e-11, "{p} at {kappa}");
                assert!((quantile(p, kappa) + quantile(1.0 - p, kappa)).abs() < 1e-9);
            }
        }
    }
}
