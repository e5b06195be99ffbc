//! The von Mises distribution of headings, computed by quadrature because it has no closed form. Angles are in radians from the
//! mean.

use std::f64::consts::PI;

use super::special::normal_quantile;

/// Positive half of the abscissae and weights of ten-point Gauss–Legendre quadrature.
#[expect(clippy::excessive_precision, reason = "the numbers as published")]
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_21, 0.295_524_224_714_752_87),
    (0.433_395_394_129_247_19, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_41, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_51, 0.149_451_349_150_580_59),
    (0.973_906_528_517_171_72, 0.066_671_344_308_688_14),
];

/// Number of intervals into which one side of the density is split.
const NUM_INTERVALS: u32 = 8;

/// Half-width of the range outside which the probability is below 1e-17.
fn reach(kappa: f64) -> f64 {
    (9.0 / kappa.sqrt()).min(PI)
}

/// The density up to a constant factor; 1 at the mean.
fn shape(angle: f64, kappa: f64) -> f64 {
    // cos θ − 1 = −2 sin²(θ/2) keeps its digits near the mean.
    let half = libm::sin(angle / 2.0);
    libm::exp(-2.0 * kappa * half * half)
}

/// ∫ shape(θ) dθ between two angles, split into `intervals` intervals.
fn integral([from, to]: [f64; 2], intervals: u32, kappa: f64) -> f64 {
    let half = (to - from) / f64::from(intervals) / 2.0;
    (0..intervals)
        .map(|interval| {
            let middle = from + half * f64::from(2 * interval + 1);
            let points = GAUSS
                .iter()
                .flat_map(|(x, weight)| [(middle - half * x, weight), (middle + half * x, weight)]);
            half * points.map(|(angle, weight)| weight * shape(angle, kappa)).sum::<f64>()
        })
        .sum()
}

/// ∫ shape(θ) dθ over one side, from the mean to [`reach`].
fn side(kappa: f64) -> f64 {
    integral([0.0, reach(kappa)], NUM_INTERVALS, kappa)
}

/// Probability of an angle from −π up to `angle`, in −π..=π. Absolute error below 1e-12.
pub(super) fn cdf(angle: f64, kappa: f64) -> f64 {
    let within = integral([0.0, angle.abs().min(reach(kappa))], NUM_INTERVALS, kappa);
    let share = within / side(kappa) / 2.0;
    if angle < 0.0 { 0.5 - share } else { 0.5 + share }
}

/// The `p` quantile: an angle in −π..=π.
///
/// Newton's method on one side; each step integrates only between the two latest angles.
pub(super) fn quantile(p: f64, kappa: f64) -> f64 {
    let (side, reach) = (side(kappa), reach(kappa));
    let share = (2.0 * p - 1.0).abs();
    if share >= 1.0 {
        return if p < 0.5 { -PI } else { PI };
    }
    let target = share * side;
    // Starts from a normal quantile of the same concentration, or from a uniform one if the concentration is low.
    let start = if kappa > 1.0 {
        normal_quantile(0.5 + share / 2.0) / kappa.sqrt()
    } else {
        share * PI
    };
    let (mut low, mut high) = (0.0, reach);
    let mut angle = start.clamp(low, high);
    let mut within = integral([0.0, angle], NUM_INTERVALS, kappa);
    for _ in 0..100 {
        if within < target {
            low = angle;
        } else {
            high = angle;
        }
        let newton = angle + (target - within) / shape(angle, kappa);
        let next = if newton > low && newton < high {
            newton
        } else {
            f64::midpoint(low, high)
        };
        if (next - angle).abs() <= 4.0 * f64::EPSILON * next {
            break;
        }
        let intervals = if (next - angle).abs() < 0.1 * reach {
            1
        } else {
            NUM_INTERVALS
        };
        within += integral([angle, next], intervals, kappa);
        angle = next;
    }
    if p < 0.5 { -angle } else { angle }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values of `scipy.stats.vonmises` (scipy 1.17).
    #[test]
    fn von_mises_agrees_with_scipy() {
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
    }

    #[test]
    fn von_mises_is_symmetric_and_rises_from_0_to_1() {
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
