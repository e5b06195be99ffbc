//! Special functions used by the distributions. They use only `libm`, so that results are identical on every platform.
//!
//! Implemented here because the available libraries call the platform's maths functions, and quantiles decide which worlds are
//! sampled.

use std::f64::consts::{PI, SQRT_2};

/// Probability of a standard normal number up to `z`. Relative error below 1e-14, including the far tails.
pub(super) fn normal_cdf(z: f64) -> f64 {
    0.5 * libm::erfc(-z / SQRT_2)
}

/// Density of the standard normal distribution.
pub(super) fn normal_density(z: f64) -> f64 {
    libm::exp(-0.5 * z * z) / (2.0 * PI).sqrt()
}

/// Standard normal quantile of probability `p`; infinite at 0 and 1.
///
/// Source: Wichura 1988, algorithm AS 241 (PPND16); relative error about 1e-16.
pub(super) fn normal_quantile(p: f64) -> f64 {
    if p <= 0.0 {
        return f64::NEG_INFINITY;
    }
    if p >= 1.0 {
        return f64::INFINITY;
    }
    let q = p - 0.5;
    if q.abs() <= 0.425 {
        let r = 0.180_625 - q * q;
        return q * ratio(r, &CENTRE);
    }
    let tail = if q < 0.0 { p } else { 1.0 - p };
    let r = (-libm::log(tail)).sqrt();
    let z = if r <= 5.0 {
        ratio(r - 1.6, &MIDDLE)
    } else {
        ratio(r - 5.0, &TAIL)
    };
    if q < 0.0 { -z } else { z }
}

/// Coefficients of a ratio of two polynomials, from the constant term up.
type Ratio = ([f64; 8], [f64; 8]);

fn ratio(x: f64, (above, below): &Ratio) -> f64 {
    let polynomial = |c: &[f64; 8]| c.iter().rev().fold(0.0, |sum, c| sum * x + c);
    polynomial(above) / polynomial(below)
}

#[rustfmt::skip]
#[expect(clippy::excessive_precision, clippy::unreadable_literal, reason = "the coefficients as published")]
const CENTRE: Ratio = (
    [3.3871328727963666080, 133.14166789178437745, 1971.5909503065514427, 13731.693765509461125,
     45921.953931549871457, 67265.770927008700853, 33430.575583588128105, 2509.0809287301226727],
    [1.0, 42.313330701600911252, 687.18700749205790830, 5394.1960214247511077,
     21213.794301586595867, 39307.895800092710610, 28729.085735721942674, 5226.4952788528545610],
);

#[rustfmt::skip]
#[expect(clippy::excessive_precision, clippy::unreadable_literal, reason = "the coefficients as published")]
const MIDDLE: Ratio = (
    [1.42343711074968357734, 4.63033784615654529590, 5.76949722146069140550, 3.64784832476320460504,
     1.27045825245236838258, 0.241780725177450611770, 0.0227238449892691845833, 7.74545014278341407640e-4],
    [1.0, 2.05319162663775882187, 1.67638483018380384940, 0.689767334985100004550,
     0.148103976427480074590, 0.0151986665636164571966, 5.47593808499534494600e-4, 1.05075007164441684324e-9],
);

#[rustfmt::skip]
#[expect(clippy::excessive_precision, clippy::unreadable_literal, reason = "the coefficients as published")]
const TAIL: Ratio = (
    [6.65790464350110377720, 5.46378491116411436990, 1.78482653991729133580, 0.296560571828504891230,
     0.0265321895265761230930, 1.24266094738807843860e-3, 2.71155556874348757815e-5, 2.01033439929228813265e-7],
    [1.0, 0.599832206555887937690, 0.136929880922735805310, 0.0148753612908506148525,
     7.86869131145613259100e-4, 1.84631831751005468180e-5, 1.42151175831644588870e-7, 2.04426310338993978564e-15],
);

/// Minimum magnitude of a denominator in a continued fraction.
const TINY: f64 = 1e-300;

/// The regularised upper incomplete gamma function Q(a, x). Relative error about 1e-12.
///
/// Source: DLMF 8.7.1 (series) and 8.9.2 (continued fraction, by Lentz's method).
pub(super) fn gamma_above(a: f64, x: f64) -> f64 {
    if x <= 0.0 {
        return 1.0;
    }
    let scale = libm::exp(a * libm::log(x) - x - libm::lgamma(a));
    if x < a + 1.0 {
        let (mut term, mut sum, mut n) = (1.0 / a, 1.0 / a, a);
        while term > sum * 1e-17 {
            n += 1.0;
            term *= x / n;
            sum += term;
        }
        return 1.0 - sum * scale;
    }
    let mut b = x + 1.0 - a;
    let mut c = 1.0 / TINY;
    let mut d = 1.0 / b;
    let mut h = d;
    for i in 1..100_000 {
        let n = f64::from(i);
        let an = -n * (n - a);
        b += 2.0;
        d = 1.0 / away_from_0(an * d + b);
        c = away_from_0(b + an / c);
        h *= d * c;
        if (d * c - 1.0).abs() < 1e-16 {
            break;
        }
    }
    scale * h
}

