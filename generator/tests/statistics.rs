//! With fixed seeds, tests that drawn numbers, headings and shares follow their declared distributions.
//! `statistics_of_places.rs` tests positions; the spec crate tests the distributions themselves.

use std::sync::Arc;

use driftworld_generator::Sampler;
use driftworld_spec::{Distribution, TaskSpec, Value};
use rand::SeedableRng;

/// Number of draws per distribution.
const DRAWS: u64 = 20_000;

fn sampler(kind: &str, distribution: &str, seed: u64) -> (Sampler, Distribution) {
    let text = format!(
        r#"{{ "version": 2, "name": "draws", "parameters": {{
            "x": {{ "role": "randomized", "type": "{kind}", "affects": ["S"], "distribution": {distribution} }} }} }}"#
    );
    let task = TaskSpec::from_json("draws.json", &text).unwrap_or_else(|error| panic!("{error}"));
    let variant = task.variant("default").expect("it always exists");
    let declared = variant.distribution("x").expect("x is randomized");
    (Sampler::new(&variant, seed), declared)
}

fn values(sampler: &Sampler) -> impl Iterator<Item = Value> + '_ {
    (0..DRAWS).map(|index| sampler.values(index).expect("no requirements").swap_remove(0).1)
}

fn numbers(kind: &str, distribution: &str) -> (Vec<f64>, Distribution) {
    let (sampler, declared) = sampler(kind, distribution, 11);
    let drawn = values(&sampler).map(|value| match value {
        Value::Boolean(flag) => f64::from(u8::from(flag)),
        other => other.as_number().expect("it is numeric"),
    });
    (drawn.collect(), declared)
}

/// Kolmogorov–Smirnov statistic: the largest gap between the empirical and the true CDF, times √n.
fn kolmogorov(drawn: &[f64], cdf: impl Fn(f64) -> f64) -> f64 {
    let mut sorted = drawn.to_vec();
    sorted.sort_by(f64::total_cmp);
    let n = sorted.len() as f64;
    let gaps = sorted.iter().enumerate().map(|(k, x)| {
        let expected = cdf(*x);
        (expected - k as f64 / n)
            .abs()
            .max(((k + 1) as f64 / n - expected).abs())
    });
    gaps.fold(0.0, f64::max) * n.sqrt()
}

/// Bound that the Kolmogorov–Smirnov statistic exceeds in one of a thousand samples of the true distribution.
const KOLMOGOROV: f64 = 1.95;

/// Checks that mean and variance lie within five standard errors. The standard error of the variance comes from the fourth moment
/// of the draws.
fn check_moments(name: &str, drawn: &[f64], mean: f64, variance: f64) {
    let n = drawn.len() as f64;
    let found = drawn.iter().sum::<f64>() / n;
    assert!(
        (found - mean).abs() <= 5.0 * (variance / n).sqrt() + 1e-12,
        "{name}: mean {found}, expected {mean}"
    );
    let squares: Vec<f64> = drawn.iter().map(|x| (x - mean) * (x - mean)).collect();
    let found_variance = squares.iter().sum::<f64>() / n;
    let squared_error = squares
        .iter()
        .map(|square| (square - found_variance) * (square - found_variance))
        .sum::<f64>()
        / n;
    assert!(
        (found_variance - variance).abs() <= 5.0 * (squared_error / n).sqrt() + 1e-12,
        "{name}: variance {found_variance}, expected {variance}"
    );
}

#[track_caller]
fn check_continuous(distribution: &str) {
    let (drawn, declared) = numbers("number", distribution);
    let statistic = kolmogorov(&drawn, |x| declared.cdf(x).expect("it is numeric"));
    assert!(statistic < KOLMOGOROV, "{distribution}: {statistic}");
    check_moments(
        distribution,
        &drawn,
        declared.mean().expect("it is numeric"),
        declared.variance().expect("it is numeric"),
    );
}

/// Chi-square test over integers that merges rare ones. The bound lies five standard deviations above the mean.
#[track_caller]
fn check_discrete(kind: &str, distribution: &str) {
    let (drawn, declared) = numbers(kind, distribution);
    let mut counts = std::collections::BTreeMap::<i64, f64>::new();
    for number in &drawn {
        assert_eq!(number.fract(), 0.0, "{distribution}");
        *counts.entry(*number as i64).or_default() += 1.0;
    }
    let cdf = |x: i64| declared.cdf(x as f64).expect("it is numeric");
    let (low, high) = (
        *counts.keys().next().expect("there are draws"),
        *counts.keys().last().expect("there are draws"),
    );
    let (mut statistic, mut bins, mut expected, mut found) = (0.0, 0.0, drawn.len() as f64 * cdf(low - 1), 0.0);
    for number in low..=high {
        expected += drawn.len() as f64 * (cdf(number) - cdf(number - 1));
        found += counts.get(&number).copied().unwrap_or(0.0);
        if expected >= 8.0 {
            statistic += (found - expected) * (found - expected) / expected;
            bins += 1.0;
            (expected, found) = (0.0, 0.0);
        }
    }
    assert!(
        statistic < bins + 5.0 * (2.0_f64 * bins).sqrt(),
        "{distribution}: {statistic} over {bins} bins"
    );
    check_moments(
        distribution,
        &drawn,
        declared.mean().expect("it is numeric"),
        declared.variance().expect("it is numeric"),
    );
}

