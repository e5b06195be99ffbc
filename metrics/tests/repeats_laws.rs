//! Properties of the statistics over repeats, for arbitrary scores.

use driftworld_metrics::{
    Aggregate, BootstrapOptions, Estimate, Resampling, ScoreTable, estimate, probability_of_improvement,
};
use proptest::prelude::*;

const MEANS: [Aggregate; 3] = [Aggregate::Mean, Aggregate::Median, Aggregate::Iqm];

/// Scores of one to five runs in one to four strata; a run may lack some, but never the first.
fn rows() -> impl Strategy<Value = Vec<Vec<Option<f64>>>> {
    let score = prop_oneof![4 => -100.0..100.0_f64, 1 => prop::sample::select(vec![0.0, 1.0])];
    (1..5_usize).prop_flat_map(move |strata| {
        let rest = prop::collection::vec(prop::option::weighted(0.8, score.clone()), strata - 1);
        let run = (score.clone(), rest).prop_map(|(first, rest)| [vec![Some(first)], rest].concat());
        prop::collection::vec(run, 1..6)
    })
}

fn table_of<'a>(rows: impl IntoIterator<Item = &'a Vec<Option<f64>>>) -> ScoreTable {
    let runs = rows.into_iter().enumerate().map(|(k, row)| {
        let scores = row
            .iter()
            .enumerate()
            .filter_map(|(k, score)| Some((k.to_string(), (*score)?)));
        (k.to_string(), scores.collect::<Vec<_>>())
    });
    ScoreTable::from_runs(runs).unwrap()
}

fn mapped(rows: &[Vec<Option<f64>>], map: impl Fn(f64) -> f64) -> ScoreTable {
    let rows: Vec<Vec<Option<f64>>> = rows
        .iter()
        .map(|row| row.iter().map(|score| score.map(&map)).collect())
        .collect();
    table_of(&rows)
}

fn options(resampling: Resampling) -> BootstrapOptions {
    BootstrapOptions {
        resamples: 60,
        resampling,
        ..BootstrapOptions::default()
    }
}

fn resampling() -> impl Strategy<Value = Resampling> {
    prop::sample::select(Resampling::ALL)
}

/// The value and the ends of the interval.
fn numbers(estimate: &Estimate) -> Vec<f64> {
    let ends = estimate
        .interval
        .into_iter()
        .flat_map(|interval| [interval.low, interval.high]);
    std::iter::once(estimate.value).chain(ends).collect()
}

fn close(found: &[f64], expected: &[f64]) -> bool {
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-9 * (1.0 + a.abs().max(b.abs()));
    found.len() == expected.len() && found.iter().zip(expected).all(near)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

    #[test]
    fn means_and_intervals_lie_between_the_extreme_scores(rows in rows(), how in resampling()) {
        let scores: Vec<f64> = rows.iter().flatten().flatten().copied().collect();
        let least = scores.iter().copied().fold(f64::INFINITY, f64::min) - 1e-9;
        let greatest = scores.iter().copied().fold(f64::NEG_INFINITY, f64::max) + 1e-9;
        for found in estimate(&table_of(&rows), MEANS, &options(how)).unwrap() {
            prop_assert!(numbers(&found).iter().all(|number| (least..=greatest).contains(number)), "{found:?}");
            prop_assert!(found.interval.is_none_or(|interval| interval.low <= interval.high));
        }
    }

    #[test]
    fn shifting_and_scaling_scores_shifts_and_scales_all_results(
        rows in rows(), how in resampling(), scale in 0.1..10.0_f64, shift in -50.0..50.0_f64,
    ) {
        let map = |score: f64| scale * score + shift;
        let before = estimate(&table_of(&rows), MEANS, &options(how)).unwrap();
        let after = estimate(&mapped(&rows, map), MEANS, &options(how)).unwrap();
        for (before, after) in before.iter().zip(&after) {
            let expected: Vec<f64> = numbers(before).into_iter().map(map).collect();
            prop_assert!(close(&numbers(after), &expected), "{after:?} {expected:?}");
        }
    }

    #[test]
    fn run_order_changes_no_value_and_no_stratum_interval(
        (rows, shuffled) in rows().prop_flat_map(|rows| (Just(rows.clone()), Just(rows).prop_shuffle())),
    ) {
        // A run that has all strata fixes their order; otherwise a stratum whose first score moved would come later.
        let strata = rows[0].len();
        let full = vec![Some(0.5); strata];
        let with_full = |rows: &[Vec<Option<f64>>]| table_of(std::iter::once(&full).chain(rows));
        let (one, other) = (with_full(&rows), with_full(&shuffled));
        let by = |table: &ScoreTable, how| estimate(table, MEANS, &options(how)).unwrap();
        prop_assert_eq!(by(&one, Resampling::Strata), by(&other, Resampling::Strata));
        let values = |table: &ScoreTable| by(table, Resampling::Runs).map(|found| found.value);
        prop_assert_eq!(values(&one), values(&other));
    }

    #[test]
    fn higher_confidence_widens_the_interval(rows in rows(), how in resampling()) {
        let table = table_of(&rows);
        let interval = |confidence| {
            let options = BootstrapOptions { confidence, ..options(how) };
            estimate(&table, [Aggregate::Iqm], &options).unwrap()[0].interval
        };
        if let (Some(narrow), Some(wide)) = (interval(0.5), interval(0.9)) {
            prop_assert!(wide.low <= narrow.low && narrow.high <= wide.high, "{wide:?} {narrow:?}");
        }
    }

    #[test]
    fn one_agents_wins_are_the_others_losses(a in rows(), b in rows(), how in resampling()) {
        let (a, b) = (table_of(&a), table_of(&b));
        let of = |a: &ScoreTable, b: &ScoreTable| probability_of_improvement(a, b, &options(how)).unwrap();
        let (ours, theirs) = (of(&a, &b), of(&b, &a));
        prop_assert!((ours.probability.value + theirs.probability.value - 1.0).abs() < 1e-12);
        prop_assert_eq!(&ours.only_a, &theirs.only_b);
        for stratum in &ours.strata {
            let other = theirs.strata.iter().find(|other| other.stratum == stratum.stratum).unwrap();
            prop_assert!((stratum.probability.value + other.probability.value - 1.0).abs() < 1e-12);
            prop_assert!(numbers(&stratum.probability).iter().all(|number| (0.0..=1.0).contains(number)));
        }
        let with_itself = of(&a, &a);
        prop_assert_eq!(with_itself.probability.value, 0.5);
    }

    #[test]
    fn increasing_map_of_scores_changes_no_probability(a in rows(), b in rows(), how in resampling()) {
        let of = |a: &ScoreTable, b: &ScoreTable| probability_of_improvement(a, b, &options(how)).unwrap();
        let map = |score: f64| score.powi(3) + score;
        prop_assert_eq!(of(&table_of(&a), &table_of(&b)), of(&mapped(&a, map), &mapped(&b, map)));
    }
}
