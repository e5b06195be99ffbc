//! Tests that scenario files of L2Explorer run unchanged and can be converted to our format.

use std::fs;
use std::path::Path;

use super::run_files::{files, num_rows, write};
use super::terminal::{Says, driftworld, fail, output, scratch, succeed, text};
use crate::reference_data::reference;

#[test]
fn l2explorer_scenario_runs_unchanged() {
    let Some(original) = reference("l2explorer/scenario_findobjects.json") else {
        return;
    };
    let Some(map) = reference("l2explorer/map_findobjects_0.json") else {
        return;
    };
    let folder = scratch();
    // L2Explorer keeps the maps one folder above the scenario.
    let scenario = folder.path().join("scenarios/scenario_findobjects.json");
    let copy = |from: &Path, to: &Path| write(to, &fs::read_to_string(from).expect("the reference can be read"));
    copy(&original, &scenario);
    copy(&map, &folder.path().join("map_findobjects_0.json"));
    copy(&map, &folder.path().join("map_findobjects_1.json"));
    let log = folder.path().join("log");
    let few = ["--agent", "onrails", "--output", text(&log)];
    succeed(&[&["run", text(&scenario)][..], &few].concat());
    let tables = files(&log);
    let names: Vec<&str> = tables
        .keys()
        .map(String::as_str)
        .filter(|name| name.ends_with("tsv"))
        .collect();
    let blocks = ["0-train", "1-test", "2-train", "3-test"];
    assert_eq!(
        names,
        blocks.map(|block| format!("worker-default/{block}/data-log.tsv"))
    );
    assert_eq!(num_rows(&log), 2 + 3 + 6 + 4);
    assert!(
        tables[names[3]].contains("\ttask2_mapfindobjects1\t"),
        "{}",
        tables[names[3]]
    );
    let metrics = succeed(&["metrics", text(&log), "--json"]);
    assert!(metrics.contains("task1_mapfindobjects0"), "{metrics}");

    // In our checkout, one map is beside the scenario, and the other is missing.
    let error = fail(
        1,
        &format!(
            "run {} --no-stand-in --output {}",
            original.display(),
            folder.path().join("none").display()
        ),
    );
    error.says("found no file \"../map_findobjects_1.json\", looked for");
    error.says("; or omit --no-stand-in to use ");
    let stand_in = folder.path().join("stand-in");
    let run = ["run", text(&original), "--agent", "random", "--output", text(&stand_in)];
    let output = output(&mut driftworld(&run));
    let stderr = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{stderr}");
    assert!(stderr.contains("beside the scenario"), "{stderr}");
    stderr.says("map_findobjects_1.json: not there; map_findobjects_0.json stood in for it");
    let info = &files(&stand_in)["scenario_info.json"];
    info.says("\"../map_findobjects_1.json\": \"not there; map_findobjects_0.json stood in for it\"");
    let resume = [&run[..], &["--resume"]].concat();
    succeed(&resume);
}

#[test]
fn l2explorer_scenario_is_converted() {
    let Some(original) = reference("l2explorer/scenario_findobjects.json") else {
        return;
    };
    succeed(&["validate", text(&original)]);
    let folder = scratch();
    let ours = folder.path().join("ours.json");
    succeed(&["convert", text(&original), "-o", text(&ours)]);
    succeed(&["validate", text(&ours)]);
    let json = |path: &Path| -> serde_json::Value {
        serde_json::from_str(&fs::read_to_string(path).expect("it was written")).expect("it is JSON")
    };
    let (ours, original) = (json(&ours), json(&original));
    let pairs = |blocks: &str, maps: &str, json: &serde_json::Value| -> Vec<[String; 3]> {
        let blocks = json[blocks].as_array().into_iter().flatten();
        let regimes = blocks.flat_map(|block| block["regimes"].as_array().into_iter().flatten());
        let entries = |regime: &serde_json::Value| {
            [&regime["task"], &regime["count"], regime.pointer(maps).expect("a map")].map(ToString::to_string)
        };
        regimes.map(entries).collect()
    };
    assert_eq!(
        pairs("blocks", "/world", &ours),
        pairs("scenario", "/params/map", &original)
    );
}