#[test]
fn continuous_draws_follow_their_distribution() {
    for distribution in [
        r#"{ "uniform": { "low": -3, "high": 5 } }"#,
        r#"{ "normal": { "mean": 2, "std": 3 } }"#,
        r#"{ "truncated_normal": { "mean": 0, "std": 1, "low": -1, "high": 2 } }"#,
        r#"{ "truncated_normal": { "mean": 0, "std": 1, "low": 4, "high": 9 } }"#,
        r#"{ "truncated_normal": { "mean": 0, "std": 1, "low": -9, "high": -5 } }"#,
        r#"{ "log_normal": { "mu": 0.5, "sigma": 0.4 } }"#,
        r#"{ "exponential": { "rate": 0.2 } }"#,
        r#"{ "beta": { "alpha": 2, "beta": 5 } }"#,
        r#"{ "beta": { "alpha": 0.5, "beta": 0.5, "low": -4, "high": 4 } }"#,
        r#"{ "triangular": { "low": 0, "mode": 1, "high": 5 } }"#,
        r#"{ "perturb": { "value": 3, "noise": 2 } }"#,
        r#"{ "mixture": { "parts": [{ "normal": { "mean": 0, "std": 1 } }, { "uniform": { "low": 5, "high": 6 } }], "weights": [3, 1] } }"#,
    ] {
        check_continuous(distribution);
    }
}

