//! Oracle: lifetimes drawn by chance, scored by l2metrics itself; `oracles/l2metrics_lifetimes.py` drew and scored them.
//!
//! Not here: the published example, see `reference`.

#![expect(clippy::unwrap_used, reason = "a test stops at its first surprise")]

use driftworld_metrics::{
    LifetimeMetrics, Log, LogWriter, LoggerInfo, Options, Record, ScenarioInfo, SteLog, Timestamp, read_log, score,
};
use serde_json::Value;

/// The reference adds in another order; its values for lifetimes have ten decimals.
const TOLERANCE: f64 = 1e-9;

fn text(value: &Value) -> &str {
    value.as_str().unwrap()
}

/// Writes the rows as a log and reads it back.
fn log_of(rows: &Value) -> Log {
    let base = tempfile::tempdir().unwrap();
    let dir = base.path().join("life");
    let mut writer = LogWriter::create(&dir, &LoggerInfo::new(["score"]).unwrap(), &ScenarioInfo::default()).unwrap();
    for row in rows.as_array().unwrap() {
        let number = |index: usize| row[index].as_u64().unwrap();
        let when = Timestamp::from_unix_micros(1_600_000_000_000_000 + number(1) as i64).unwrap();
        let record = Record::new(
            number(0),
            number(1),
            text(&row[3]).parse().unwrap(),
            text(&row[5]),
            when,
        );
        let record = Record {
            worker_id: text(&row[2]).to_owned(),
            block_subtype: text(&row[4]).parse().unwrap(),
            exp_status: text(&row[6]).parse().unwrap(),
            ..record
        };
        writer
            .write(&record.with_metric("score", row[7].as_f64().unwrap_or(f64::NAN)))
            .unwrap();
    }
    read_log(&dir).unwrap()
}

fn scored(case: &Value) -> LifetimeMetrics {
    let mut options: Options = serde_json::from_value(case["options"].clone()).unwrap();
    "score".clone_into(&mut options.perf_measure);
    // The reference lists the run that was stored last first.
    let experts = case["experts"]
        .as_array()
        .unwrap()
        .iter()
        .rev()
        .map(|rows| SteLog::new(log_of(rows)).unwrap());
    score(&log_of(&case["rows"]), &experts.collect::<Vec<_>>(), &options).unwrap()
}

/// Compares numbers within the tolerance, lists entry by entry; returns how many numbers there were.
fn compare(place: &str, found: &Value, expected: &Value) -> usize {
    match (found, expected) {
        (Value::Number(found), Value::Number(expected)) => {
            let (found, expected) = (found.as_f64().unwrap(), expected.as_f64().unwrap());
            // Differences of numbers around 100 lose what they have in common.
            let near = (found - expected).abs() <= TOLERANCE * expected.abs().max(1.0);
            assert!(near, "{place}: found {found}, the reference has {expected}");
            1
        }
        (Value::Array(found), Value::Array(expected)) => {
            assert_eq!(found.len(), expected.len(), "{place}: {found:?}, {expected:?}");
            let pairs = found.iter().zip(expected).enumerate();
            pairs
                .map(|(index, (found, expected))| compare(&format!("{place}/{index}"), found, expected))
                .sum()
        }
        (Value::Object(found), Value::Object(expected)) => {
            let names = found
                .keys()
                .filter(|name| !expected.contains_key(*name))
                .collect::<Vec<_>>();
            assert!(names.is_empty(), "{place}: the reference has no {names:?}");
            let entries = expected.iter();
            entries
                .map(|(name, expected)| compare(&format!("{place}/{name}"), &found[name], expected))
                .sum()
        }
        (found, expected) => {
            assert_eq!(found, expected, "{place}");
            0
        }
    }
}

#[test]
fn lifetimes_drawn_by_chance_have_the_references_numbers() {
    let oracle: Value = serde_json::from_str(include_str!("oracles/l2metrics_lifetimes.json")).unwrap();
    let mut num_numbers = 0;
    for case in oracle["cases"].as_array().unwrap() {
        let place = format!("seed {}", case["seed"]);
        let found = scored(case);
        for (regime, expected) in found.regimes.iter().zip(case["regimes"].as_array().unwrap()) {
            let value = |name: &str| serde_json::to_value(regime.values.get(name)).unwrap();
            let row = Value::Array(vec![
                regime.regime_num.into(),
                regime.block_num.into(),
                regime.task_name.clone().into(),
                value("saturation"),
                value("exp_to_sat"),
                value("term_perf"),
                value("exp_to_term_perf"),
                value("avg_perf"),
            ]);
            num_numbers += compare(&format!("{place}, regime {}", regime.regime_num), &row, expected);
        }
        assert_eq!(
            found.regimes.len(),
            case["regimes"].as_array().unwrap().len(),
            "{place}"
        );
        let tasks = serde_json::to_value(&found.task_metrics).unwrap();
        num_numbers += compare(&format!("{place}, tasks"), &tasks, &case["tasks"]);
        let lifetime = serde_json::to_value(&found.lifetime).unwrap();
        num_numbers += compare(&format!("{place}, lifetime"), &lifetime, &case["lifetime"]);
    }
    assert!(num_numbers > 2000, "only {num_numbers} numbers were compared");
}
