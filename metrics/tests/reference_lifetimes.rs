//! Oracle: random lifetimes, generated and scored with l2metrics by `oracles/l2metrics_lifetimes.py`.

use driftworld_metrics::{
    LifetimeMetrics, Log, LogWriter, LoggerInfo, Options, Record, ScenarioInfo, SteLog, Timestamp, read_log, score,
};
use serde_json::Value;

use crate::agreement::{compare, compare_regimes};

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
    // Reverses the experts, because the reference lists the most recently stored run first.
    let experts = case["experts"]
        .as_array()
        .unwrap()
        .iter()
        .rev()
        .map(|rows| SteLog::new(log_of(rows)).unwrap());
    score(&log_of(&case["rows"]), &experts.collect::<Vec<_>>(), &options).unwrap()
}

#[test]
fn random_lifetimes_match_the_reference() {
    let oracle: Value = serde_json::from_str(include_str!("oracles/l2metrics_lifetimes.json")).unwrap();
    let mut num_numbers = 0;
    for case in oracle["cases"].as_array().unwrap() {
        let place = format!("seed {}", case["seed"]);
        let found = scored(case);
        num_numbers += compare_regimes(&place, &found, &case["regimes"]);
        let tasks = serde_json::to_value(&found.task_metrics).unwrap();
        num_numbers += compare(&format!("{place}, tasks"), &tasks, &case["tasks"]);
        let lifetime = serde_json::to_value(&found.lifetime).unwrap();
        num_numbers += compare(&format!("{place}, lifetime"), &lifetime, &case["lifetime"]);
    }
    assert!(num_numbers > 2000, "only {num_numbers} numbers were compared");
}
