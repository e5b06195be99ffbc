//! Probabilities of counts: binomial, Poisson, geometric.

use driftworld_spec::Distribution;

/// Counts less probable than this fraction of the likeliest count's probability are left out.
const NEGLIGIBLE: f64 = 1e-17;

/// All non-negligible counts with their probabilities; `None` for any other distribution and for more than `max_counts` counts.
pub(super) fn probabilities(distribution: &Distribution, max_counts: usize) -> Option<Vec<(f64, f64)>> {
    // The ratio of the probabilities of k + 1 and k, and the likeliest count.
    let (ratio, mode, end): (Box<dyn Fn(f64) -> f64>, f64, f64) = match *distribution {
        Distribution::Binomial { n, p: 0.0 } => return Some(vec![(0.0 * n, 1.0)]),
        Distribution::Binomial { n, p: 1.0 } => return Some(vec![(n, 1.0)]),
        Distribution::Binomial { n, p } => {
            let odds = p / (1.0 - p);
            let ratio = move |k: f64| (n - k) / (k + 1.0) * odds;
            (Box::new(ratio), ((n + 1.0) * p).floor().min(n), n)
        }
        Distribution::Poisson { mean: 0.0 } | Distribution::Geometric { p: 1.0 } => return Some(vec![(0.0, 1.0)]),
        Distribution::Poisson { mean } => (Box::new(move |k| mean / (k + 1.0)), mean.floor(), f64::INFINITY),
        Distribution::Geometric { p } => (Box::new(move |_| 1.0 - p), 0.0, f64::INFINITY),
        _ => return None,
    };
    // From the likeliest count outwards, so that nothing underflows; then normalised.
    let mut below = Vec::new();
    let (mut k, mut mass) = (mode, 1.0);
    while k > 0.0 {
        k -= 1.0;
        mass /= ratio(k);
        if mass < NEGLIGIBLE {
            break;
        }
        below.push((k, mass));
        if below.len() > max_counts {
            return None;
        }
    }
    let mut counts: Vec<(f64, f64)> = below.into_iter().rev().collect();
    let (mut k, mut mass) = (mode, 1.0);
    while k <= end && mass >= NEGLIGIBLE {
        counts.push((k, mass));
        if counts.len() > max_counts {
            return None;
        }
        mass *= ratio(k);
        k += 1.0;
    }
    let total: f64 = counts.iter().map(|count| count.1).sum();
    Some(counts.into_iter().map(|(k, mass)| (k, mass / total)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use Distribution::{Binomial, Geometric, Poisson};

    #[track_caller]
    fn check(distribution: &Distribution) {
        let counts = probabilities(distribution, 65_536).unwrap();
        let mut sum = 0.0;
        for (k, mass) in counts {
            sum += mass;
            let expected = distribution.cdf(k).unwrap();
            assert!(
                (sum - expected).abs() < 1e-9,
                "{distribution:?} at {k}: {sum}, expected {expected}"
            );
        }
        assert!((sum - 1.0).abs() < 1e-12);
    }

    #[test]
    fn probabilities_sum_to_the_cumulative_function() {
        check(&Binomial { n: 20.0, p: 0.3 });
        check(&Binomial { n: 100_000.0, p: 0.999 });
        check(&Binomial { n: 5.0, p: 1.0 });
        check(&Binomial { n: 0.0, p: 0.5 });
        check(&Poisson { mean: 0.5 });
        check(&Poisson { mean: 100_000.0 });
        check(&Poisson { mean: 0.0 });
        check(&Geometric { p: 0.01 });
        check(&Geometric { p: 1.0 });
    }

    #[test]
    fn too_many_counts_are_refused() {
        assert!(probabilities(&Geometric { p: 1e-6 }, 65_536).is_none());
    }
}
