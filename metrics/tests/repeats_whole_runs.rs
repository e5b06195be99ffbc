//! Checks the probability of improvement with whole-run resampling against numpy: `tests/oracles/repeats_whole_runs.py`
//! describes how its numbers were made.

use driftworld_metrics::{BootstrapOptions, Improvement, Interval, Resampling, ScoreTable, probability_of_improvement};
use serde::Deserialize;

#[derive(Deserialize)]
struct Oracle {
    resamples: u32,
    comparisons: Vec<Comparison>,
}

#[derive(Deserialize)]
struct Comparison {
    name: String,
    a: Vec<Vec<Option<f64>>>,
    b: Vec<Vec<Option<f64>>>,
    /// The values of the strata, then of all.
    values: Vec<f64>,
    /// The low and high ends, of the strata, then of all.
    ends: Vec<[f64; 2]>,
    /// Number of resamples in which each stratum had a pair.
    resamples_of_strata: Vec<u32>,
}

/// A table with one row per run.
fn table(rows: &[Vec<Option<f64>>]) -> ScoreTable {
    let run = |row: &Vec<Option<f64>>| {
        let named = row.iter().enumerate();
        let named = named.filter_map(|(k, score)| Some((k.to_string(), (*score)?)));
        named.collect::<Vec<_>>()
    };
    ScoreTable::from_runs(rows.iter().enumerate().map(|(k, row)| (k.to_string(), run(row)))).unwrap()
}

/// Our number of resamples.
const RESAMPLES: u32 = 20_000;

/// The comparison, with intervals that leave out `share` at either end.
fn compared(case: &Comparison, share: f64, resampling: Resampling) -> Improvement {
    let options = BootstrapOptions {
        confidence: 1.0 - 2.0 * share,
        resamples: RESAMPLES,
        resampling,
        ..BootstrapOptions::default()
    };
    probability_of_improvement(&table(&case.a), &table(&case.b), &options).unwrap()
}

/// Values and intervals of the strata, then of all.
fn estimates(found: &Improvement) -> Vec<(f64, Option<Interval>)> {
    let strata = found.strata.iter().map(|stratum| &stratum.probability);
    let all = strata.chain([&found.probability]);
    all.map(|estimate| (estimate.value, estimate.interval)).collect()
}

fn oracle() -> Oracle {
    serde_json::from_str(include_str!("oracles/repeats_whole_runs.json")).unwrap()
}

/// The share that a sample of size n leaves out beyond a fixed point varies by √(0.025 · 0.975 / n), so their ends lie between
/// the ends of two of our intervals, which leave out five standard deviations more and less. Compares shares, because there are
/// gaps between the values.
#[test]
fn whole_run_intervals_match_numpy() {
    let Oracle { resamples, comparisons } = oracle();
    for case in &comparisons {
        let rarest = f64::from(*case.resamples_of_strata.iter().min().unwrap()) / f64::from(resamples);
        let of_one = |resamples: u32| 0.025 * 0.975 / (rarest * f64::from(resamples));
        let allowed = 5.0 * (of_one(RESAMPLES) + of_one(resamples)).sqrt();
        let [narrow, wide] = [allowed, -allowed].map(|more| estimates(&compared(case, 0.025 + more, Resampling::Runs)));
        assert_eq!(narrow.len(), case.values.len(), "{}", case.name);
        for k in 0..narrow.len() {
            let place = format!("{}, {k}", case.name);
            assert!((narrow[k].0 - case.values[k]).abs() < 1e-12, "{place}: {narrow:?}");
            let ([low, high], rounding) = (case.ends[k], 1e-9);
            let (Some(narrow), Some(wide)) = (narrow[k].1, wide[k].1) else {
                assert_eq!(
                    case.ends[k], [case.values[k]; 2],
                    "{place}: without an interval, nothing varies"
                );
                continue;
            };
            assert!(
                wide.low - rounding <= low && low <= narrow.low + rounding,
                "{place}: expected {low} between {wide:?} and {narrow:?}"
            );
            assert!(
                narrow.high - rounding <= high && high <= wide.high + rounding,
                "{place}: expected {high} between {narrow:?} and {wide:?}"
            );
        }
    }
}

#[test]
fn only_whole_runs_show_variation_shared_by_all_strata() {
    let Oracle { comparisons, .. } = oracle();
    let width = |resampling| {
        let interval = compared(&comparisons[0], 0.025, resampling)
            .probability
            .interval
            .unwrap();
        interval.high - interval.low
    };
    let (runs, strata) = (width(Resampling::Runs), width(Resampling::Strata));
    assert!(runs > 1.5 * strata, "{runs} {strata}");
}

#[test]
fn both_resamplings_agree_for_one_stratum() {
    let run = |k: u32| (k.to_string(), [("a", f64::from(k))]);
    let a = ScoreTable::from_runs((3..12).map(run)).unwrap();
    let b = ScoreTable::from_runs((0..8).map(run)).unwrap();
    let by = |resampling| {
        let options = BootstrapOptions {
            resampling,
            ..BootstrapOptions::default()
        };
        probability_of_improvement(&a, &b, &options).unwrap()
    };
    assert_eq!(by(Resampling::Strata), by(Resampling::Runs));
}
