//! Student's t intervals for few runs, with standard errors from the jackknife.

use super::Interval;
use super::student::student_reach;

/// With at least this many runs, only bootstrap intervals are computed.
pub const FEW_RUNS: usize = 10;

/// The jackknife's estimate of the variance, and its degrees of freedom, from the values with each run of one agent left out in
/// turn. For a mean of runs it is the variance of the mean.
fn variance(left_out: &[f64]) -> (f64, f64) {
    let num = left_out.len() as f64;
    // Sorted, so that the order of runs does not matter.
    let mut values = left_out.to_vec();
    values.sort_by(f64::total_cmp);
    let mean = values.iter().sum::<f64>() / num;
    let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
    ((num - 1.0) / num * squares, num - 1.0)
}

/// The interval around a value of one agent's runs, or of two agents' independent runs; `None` if an agent has only one run,
/// whose variation is unknown. `left_out` are, for each agent, the values with each of its runs left out in turn.
///
/// The degrees of freedom of two agents are those of Welch and Satterthwaite.
pub(super) fn t_interval(value: f64, left_out: &[Vec<f64>], confidence: f64) -> Option<Interval> {
    if left_out.iter().any(|values| values.len() < 2) {
        return None;
    }
    let variances: Vec<(f64, f64)> = left_out.iter().map(|values| variance(values)).collect();
    let variance: f64 = variances.iter().map(|(variance, _)| variance).sum();
    let shares: f64 = variances
        .iter()
        .map(|(variance, freedom)| variance * variance / freedom)
        .sum();
    // Without variation, any number of degrees of freedom gives a width of 0.
    let freedom = if shares > 0.0 {
        variance * variance / shares
    } else {
        1.0
    };
    let half_width = student_reach(confidence, freedom) * variance.sqrt();
    Some(Interval {
        low: value - half_width,
        high: value + half_width,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interval_of_a_mean_is_the_textbook_one() {
        // scipy.stats.t.interval(0.95, 4, loc=3, scale=scipy.stats.sem([1, 2, 3, 4, 5])).
        let runs = [1.0, 2.0, 3.0, 4.0, 5.0];
        let left_out = runs.iter().map(|run| (15.0 - run) / 4.0).collect();
        let found = t_interval(3.0, &[left_out], 0.95).unwrap();
        assert!((found.low - 1.036_756_838_522_439).abs() < 1e-9, "{found:?}");
        assert!((found.high - 4.963_243_161_477_561).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn one_run_has_no_interval_and_equal_runs_have_one_of_width_0() {
        assert_eq!(t_interval(1.0, &[vec![1.0]], 0.95), None);
        let still = t_interval(1.0, &[vec![1.0; 3], vec![1.0; 2]], 0.95).unwrap();
        assert_eq!((still.low, still.high), (1.0, 1.0));
    }
}