#[test]
fn integer_draws_follow_their_distribution() {
    for distribution in [
        r#"{ "integer_uniform": { "low": -3, "high": 3 } }"#,
        r#"{ "binomial": { "n": 12, "p": 0.3 } }"#,
        r#"{ "binomial": { "n": 1000, "p": 0.4 } }"#,
        r#"{ "poisson": { "mean": 3.5 } }"#,
        r#"{ "poisson": { "mean": 200 } }"#,
        r#"{ "geometric": { "p": 0.2 } }"#,
        r#"{ "choice": { "values": [1, 2, 7], "weights": [1, 0, 3] } }"#,
    ] {
        check_discrete("integer", distribution);
    }
    check_discrete("boolean", r#"{ "bernoulli": { "p": 0.3 } }"#);
}

#[test]
fn slightly_wrong_distribution_is_detected() {
    let (drawn, _) = numbers("number", r#"{ "normal": { "mean": 2, "std": 3 } }"#);
    let shifted = Distribution::Normal { mean: 2.15, std: 3.0 };
    assert!(kolmogorov(&drawn, |x| shifted.cdf(x).expect("it is numeric")) > KOLMOGOROV);
    let wider = Distribution::Normal { mean: 2.0, std: 3.2 };
    assert!(kolmogorov(&drawn, |x| wider.cdf(x).expect("it is numeric")) > KOLMOGOROV);
}

#[test]
fn clipped_draws_accumulate_at_the_limits() {
    let (drawn, _) = numbers("number", r#"{ "perturb": { "value": 3, "noise": 2, "high": 4 } }"#);
    let share = drawn.iter().filter(|x| **x == 4.0).count() as f64 / DRAWS as f64;
    assert!(
        (share - 0.25).abs() < 0.015 && drawn.iter().all(|x| *x <= 4.0),
        "{share}"
    );
}

#[test]
fn heading_draws_follow_their_distribution() {
    for (mean, kappa) in [(0.0, 2.0), (350.0, 40.0), (90.0, 0.0), (180.0, 0.5)] {
        let (drawn, declared) = numbers(
            "heading",
            &format!(r#"{{ "von_mises": {{ "mean": {mean}, "kappa": {kappa} }} }}"#),
        );
        assert!(drawn.iter().all(|degrees| (0.0..360.0).contains(degrees)));
        let unrolled: Vec<f64> = drawn
            .iter()
            .map(|degrees| (degrees - mean + 180.0).rem_euclid(360.0) - 180.0 + mean)
            .collect();
        let statistic = kolmogorov(&unrolled, |x| declared.cdf(x).expect("it has headings"));
        assert!(statistic < KOLMOGOROV, "von_mises({mean}, {kappa}): {statistic}");
    }
}

#[test]
fn dirichlet_shares_sum_to_1_and_follow_beta_distributions() {
    let (sampler, _) = sampler("vector", r#"{ "dirichlet": { "alpha": [2, 0.7, 4] } }"#, 5);
    let mut shares = vec![Vec::new(); 3];
    for value in values(&sampler) {
        let vector = value.as_vector().expect("a Dirichlet draw is a vector").to_vec();
        assert!((vector.iter().sum::<f64>() - 1.0).abs() < 1e-12 && vector.iter().all(|share| *share >= 0.0));
        for (list, share) in shares.iter_mut().zip(vector) {
            list.push(share);
        }
    }
    for (drawn, alpha) in shares.iter().zip([2.0, 0.7, 4.0]) {
        let declared = Distribution::Beta {
            alpha,
            beta: 6.7 - alpha,
            low: None,
            high: None,
        };
        let statistic = kolmogorov(drawn, |x| declared.cdf(x).expect("it is numeric"));
        assert!(statistic < KOLMOGOROV, "share with alpha {alpha}: {statistic}");
    }
}

/// Compares two samples of one distribution: ours, drawn by inversion, and one from `rand_distr` as an independent oracle.
#[track_caller]
fn check_against<T: Copy + Into<f64>>(distribution: &str, theirs: impl rand_distr::Distribution<T>) {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
    let (mut ours, _) = numbers("number", distribution);
    let mut sorted: Vec<f64> = (0..DRAWS).map(|_| theirs.sample(&mut rng).into()).collect();
    sorted.sort_by(f64::total_cmp);
    let their_cdf = |x: f64| sorted.partition_point(|other| *other <= x) as f64 / DRAWS as f64;
    // Two samples of size n differ as much as one sample of size n / 2 differs from the true distribution.
    ours.sort_by(f64::total_cmp);
    let our_cdf = |x: f64| ours.partition_point(|other| *other <= x) as f64 / DRAWS as f64;
    let gap = ours
        .iter()
        .map(|x| (our_cdf(*x) - their_cdf(*x)).abs())
        .fold(0.0, f64::max);
    assert!(gap * (DRAWS as f64 / 2.0).sqrt() < KOLMOGOROV, "{distribution}: {gap}");
}

#[test]
fn draws_agree_with_rand_distr() {
    let valid = "the parameters are valid";
    check_against(
        r#"{ "normal": { "mean": -1, "std": 2 } }"#,
        rand_distr::Normal::new(-1.0, 2.0).expect(valid),
    );
    check_against(
        r#"{ "log_normal": { "mu": 0, "sigma": 1 } }"#,
        rand_distr::LogNormal::new(0.0, 1.0).expect(valid),
    );
    check_against(
        r#"{ "exponential": { "rate": 3 } }"#,
        rand_distr::Exp::new(3.0).expect(valid),
    );
    check_against(
        r#"{ "beta": { "alpha": 3, "beta": 0.8 } }"#,
        rand_distr::Beta::new(3.0, 0.8).expect(valid),
    );
    check_against(
        r#"{ "triangular": { "low": -1, "mode": 0, "high": 4 } }"#,
        rand_distr::Triangular::new(-1.0, 4.0, 0.0).expect(valid),
    );
    check_against(
        r#"{ "poisson": { "mean": 9 } }"#,
        rand_distr::Poisson::new(9.0).expect(valid),
    );
}

#[test]
fn neighbouring_worlds_and_seeds_are_uncorrelated() {
    let draws = |seed| {
        let (sampler, _) = sampler("number", r#"{ "uniform": { "low": -1, "high": 1 } }"#, seed);
        values(&sampler)
            .map(|value| value.as_number().expect("it is numeric"))
            .collect::<Vec<f64>>()
    };
    let (a, b) = (draws(1), draws(2));
    // Correlation of two samples that are uniform on [-1, 1]. Its standard error is 1/√n.
    let correlation = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() * 3.0 / a.len() as f64;
    let max_correlation = 4.0 / (DRAWS as f64).sqrt();
    assert!(correlation(&a, &b).abs() < max_correlation, "two seeds");
    for lag in [1, 2, 64] {
        assert!(
            correlation(&a[lag..], &a[..a.len() - lag]).abs() < max_correlation,
            "{lag} worlds apart"
        );
    }
    let two = r#"{ "version": 2, "name": "two", "parameters": {
        "x": { "role": "randomized", "type": "number", "affects": ["S"], "distribution": { "uniform": { "low": -1, "high": 1 } } },
        "y": { "role": "randomized", "type": "number", "affects": ["S"], "distribution": { "uniform": { "low": -1, "high": 1 } } } } }"#;
    let task: Arc<TaskSpec> = TaskSpec::from_json("two.json", two).unwrap_or_else(|error| panic!("{error}"));
    let sampler = Sampler::new(&task.variant("default").expect("it always exists"), 1);
    let column = |position: usize| -> Vec<f64> {
        (0..DRAWS)
            .map(|index| {
                sampler.values(index).expect("no requirements")[position]
                    .1
                    .as_number()
                    .expect("it is numeric")
            })
            .collect()
    };
    assert!(
        correlation(&column(0), &column(1)).abs() < max_correlation,
        "two parameters"
    );
}
