//! Simulated studies: whether intervals have their nominal coverage, and how often equal agents are called different.

#![expect(clippy::disallowed_methods, reason = "compared within a tolerance")]
use driftworld_metrics::{
    Aggregate, BootstrapOptions, Interval, Resampling, ScoreTable, estimate, probability_of_improvement,
};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// The correlation between the tasks of one lifetime.
const COMMON: f64 = 0.8;

/// Standard normal, by the method of Box and Muller.
fn normal(chance: &mut ChaCha8Rng) -> f64 {
    let mut unit = || (chance.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
    let (radius, turn) = (1.0 - unit(), unit());
    (-2.0 * radius.ln()).sqrt() * (std::f64::consts::TAU * turn).cos()
}

/// A study: scores of tasks whose true mean is `mean`; the tasks of a lifetime share part of their noise.
fn study(num_runs: usize, num_tasks: usize, mean: f64, chance: &mut ChaCha8Rng) -> ScoreTable {
    let runs: Vec<_> = (0..num_runs)
        .map(|run| {
            let luck = normal(chance);
            let score = |chance: &mut ChaCha8Rng| mean + COMMON.sqrt() * luck + (1.0 - COMMON).sqrt() * normal(chance);
            let scores: Vec<_> = (0..num_tasks).map(|task| (task.to_string(), score(chance))).collect();
            (run.to_string(), scores)
        })
        .collect();
    ScoreTable::from_runs(runs).unwrap()
}

fn options(resampling: Resampling, resamples: u32) -> BootstrapOptions {
    BootstrapOptions {
        resampling,
        resamples,
        ..BootstrapOptions::default()
    }
}

/// Five standard deviations of a share measured in `num_studies` studies, if the true share is `share`.
fn tolerance(share: f64, num_studies: u32) -> f64 {
    5.0 * (share * (1.0 - share) / f64::from(num_studies)).sqrt()
}

/// Share of studies whose intervals contain the true mean, 0, for mean and interquartile mean: bootstrap intervals, then Student's t.
fn coverage(shape: (usize, usize), resampling: Resampling, num_studies: u32) -> [[f64; 2]; 2] {
    let mut chance = ChaCha8Rng::seed_from_u64(16);
    let mut held = [[0.0; 2]; 2];
    for _ in 0..num_studies {
        let table = study(shape.0, shape.1, 0.0, &mut chance);
        let found = estimate(&table, [Aggregate::Mean, Aggregate::Iqm], &options(resampling, 200)).unwrap();
        let holds = |interval: Option<Interval>| f64::from(u8::from(interval.is_some_and(|found| found.contains(0.0))));
        for (k, found) in found.iter().enumerate() {
            held[0][k] += holds(found.interval) / f64::from(num_studies);
            held[1][k] += holds(found.t_interval) / f64::from(num_studies);
        }
    }
    held
}

#[test]
fn students_interval_of_few_lifetimes_has_nominal_coverage() {
    for shape in [(3, 2), (5, 4), (9, 4)] {
        let [bootstrap, [mean, iqm]] = coverage(shape, Resampling::Runs, 1_000);
        println!("{shape:?}: bootstrap {bootstrap:?}, Student {mean} {iqm}");
        assert!((mean - 0.95).abs() < tolerance(0.95, 1_000), "{shape:?}: mean {mean}");
        // The jackknife's standard error of a trimmed mean is an approximation.
        assert!((0.88..=0.99).contains(&iqm), "{shape:?}: interquartile mean {iqm}");
    }
}

#[test]
fn whole_run_bootstrap_nearly_covers_and_strata_bootstrap_does_not() {
    let [[mean, iqm], student] = coverage((20, 4), Resampling::Runs, 500);
    println!("20 x 4 by runs: {mean} {iqm}");
    assert_eq!(student, [0.0; 2], "there are enough lifetimes");
    // The coverage of the percentile bootstrap with 20 normal runs.
    for found in [mean, iqm] {
        assert!((found - 0.925).abs() < tolerance(0.925, 500), "by runs {found}");
    }
    let [[strata, _], _] = coverage((5, 4), Resampling::Strata, 500);
    println!("5 x 4 by strata: {strata}");
    assert!(strata < 0.75, "by strata {strata}");
}

/// Share of studies in which two agents are called different if the first is better by `shift`.
fn called_different(runs: (usize, usize), shift: f64, num_studies: u32) -> f64 {
    let mut chance = ChaCha8Rng::seed_from_u64(28);
    let mut called = 0.0;
    for _ in 0..num_studies {
        let (a, b) = (study(runs.0, 4, shift, &mut chance), study(runs.1, 4, 0.0, &mut chance));
        let found = probability_of_improvement(&a, &b, &options(Resampling::Runs, 99)).unwrap();
        called += f64::from(u8::from(found.p_value.unwrap() <= 0.05)) / f64::from(num_studies);
    }
    called
}

#[test]
fn equal_agents_are_called_different_in_one_study_of_twenty() {
    // For 5 against 5 all divisions are tried, for 12 against 12 some are sampled. 3 against 3 can never be called different.
    for (runs, share) in [((5, 5), 0.05), ((4, 6), 0.05), ((12, 12), 0.05), ((3, 3), 0.0)] {
        let found = called_different(runs, 0.0, 600);
        println!("{runs:?}: {found}");
        assert!((found - share).abs() <= tolerance(share, 600), "{runs:?}: {found}");
    }
    let found = called_different((5, 5), 2.5, 100);
    assert!(found > 0.7, "a difference of 2.5 standard deviations is seen: {found}");
}
