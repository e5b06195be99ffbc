//! Where the mean of a handful of samples may lie. Whose samples they are is the figure's business.

/// Quantiles of Student's t at 0.975, for 1 to 30 degrees of freedom.
const STUDENT: [f64; 30] = [
    12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120,
    2.110, 2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064, 2.060, 2.056, 2.052, 2.048, 2.045, 2.042,
];

/// Mean, and how far the 95 % interval of Student's t reaches to either side: 0 for a single sample, of which nothing is known.
pub(super) fn mean_and_reach(samples: &[f64]) -> (f64, f64) {
    let n = samples.len() as f64;
    let mean = samples.iter().sum::<f64>() / n;
    if samples.len() < 2 {
        return (mean, 0.0);
    }
    let squares: f64 = samples.iter().map(|sample| (sample - mean).powi(2)).sum();
    let quantile = STUDENT.get(samples.len() - 2).copied().unwrap_or(1.96);
    (mean, quantile * (squares / (n - 1.0) / n).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn intervals_are_those_of_student() {
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
