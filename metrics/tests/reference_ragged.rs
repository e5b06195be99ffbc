//! Oracle: random ragged lifetimes, generated and scored with l2metrics by `oracles/l2metrics_ragged.py`.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::io::Read as _;
use std::path::Path;

use driftworld_metrics::{LifetimeMetrics, Options, SteLog, read_log, read_ste_log, score};
use flate2::read::GzDecoder;
use serde_json::Value;

use crate::agreement::{compare, compare_regimes};

/// Lists with one value per expert, whose order is unspecified because the reference takes experts in file system order.
const PER_EXPERT: [&str; 6] = [
    "ste_rel_perf_vals",
    "ste_saturation_vals",
    "ste_exp_to_sat_vals",
    "se_saturation_vals",
    "se_exp_to_sat_vals",
    "sample_efficiency_vals",
];

fn oracle() -> Value {
    let mut text = String::new();
    GzDecoder::new(&include_bytes!("oracles/l2metrics_ragged.json.gz")[..])
        .read_to_string(&mut text)
        .unwrap();
    serde_json::from_str(&text).unwrap()
}

fn text(value: &Value) -> &str {
    value.as_str().unwrap()
}

fn list(value: &Value) -> &[Value] {
    value.as_array().unwrap()
}

/// A cell as Python's csv writes it.
fn quoted(cell: &str) -> String {
    if cell.contains(['\t', '"', '\n', '\r']) {
        format!("\"{}\"", cell.replace('"', "\"\""))
    } else {
        cell.to_owned()
    }
}

/// Writes a log as the oracle does, without our writer.
fn write(dir: &Path, oracle: &Value, segments: &Value) {
    let header: Vec<&str> = list(&oracle["header"]).iter().map(text).collect();
    let mut files: BTreeMap<String, String> = BTreeMap::new();
    for segment in list(segments) {
        let (block, kind, worker) = (&segment["block"], text(&segment["kind"]), text(&segment["worker"]));
        let file = files
            .entry(format!("{worker}/{block}-{kind}"))
            .or_insert_with(|| format!("{}\n", header.join("\t")));
        let statuses = text(&segment["status"]).chars();
        for (k, (status, exp)) in statuses.zip(list(&segment["exp"])).enumerate() {
            let of = |column: &str| text(&segment[column][k]).to_owned();
            let index = |list: &str, index: &Value| text(&oracle[list][index.as_u64().unwrap() as usize]).to_owned();
            let cells = [
                block.to_string(),
                exp.to_string(),
                worker.to_owned(),
                kind.to_owned(),
                text(&segment["subtype"]).to_owned(),
                text(&segment["task"]).to_owned(),
                index("params", &segment["params"]),
                if status == 'c' { "complete" } else { "incomplete" }.to_owned(),
                format!("20200913T122640.{:06}", exp.as_u64().unwrap()),
                index("comments", &segment["comment"][k]),
                of("pay"),
                of("score"),
            ];
            writeln!(file, "{}", cells.map(|cell| quoted(&cell)).join("\t")).unwrap();
        }
    }
    fs::create_dir_all(dir).unwrap();
    let info = r#"{"metrics_columns": ["score", "pay"], "log_format_version": "1.1"}"#;
    fs::write(dir.join("logger_info.json"), info).unwrap();
    fs::write(dir.join("scenario_info.json"), "{}").unwrap();
    for (folder, text) in files {
        fs::create_dir_all(dir.join(&folder)).unwrap();
        fs::write(dir.join(folder).join("data-log.tsv"), text).unwrap();
    }
}

/// Sorts the lists that have one value per expert.
fn as_sets(tasks: &Value) -> Value {
    let mut tasks = tasks.clone();
    for values in tasks.as_object_mut().unwrap().values_mut() {
        for name in PER_EXPERT {
            if let Some(list) = values.get_mut(name).and_then(Value::as_array_mut) {
                list.sort_by(|a, b| a.as_f64().partial_cmp(&b.as_f64()).unwrap());
            }
        }
    }
    tasks
}

/// Compares all values of one lifetime with the reference's.
fn agree(place: &str, found: &LifetimeMetrics, expected: &Value) -> usize {
    let mut num_numbers = compare_regimes(place, found, &expected["regimes"]);
    let tasks = serde_json::to_value(&found.task_metrics).unwrap();
    num_numbers += compare(
        &format!("{place}, tasks"),
        &as_sets(&tasks),
        &as_sets(&expected["tasks"]),
    );
    let lifetime = serde_json::to_value(&found.lifetime).unwrap();
    num_numbers += compare(&format!("{place}, lifetime"), &lifetime, &expected["lifetime"]);
    let all = serde_json::to_value(found).unwrap();
    for (name, expected) in expected["whole"].as_object().unwrap() {
        num_numbers += compare(&format!("{place}, {name}"), &all[name], expected);
    }
    // The reference keeps given ranges of tasks that the lifetime lacks.
    num_numbers
        + compare(
            &format!("{place}, range"),
            &all["normalization_data_range"],
            &expected["range"],
        )
}

#[test]
fn ragged_lifetimes_match_the_reference() {
    let oracle = oracle();
    let cases = list(&oracle["cases"]);
    assert!(cases.len() >= 50, "{} lifetimes", cases.len());
    let mut num_numbers = 0;
    for case in cases {
        let base = tempfile::tempdir().unwrap();
        write(&base.path().join("life"), &oracle, &case["life"]);
        let log = read_log(base.path().join("life")).unwrap();
        // The reference lists the most recently stored run of a task first.
        let experts: Vec<SteLog> = (list(&case["experts"]).iter().enumerate().rev())
            .map(|(number, segments)| {
                let dir = base.path().join(format!("expert{number}"));
                write(&dir, &oracle, segments);
                read_ste_log(dir).unwrap()
            })
            .collect();
        for scored in list(&case["scored"]) {
            let place = format!("seed {}, {}", case["seed"], scored["options"]);
            let options: Options = serde_json::from_value(scored["options"].clone()).unwrap();
            let found = score(&log, &experts, &options).unwrap();
            num_numbers += agree(&place, &found, scored);
        }
    }
    assert!(num_numbers > 10_000, "only {num_numbers} numbers were compared");
}
