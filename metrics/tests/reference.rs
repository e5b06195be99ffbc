//! Oracle: the example lifetime published with l2metrics, scored with its example experts, compared with its published results.
//!
//! Without the files the tests are skipped, see `reference_data`.

use driftworld_metrics::{LifetimeMetrics, Options, SteLog, read_log, read_log_with_texts, read_ste_log, score};
use serde_json::Value;

use crate::agreement::compare_above;
use crate::reference_data::reference;

/// The reference sums in a different order; its published lifetime values have ten decimals.
const TOLERANCE: f64 = 1e-9;

fn experts(dir: &std::path::Path, runs: &[&str]) -> Vec<SteLog> {
    runs.iter()
        .map(|run| read_ste_log(dir.join("ste_logs").join(run)).unwrap())
        .collect()
}

fn options() -> Options {
    Options {
        perf_measure: "performance".to_owned(),
        ..Options::default()
    }
}

fn scored(dir: &std::path::Path, options: &Options) -> LifetimeMetrics {
    let runs = [
        "ste_task1_1_run1",
        "ste_task2_1_run1",
        "ste_task3_1_run1",
        "ste_task3_1_run2",
    ];
    let log = read_log(dir.join("ll_logs/multi_task")).unwrap();
    assert_eq!(log.warnings, []);
    score(&log, &experts(dir, &runs), options).unwrap()
}

/// Compares two documents with equal fields, numbers by relative tolerance; returns how many numbers were compared.
fn compare(place: &str, found: &Value, expected: &Value) -> usize {
    // The comparison with swapped arguments finds fields that only the reference has.
    compare_above(f64::MIN_POSITIVE, place, expected, found);
    compare_above(f64::MIN_POSITIVE, place, found, expected)
}

#[test]
fn every_published_number_is_reproduced() {
    let Some(dir) = reference("l2metrics") else { return };
    let expected = std::fs::read(dir.join("expected/multi_task_metrics.json")).unwrap();
    let expected: Value = serde_json::from_slice(&expected).unwrap();
    let mut found = serde_json::to_value(scored(&dir, &options())).unwrap();
    // Only our results contain this, the means of the log's columns before scaling.
    found.as_object_mut().unwrap().shift_remove("as_logged").unwrap();
    let num_numbers = compare("", &found, &expected);
    assert!(num_numbers > 150, "only {num_numbers} numbers were compared");
}

#[test]
fn every_published_regime_is_reproduced() {
    let Some(dir) = reference("l2metrics") else { return };
    let expected = std::fs::read_to_string(dir.join("expected/multi_task_regime.tsv")).unwrap();
    let found = scored(&dir, &options()).regime_tsv();
    let (found, expected): (Vec<&str>, Vec<&str>) = (found.lines().collect(), expected.lines().collect());
    assert_eq!(found[0], expected[0]);
    assert_eq!(found.len(), expected.len());
    for (found_row, expected_row) in found.iter().zip(&expected).skip(1) {
        for (found, expected) in found_row.split('\t').zip(expected_row.split('\t')) {
            match (found.parse::<f64>(), expected.parse::<f64>()) {
                (Ok(a), Ok(b)) => assert!((a - b).abs() <= TOLERANCE * b.abs(), "{found_row}\n{expected_row}"),
                _ => assert_eq!(found, expected),
            }
        }
        assert_eq!(found_row.split('\t').count(), expected_row.split('\t').count());
    }
}

#[test]
fn settings_have_every_field_of_the_published_ones() {
    let Some(dir) = reference("l2metrics") else { return };
    let expected = std::fs::read(dir.join("expected/multi_task_settings.json")).unwrap();
    let expected: Value = serde_json::from_slice(&expected).unwrap();
    let log_dir = "ll_logs\\multi_task".to_owned();
    let found = serde_json::to_value(driftworld_metrics::Settings {
        log_dir,
        options: options(),
    })
    .unwrap();
    for (field, value) in expected.as_object().unwrap() {
        assert_eq!(&found[field], value, "{field}");
    }
}

/// `oracles/l2metrics_options.py` computed the numbers with the reference itself.
#[test]
fn every_option_matches_the_reference() {
    let Some(dir) = reference("l2metrics") else { return };
    let cases: Value = serde_json::from_str(include_str!("oracles/l2metrics_options.json")).unwrap();
    let mut num_numbers = 0;
    for case in cases["cases"].as_array().unwrap() {
        let mut options: Options = serde_json::from_value(case["options"].clone()).unwrap();
        options.perf_measure = "performance".to_owned();
        let found = serde_json::to_value(scored(&dir, &options).lifetime).unwrap();
        num_numbers += compare(&case["options"].to_string(), &found, &case["lifetime"]);
    }
    assert!(num_numbers > 100, "only {num_numbers} numbers were compared");
}

#[test]
fn l2logger_example_with_a_text_column_is_read() {
    let Some(dir) = reference("l2metrics") else { return };
    let log_dir = tempfile::tempdir().unwrap();
    let block = log_dir.path().join("driver.py_0/0-train");
    std::fs::create_dir_all(&block).unwrap();
    std::fs::copy(dir.join("example_data_log.tsv"), block.join("data-log.tsv")).unwrap();
    std::fs::copy(
        dir.join("example_logger_info.json"),
        log_dir.path().join("logger_info.json"),
    )
    .unwrap();
    std::fs::copy(
        dir.join("example_scenario_info.json"),
        log_dir.path().join("scenario_info.json"),
    )
    .unwrap();
    let log = read_log(log_dir.path()).unwrap();
    assert_eq!(log.rows.len(), 100);
    assert_eq!(
        log.rows.metric_names().collect::<Vec<_>>(),
        ["reward"],
        "debug_info contains text"
    );
    let whole = read_log_with_texts(log_dir.path()).unwrap();
    assert_eq!(whole.rows.text_names().collect::<Vec<_>>(), ["debug_info"]);
    assert_ne!(whole.rows.get(0).unwrap().text("debug_info"), Some(""));
    assert_eq!(log.rows.get(0).unwrap().task_params()["param2"], 2);
    let metrics = score(&log, &[], &Options::default()).unwrap();
    assert_eq!(
        metrics.lifetime.number("avg_train_perf"),
        Some(1.0),
        "a constant task is 1 everywhere"
    );
}
