//! Confidence intervals of the mean of a few samples.

/// Quantiles of Student's t at 0.975, for 1 to 30 degrees of freedom.
const STUDENT: [f64; 30] = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120,
    2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042,
];

/// Student's quantile at 0.975: from the table, and beyond it by the expansion of the normal quantile (Cornish and Fisher),
/// accurate to four digits.
fn student(freedom: usize) -> f64 {
    const Z: f64 = 1.959_964;
    let of_table = freedom.checked_sub(1).and_then(|index| STUDENT.get(index));
    of_table.copied().unwrap_or_else(|| {
        let n = freedom as f64;
        let (third, fifth) = (Z.powi(3), Z.powi(5));
        Z + (third + Z) / (4.0 * n) + (5.0 * fifth + 16.0 * third + 3.0 * Z) / (96.0 * n * n)
    })
}

/// Mean, and half-width of Student's 95 % interval: 0 for a single sample, which has no interval.
pub(super) fn mean_and_reach(samples: &[f64]) -> (f64, f64) {
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / n;
    if samples.len() < 2 {
        return (mean, 0.0);
    }
    let squares: f64 = samples.iter().map(|sample| (sample - mean).powi(2)).sum();
    (mean, student(samples.len() - 1) * (squares / (n - 1.0) / n).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_continue_beyond_the_table() {
        // scipy.stats.t.ppf(0.975, freedom).
        let check = |freedom: usize, expected: f64| {
            let found = student(freedom);
            assert!((found - expected).abs() < 6e-4, "{freedom}: {found}");
        };
        check(1, 12.7062);
        check(30, 2.0423);
        check(31, 2.0395);
        check(40, 2.0211);
        check(60, 2.0003);
        check(120, 1.9799);
        check(1_000_000, 1.95997);
    }

    #[test]
    fn intervals_match_student() {
        let check = |samples: &[f64], expected: (f64, f64)| {
            let found = mean_and_reach(samples);
            assert!((found.0 - expected.0).abs() < 1e-12, "{samples:?}");
            assert!((found.1 - expected.1).abs() < 1e-3, "{samples:?}: {}", found.1);
        };
        check(&[4.0], (4.0, 0.0));
        check(&[1.0, 3.0], (2.0, 12.706));
        // scipy.stats.t.interval(0.95, 4, loc=3, scale=scipy.stats.sem([1, 2, 3, 4, 5])) is 1.0368 to 4.9632.
        check(&[1.0, 2.0, 3.0, 4.0, 5.0], (3.0, 1.9632));
        check(&[2.0; 100], (2.0, 0.0));
    }
}
