//! Scenario files of L2Explorer: lived as they stand, converted to ours and back, worlds drawn as its maps.

use std::fs;
use std::path::Path;

use crate::run_files::{files, is_table, num_rows, write};
use crate::terminal::{driftworld, fail, output, reference, scratch, succeed, text};

#[test]
fn the_originals_scenario_is_lived_as_it_stands() {
    let Some(original) = reference("l2explorer/scenario_findobjects.json") else {
        return;
    };
    let Some(map) = reference("l2explorer/map_findobjects_0.json") else {
        return;
    };
    let folder = scratch();
    // As in the original: the maps lie above the scenario.
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

    // As it stands beside us: one map lies beside the scenario, the other is nowhere.
    let error = fail(
        1,
        &[
            "run",
            text(&original),
            "--no-stand-in",
            "--output",
            text(&folder.path().join("none")),
        ],
    );
    assert!(
        error.contains("found no file \"../map_findobjects_1.json\", looked for"),
        "{error}"
    );
    assert!(
        error.contains("map_findobjects_0.json instead without --no-stand-in"),
        "{error}"
    );
    let stand_in = folder.path().join("stand-in");
    let run = ["run", text(&original), "--agent", "random", "--output", text(&stand_in)];
    let output = output(&mut driftworld(&run));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(said.contains("beside the scenario"), "{said}");
    assert!(
        said.contains("map_findobjects_1.json: not there; map_findobjects_0.json stood in for it"),
        "{said}"
    );
    let info = &files(&stand_in)["scenario_info.json"];
    assert!(
        info.contains("\"../map_findobjects_1.json\": \"not there; map_findobjects_0.json stood in for it\""),
        "{info}"
    );
    let again = [&run[..], &["--resume"]].concat();
    succeed(&again);
}

#[test]
fn the_originals_scenario_goes_to_ours_and_back() {
    let Some(original) = reference("l2explorer/scenario_findobjects.json") else {
        return;
    };
    succeed(&["validate", text(&original)]);
    let folder = scratch();
    let (ours, back) = (folder.path().join("ours.json"), folder.path().join("back.json"));
    succeed(&["convert", text(&original), "-o", text(&ours)]);
    succeed(&["validate", text(&ours)]);
    succeed(&["convert", text(&ours), "--to", "l2explorer", "-o", text(&back)]);
    let json = |path: &Path| -> serde_json::Value {
        serde_json::from_str(&fs::read_to_string(path).expect("it was written")).expect("it is JSON")
    };
    assert_eq!(json(&back), json(&original));
}

#[test]
fn worlds_that_a_scenario_draws_become_maps_that_are_lived_alike() {
    let folder = scratch();
    // Without a reward for each step, which maps of the original cannot say.
    let (task, scenario) = (folder.path().join("cubes.json"), folder.path().join("scenario.json"));
    write(
        &task,
        r#"{ "name": "cubes", "world": { "max_steps": 150 }, "variants": { "few": {} },
            "groups": [{ "name": "cubes", "count": 3, "separation": 2, "placement": { "disc": { "center": [0, 0], "radius": 20 } },
                "object": { "class": "cube", "reward": 10, "reward_stimulus": ["AgentCollide"], "destroy_stimulus": ["AgentCollide"] } }] }"#,
    );
    let regime = |count: u32| {
        format!(
            r#"{{ "task": {:?}, "variant": "few", "count": {count}, "seed": 2 }}"#,
            text(&task)
        )
    };
    let blocks = [("evaluation", 2), ("learning", 5), ("evaluation", 2)]
        .map(|(kind, count)| format!(r#"{{ "type": "{kind}", "regimes": [{}] }}"#, regime(count)));
    write(
        &scenario,
        &format!(r#"{{ "name": "s", "blocks": [{}] }}"#, blocks.join(", ")),
    );
    let error = fail(2, &["convert", text(&scenario), "--to", "l2explorer"]);
    assert!(error.contains("-o"), "{error}");
    let original = folder.path().join("original/scenario.json");
    succeed(&["convert", text(&scenario), "--to", "l2explorer", "-o", text(&original)]);
    let (ours, theirs) = (folder.path().join("ours"), folder.path().join("theirs"));
    let live = |scenario: &Path, log: &Path| {
        succeed(&["run", text(scenario), "--agent", "onrails", "--output", text(log)]);
        rewards(log)
    };
    let lived = live(&scenario, &ours);
    assert_eq!(lived.len(), 9);
    assert!(lived.iter().any(|reward| reward == "30.0"), "{lived:?}");
    assert_eq!(lived, live(&original, &theirs), "the same rewards in the same order");
}

/// The rewards of a log, in order.
fn rewards(log: &Path) -> Vec<String> {
    let tables = files(log).into_iter().filter(|(name, _)| is_table(name));
    tables
        .flat_map(|(_, table)| {
            let header: Vec<String> = table
                .lines()
                .next()
                .unwrap_or_default()
                .split('\t')
                .map(str::to_owned)
                .collect();
            let place = header
                .iter()
                .position(|name| name == "reward")
                .expect("rows say the reward");
            let cell = |line: &str| line.split('\t').nth(place).unwrap_or_default().to_owned();
            table.lines().skip(1).map(cell).collect::<Vec<_>>()
        })
        .collect()
}