/// The regularised incomplete beta function I(x; a, b). Relative error about 1e-12.
///
/// Source: DLMF 8.17.22, by Lentz's method.
pub(super) fn beta_below(x: f64, a: f64, b: f64) -> f64 {
    if x <= 0.0 {
        return 0.0;
    }
    if x >= 1.0 {
        return 1.0;
    }
    let log_beta = libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    let scale = libm::exp(a * libm::log(x) + b * libm::log1p(-x) - log_beta);
    if x < (a + 1.0) / (a + b + 2.0) {
        scale * beta_fraction(x, a, b) / a
    } else {
        1.0 - scale * beta_fraction(1.0 - x, b, a) / b
    }
}

fn beta_fraction(x: f64, a: f64, b: f64) -> f64 {
    let mut c = 1.0;
    let mut d = 1.0 / away_from_0(1.0 - (a + b) * x / (a + 1.0));
    let mut h = d;
    for i in 1..100_000 {
        let m = f64::from(i);
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / away_from_0(1.0 + even * d);
        c = away_from_0(1.0 + even / c);
        h *= d * c;
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / away_from_0(1.0 + odd * d);
        c = away_from_0(1.0 + odd / c);
        h *= d * c;
        if (d * c - 1.0).abs() < 1e-16 {
            break;
        }
    }
    h
}

fn away_from_0(x: f64) -> f64 {
    if x.abs() < TINY { TINY } else { x }
}

/// The `x` in `0..=1` with I(x; a, b) = `p`, by bisection accelerated by Newton steps.
pub(super) fn beta_quantile(p: f64, a: f64, b: f64) -> f64 {
    let log_beta = libm::lgamma(a) + libm::lgamma(b) - libm::lgamma(a + b);
    let density = |x: f64| libm::exp((a - 1.0) * libm::log(x) + (b - 1.0) * libm::log1p(-x) - log_beta);
    root(p, [0.0, 1.0], a / (a + b), |x| beta_below(x, a, b), density)
}

/// The `x` between the ends at which an increasing function reaches `p`; `density` is its derivative.
pub(super) fn root(
    p: f64,
    [mut low, mut high]: [f64; 2],
    start: f64,
    rising: impl Fn(f64) -> f64,
    density: impl Fn(f64) -> f64,
) -> f64 {
    if p <= 0.0 {
        return low;
    }
    if p >= 1.0 {
        return high;
    }
    let mut x = start;
    for _ in 0..200 {
        let miss = rising(x) - p;
        if miss < 0.0 {
            low = x;
        } else {
            high = x;
        }
        let newton = x - miss / density(x);
        let next = if newton > low && newton < high {
            newton
        } else {
            f64::midpoint(low, high)
        };
        if (next - x).abs() <= 1e-15 * next.abs().max(1e-300) || next == low || next == high {
            return next;
        }
        x = next;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(found: f64, expected: f64) {
        assert!(
            (found - expected).abs() <= 1e-12 * expected.abs(),
            "found {found:e}, expected {expected:e}"
        );
    }

    /// Values of `scipy.stats.norm`, `scipy.special.gammaincc`, `betainc` and `betaincinv` (scipy 1.17).
    #[test]
    fn special_functions_agree_with_scipy() {
        check(normal_quantile(1e-300), -37.047_096_299_361_2);
        check(normal_quantile(1e-5), -4.264_890_793_922_825);
        check(normal_quantile(0.3), -0.524_400_512_708_040_9);
        check(normal_quantile(0.975), 1.959_963_984_540_054);
        check(normal_cdf(-10.0), 7.619_853_024_160_47e-24);
        check(gamma_above(3.0, 2.5), 0.543_813_115_883_329_7);
        check(gamma_above(0.5, 4.0), 0.004_677_734_981_047_276);
        check(beta_below(0.25, 2.0, 3.0), 0.261_718_75);
        check(beta_below(0.9, 0.5, 0.5), 0.795_167_235_300_866_5);
        check(beta_quantile(0.1, 2.0, 5.0), 0.092_595_258_913_128_73);
    }

    #[test]
    fn quantiles_invert_the_cumulative_functions() {
        for k in 1..200 {
            let p = f64::from(k) / 200.0;
            check(normal_cdf(normal_quantile(p)), p);
            for (a, b) in [(0.3, 0.4), (1.0, 1.0), (2.0, 5.0), (80.0, 3.0), (500.0, 700.0)] {
                let back = beta_below(beta_quantile(p, a, b), a, b);
                assert!((back - p).abs() < 1e-11, "beta({a}, {b}) at {p}: {back}");
            }
        }
    }
}
