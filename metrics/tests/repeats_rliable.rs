//! Compares statistics over repeats with rliable: `tests/oracles/repeats_rliable.py` describes how its numbers were made.

use driftworld_metrics::{
    Aggregate, BootstrapOptions, Estimate, Resampling, ScoreTable, estimate, probability_of_improvement,
};
use serde::Deserialize;

#[derive(Deserialize)]
struct Oracle {
    resamples: Resamples,
    seeds: Resamples,
    cases: Vec<Case>,
    comparisons: Vec<Comparison>,
}

#[derive(Deserialize)]
struct Resamples {
    aggregates: u32,
    improvement: u32,
}

#[derive(Deserialize)]
struct Case {
    name: String,
    scores: Vec<Vec<f64>>,
    values: [f64; 3],
    ends: [[f64; 3]; 2],
}

#[derive(Deserialize)]
struct Comparison {
    name: String,
    a: Vec<Vec<f64>>,
    b: Vec<Vec<f64>>,
    value: f64,
    strata: Vec<f64>,
    ends: [[f64; 1]; 2],
}

fn oracle() -> Oracle {
    serde_json::from_str(include_str!("oracles/repeats_rliable.json")).unwrap()
}

/// A table with one row per run.
fn table(scores: &[Vec<f64>]) -> ScoreTable {
    let run = |scores: &Vec<f64>| {
        let named = scores.iter().enumerate().map(|(k, score)| (k.to_string(), *score));
        named.collect::<Vec<_>>()
    };
    ScoreTable::from_runs(
        scores
            .iter()
            .enumerate()
            .map(|(k, scores)| (k.to_string(), run(scores))),
    )
    .unwrap()
}

/// Our number of resamples: fewer than rliable's 50,000, because tests run without optimisation.
const RESAMPLES: u32 = 20_000;

/// Our ends, and theirs averaged over seeds, leave out 2.5 % of two samples of resamples. The share that a sample of size n
/// leaves out beyond a fixed point varies by √(0.025 · 0.975 / n); five standard deviations of the difference are allowed.
/// Compares shares, because few runs have few distinct resamples, with wide gaps between their values.
fn allowed_share(theirs: u32, seeds: u32) -> f64 {
    let of_one = |resamples: u32| 0.025 * 0.975 / f64::from(resamples);
    5.0 * (of_one(RESAMPLES) + of_one(theirs * seeds)).sqrt()
}

/// Options for a narrow and a wide interval, which leave out more and less at either end, by the allowed share.
fn options(theirs: u32, seeds: u32) -> [BootstrapOptions; 2] {
    [-2.0, 2.0].map(|sides| BootstrapOptions {
        confidence: 0.95 + sides * allowed_share(theirs, seeds),
        resampling: Resampling::Strata,
        resamples: RESAMPLES,
        ..BootstrapOptions::default()
    })
}

#[track_caller]
fn check_value(name: &str, found: f64, expected: f64) {
    let tolerance = 1e-12 * expected.abs().max(1.0);
    assert!(
        (found - expected).abs() <= tolerance,
        "{name}: found {found}, expected {expected}"
    );
}

/// Checks that their ends lie between our narrow interval's and our wide one's, up to rounding.
#[track_caller]
fn check_ends(name: &str, narrow: &Estimate, wide: &Estimate, expected: [f64; 2]) {
    let (narrow, wide) = (narrow.interval.unwrap(), wide.interval.unwrap());
    let [low, high] = expected;
    let rounding = 1e-9;
    assert!(
        wide.low - rounding <= low
            && low <= narrow.low + rounding
            && narrow.high - rounding <= high
            && high <= wide.high + rounding,
        "{name}: expected {expected:?} between {narrow:?} and {wide:?}"
    );
}

#[test]
fn aggregates_match_rliable() {
    let oracle = oracle();
    for case in &oracle.cases {
        let aggregates = [Aggregate::Mean, Aggregate::Median, Aggregate::Iqm];
        let table = table(&case.scores);
        let options = options(oracle.resamples.aggregates, oracle.seeds.aggregates);
        let [narrow, wide] = options.map(|options| estimate(&table, aggregates, &options).unwrap());
        for k in 0..aggregates.len() {
            let name = format!("{}, {:?}", case.name, aggregates[k]);
            check_value(&name, narrow[k].value, case.values[k]);
            check_ends(&name, &narrow[k], &wide[k], case.ends.map(|ends| ends[k]));
        }
    }
}

#[test]
fn probabilities_of_improvement_match_rliable() {
    let oracle = oracle();
    for case in &oracle.comparisons {
        let (a, b) = (table(&case.a), table(&case.b));
        let options = options(oracle.resamples.improvement, oracle.seeds.improvement);
        let [narrow, wide] = options.map(|options| probability_of_improvement(&a, &b, &options).unwrap());
        check_value(&case.name, narrow.probability.value, case.value);
        for (found, expected) in narrow.strata.iter().zip(&case.strata) {
            check_value(&case.name, found.probability.value, *expected);
        }
        check_ends(
            &case.name,
            &narrow.probability,
            &wide.probability,
            case.ends.map(|ends| ends[0]),
        );
    }
}
