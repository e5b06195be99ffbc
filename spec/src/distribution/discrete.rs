//! Distributions of counts: binomial, Poisson and geometric.

use super::special::{beta_below, gamma_above, normal_quantile};

/// Largest mean for which probabilities are summed one by one; above it, the CDF is searched.
const MAX_SUMMED_MEAN: f64 = 64.0;

/// Probability of at most `k` successes in `n` trials.
pub(super) fn binomial_cdf(k: f64, n: f64, p: f64) -> f64 {
    let k = k.floor();
    if k < 0.0 {
        0.0
    } else if k >= n {
        1.0
    } else {
        beta_below(1.0 - p, n - k, k + 1.0)
    }
}

/// Probability of at most `k` events when `mean` events are expected.
pub(super) fn poisson_cdf(k: f64, mean: f64) -> f64 {
    let k = k.floor();
    if k < 0.0 {
        0.0
    } else if mean == 0.0 {
        1.0
    } else {
        gamma_above(k + 1.0, mean)
    }
}

/// Probability of at most `k` failures before the first success.
pub(super) fn geometric_cdf(k: f64, p: f64) -> f64 {
    let k = k.floor();
    if k < 0.0 {
        0.0
    } else if p == 1.0 {
        1.0
    } else {
        -libm::expm1((k + 1.0) * libm::log1p(-p))
    }
}

/// The `u` quantile of the number of successes in `n` trials.
pub(super) fn binomial_quantile(u: f64, n: f64, p: f64) -> f64 {
    if p == 0.0 || n == 0.0 {
        return 0.0;
    }
    if p == 1.0 || u >= 1.0 {
        return n;
    }
    if n * p <= MAX_SUMMED_MEAN {
        let odds = p / (1.0 - p);
        let p_zero = libm::exp(n * libm::log1p(-p));
        return sum_until(u, p_zero, n, |k| odds * (n - k) / (k + 1.0));
    }
    let deviation = (n * p * (1.0 - p)).sqrt();
    search(u, n * p, deviation, n, |k| binomial_cdf(k, n, p))
}

/// The `u` quantile of the number of events when `mean` events are expected.
pub(super) fn poisson_quantile(u: f64, mean: f64) -> f64 {
    if mean <= MAX_SUMMED_MEAN {
        // Beyond mean + 40 deviations the remaining probability is below 2⁻⁵³.
        let max = mean + 40.0 * (mean + 1.0).sqrt();
        return sum_until(u, libm::exp(-mean), max.ceil(), |k| mean / (k + 1.0));
    }
    let max = mean + 40.0 * mean.sqrt();
    search(u, mean, mean.sqrt(), max.ceil(), |k| poisson_cdf(k, mean))
}

/// The `u` quantile of the number of failures before the first success.
pub(super) fn geometric_quantile(u: f64, p: f64) -> f64 {
    if p == 1.0 || u <= 0.0 {
        return 0.0;
    }
    let u = u.min(1.0 - f64::EPSILON / 2.0);
    let count = (libm::log1p(-u) / libm::log1p(-p) - 1.0).ceil().max(0.0);
    // If u equals a cumulative probability, rounding may have overshot by one.
    if count >= 1.0 && geometric_cdf(count - 1.0, p) >= u {
        count - 1.0
    } else {
        count
    }
}

/// Sums the probabilities of 0, 1, 2 … until they reach `u` and returns the last count. `step(k)` is the probability of `k + 1`
/// divided by the probability of `k`.
fn sum_until(u: f64, p_zero: f64, max: f64, step: impl Fn(f64) -> f64) -> f64 {
    let (mut k, mut probability, mut sum) = (0.0, p_zero, p_zero);
    while sum < u && k < max {
        probability *= step(k);
        k += 1.0;
        sum += probability;
    }
    k
}

/// The smallest integer at which a CDF reaches `u`; starts near the quantile of a normal distribution.
fn search(u: f64, mean: f64, deviation: f64, max: f64, cdf: impl Fn(f64) -> f64) -> f64 {
    let inner = u.clamp(1e-300, 1.0 - f64::EPSILON / 2.0);
    let mut high = (mean + deviation * normal_quantile(inner)).round().clamp(0.0, max);
    let mut stride = 1.0;
    while high < max && cdf(high) < u {
        high = (high + stride).min(max);
        stride *= 2.0;
    }
    let mut low = high;
    stride = 1.0;
    while low >= 0.0 && cdf(low) >= u {
        low -= stride;
        stride *= 2.0;
    }
    // cdf(low) < u <= cdf(high), where -1 means below every count.
    low = low.max(-1.0);
    while high - low > 1.0 {
        let middle = f64::midpoint(low, high).floor();
        if cdf(middle) < u {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantile_is_the_smallest_count_that_reaches_the_probability() {
        for k in 0..400 {
            let u = f64::from(k) / 400.0;
            for (n, p) in [(4.0, 0.5), (30.0, 0.1), (1000.0, 0.3), (100_000.0, 0.9), (7.0, 1.0)] {
                let count = binomial_quantile(u, n, p);
                assert!(
                    binomial_cdf(count, n, p) >= u - 1e-12,
                    "binomial({n}, {p}) at {u}: {count}"
                );
                assert!(
                    binomial_cdf(count - 1.0, n, p) < u + 1e-12,
                    "binomial({n}, {p}) at {u}: {count}"
                );
            }
            for mean in [0.0, 0.3, 12.0, 300.0, 100_000.0] {
                let count = poisson_quantile(u, mean);
                assert!(poisson_cdf(count, mean) >= u - 1e-11, "poisson({mean}) at {u}: {count}");
                assert!(
                    poisson_cdf(count - 1.0, mean) < u + 1e-11,
                    "poisson({mean}) at {u}: {count}"
                );
            }
            for p in [1.0, 0.5, 0.01] {
                let count = geometric_quantile(u, p);
                assert!(geometric_cdf(count, p) >= u - 1e-12 && geometric_cdf(count - 1.0, p) < u + 1e-12);
            }
        }
    }
}
