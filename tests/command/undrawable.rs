//! Valid documents can be run: undrawable worlds, forbidden drifts, name collisions and unknown classes are found by `validate`
//! and `curriculum`, and `run` skips undrawable worlds on request.

#[cfg(feature = "gltf")]
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::run_files::write;
use super::terminal::{Says, driftworld_in, fail_in, json_in, output, scratch, succeed, succeed_in, text};
use crate::tier::quick_or_full;

/// Rocks that do not fit into some worlds, a number whose middle range is forbidden, and variants with the same name in logs.
fn quarry(folder: &Path) -> PathBuf {
    let path = folder.join("quarry.json");
    write(
        &path,
        r#"{ "version": 2, "name": "quarry", "require": ["x <= 4 or x >= 6"],
        "parameters": {
            "x": { "role": "variant", "type": "number", "affects": ["T"], "range": [0, 10], "default": 0 },
            "rocks": { "role": "variant", "type": "integer", "affects": ["S"], "range": [0, 4], "default": 0 } },
        "world": { "max_steps": 3, "environment_params": { "map_size": [40, 40] } },
        "groups": [{ "name": "rocks", "count": { "param": "rocks" }, "object": { "class": "rock" }, "separation": 5,
            "keep_out": { "walls": 0, "agent": 0 }, "placement": { "box": { "low": [10, 10], "high": [18, 18] } } }],
        "variants": { "low": {}, "high": { "x": 10 }, "full": { "rocks": 4 }, "l-ow": { "x": 1 } } }"#,
    );
    path
}

#[test]
fn validate_draws_worlds_of_every_variant_and_reports_failures() {
    let folder = scratch();
    let task = quarry(folder.path());
    succeed(&["validate", text(&task)]);
    let done = output(&mut driftworld_in(
        folder.path(),
        "validate quarry.json --worlds 30 --json",
    ));
    assert_eq!(done.status.code(), Some(1));
    let verdicts: Value = serde_json::from_slice(&done.stdout).expect("it is JSON");
    assert_eq!(verdicts[0]["valid"], false);
    let trials = verdicts[0]["worlds"].as_array().expect("there is a list");
    assert_eq!(trials.len(), 4);
    for trial in trials {
        let failed = trial["placement"].as_u64().expect("it is a count");
        assert_eq!(failed > 0, trial["variant"] == "quarry#full", "{trial}");
        assert_eq!(trial["worlds"], 30);
        assert_eq!(trial["failed"].as_array().map_or(0, Vec::len) as u64, failed);
    }
    let error = fail_in(folder.path(), 1, "validate quarry.json --worlds 30");
    error.says("of which");
    error.says("of 120 worlds cannot be drawn");
    let fine = succeed(&["validate", "examples/tasks", "--worlds", "2"]);
    assert!(fine.contains("find_objects#red"), "{fine}");
}

#[test]
fn drift_across_a_forbidden_value_is_found_before_the_run() {
    let folder = scratch();
    quarry(folder.path());
    let design = "curriculum quarry.json#low high --drift linear --learn 41 --eval-episodes 5 -o s.json";
    let error = fail_in(folder.path(), 1, design);
    error.says("quarry#low..high");
    error.says("x <= 4 or x >= 6");
    assert!(
        !folder.path().join("s.json").exists(),
        "a scenario that cannot be run is not written"
    );
    let way = |number: &str| error.contains(&format!("at progress {number}"));
    assert!(way("0.425"), "the error names the first forbidden value: {error}");

    succeed_in(folder.path(), &format!("{design} --worlds 0"));
    let error = fail_in(folder.path(), 1, "validate s.json --worlds 2");
    assert!(error.contains("worlds cannot be drawn"), "{error}");

    // The run stops there, says so, and suggests how to continue.
    let run = "run s.json --agent random --output log";
    let error = fail_in(folder.path(), 1, run);
    error.says("experience 27, quarry#low..high at progress 0.425");
    assert!(error.contains("--resume and --skip-undrawable"), "{error}");
    let error = fail_in(folder.path(), 1, &format!("{run} --resume"));
    assert!(error.contains("--skip-undrawable"), "{error}");
    let summary = json_in(folder.path(), &format!("{run} --resume --skip-undrawable --json"));
    // Progress 0.425 to 0.575 in steps of a fortieth.
    assert_eq!(
        (summary["skipped"].as_u64(), summary["experiences"].as_u64()),
        (Some(7), Some(54)),
        "{summary}"
    );
    assert_eq!(summary["left_out"][0]["experience"], 27);
    let shown = succeed_in(folder.path(), &format!("{run} --resume"));
    assert!(shown.contains("left out: 7 experiences"), "{shown}");
    let checked = succeed_in(folder.path(), "logs validate log");
    assert!(checked.contains("valid; 61 rows"), "{checked}");
    succeed_in(folder.path(), "metrics log");
}

#[test]
fn undrawable_first_world_is_skipped_on_request() {
    let folder = scratch();
    quarry(folder.path());
    let design = "curriculum quarry.json#full --worlds 0 --learn 12 --eval-episodes 5 -o s.json --seed 1";
    succeed_in(folder.path(), design);
    let run = "run s.json --agent random --output log --skip-undrawable --json";
    let summary = json_in(folder.path(), run);
    let (num_run, skipped) = (summary["experiences"].as_u64(), summary["skipped"].as_u64());
    assert_eq!(num_run.unwrap_or_default() + skipped.unwrap_or_default(), 22);
    assert!(num_run > Some(0) && skipped > Some(0), "{summary}");
}

#[test]
fn name_collisions_in_logs_are_found_by_validate_and_curriculum() {
    let folder = scratch();
    quarry(folder.path());
    let error = fail_in(folder.path(), 1, "curriculum quarry.json#low l-ow -o s.json");
    assert!(error.contains("quarry_low"), "{error}");
    let scenario = r#"{ "name": "s", "blocks": [{ "type": "learning", "regimes": [
        { "task": "quarry.json", "variant": "low", "count": 1 }, { "task": "quarry.json", "variant": "l-ow", "count": 1 }] }] }"#;
    write(&folder.path().join("s.json"), scenario);
    let error = fail_in(folder.path(), 1, &["validate", "s.json"]);
    assert!(error.contains("quarry_low"), "{error}");
    let task = output(&mut driftworld_in(folder.path(), &["validate", "quarry.json"]));
    let warned = String::from_utf8_lossy(&task.stderr).into_owned();
    assert!(
        task.status.success() && warned.contains("\"low\" and \"l-ow\" have the same name in logs"),
        "{warned}"
    );
}

#[test]
fn unknown_class_is_an_error_that_suggests_a_library() {
    let folder = scratch();
    let here = folder.path();
    write(
        &here.join("w.json"),
        r#"{ "objects": [{ "class": "shrb", "coordinates": [3, 4] }] }"#,
    );
    write(
        &here.join("t.json"),
        r#"{ "version": 2, "name": "t", "world": { "max_steps": 3 }, "groups": [{ "name": "bushes", "count": 2, "object": { "class": "bushh" },
            "placement": { "disc": { "center": [0, 0], "radius": 9 } } }] }"#,
    );
    let error = fail_in(here, 1, &["validate", "w.json", "t.json"]);
    error.says("did you mean \"shrub\"?");
    error.says("(/groups/0/object/class): found the unknown class \"bushh\"");
    assert!(error.contains("--assets LIBRARY"), "{error}");
    assert!(fail_in(here, 1, &["curriculum", "t.json", "-o", "s.json"]).contains("bushh"));
    // A scenario with such a task is refused, as by `run`.
    write(
        &here.join("s.json"),
        r#"{ "version": 1, "name": "s", "blocks": [{ "type": "learning", "regimes": [{ "task": "t.json", "variant": "default", "count": 1 }] }] }"#,
    );
    assert!(fail_in(here, 1, &["validate", "s.json"]).contains("bushh"));
    assert!(fail_in(here, 1, &["run", "s.json", "--agent", "random"]).contains("bushh"));
}

#[test]
fn unknown_model_is_refused_by_every_command_that_trains() {
    let folder = scratch();
    let here = folder.path();
    let check = |class: &str, model: &str, expected: &[&str]| {
        let object = format!(r#"{{ "class": "{class}", "model": {model}"#);
        let task = format!(
            r#"{{ "version": 2, "name": "t", "parameters": {{ "m": {{ "role": "variant", "type": "string", "affects": ["S"],
                "choices": ["1", "foxx"], "default": "1" }} }}, "variants": {{ "plain": {{}} }}, "world": {{ "max_steps": 3 }},
                "groups": [{{ "name": "g", "count": 1, "object": {object} }}, "placement": {{ "disc": {{ "center": [0, 0], "radius": 9 }} }} }}] }}"#
        );
        write(&here.join("t.json"), &task);
        let scenario = r#"{ "version": 1, "name": "s", "blocks": [{ "type": "learning", "regimes": [{ "task": "t.json", "variant": "default", "count": 1 }] }] }"#;
        write(&here.join("s.json"), scenario);
        let mut commands = vec![
            "validate t.json",
            "validate s.json",
            "validate t.json --worlds 1",
            "curriculum t.json -o c.json",
            "run s.json --agent random",
            "sample t.json#plain",
            "scales t.json --worlds 2",
            "elements t.json",
        ];
        if !model.contains("param") {
            write(
                &here.join("w.json"),
                &format!(r#"{{ "objects": [{object}, "coordinates": [3, 4] }}] }}"#),
            );
            commands.push("validate w.json");
        }
        for command in commands {
            let done = output(&mut driftworld_in(here, command));
            let error = String::from_utf8_lossy(&done.stderr).into_owned();
            assert_eq!(done.status.success(), expected.is_empty(), "{command}: {error}");
            assert!(expected.iter().all(|part| error.contains(part)), "{command}: {error}");
        }
    };
    let advice = "--assets LIBRARY";
    check(
        "animal",
        "\"foxx\"",
        &[
            "/model): found the unknown model \"foxx\" of class \"animal\"",
            "did you mean \"fox\"?",
            advice,
        ],
    );
    check(
        "geometric",
        "\"9\"",
        &["expected one of cube, sphere, cylinder", advice],
    );
    check("tree", "50", &["expected one of 1 to 49", advice]);
    check(
        "animal",
        r#"{ "param": "m" }"#,
        &["found the unknown model \"foxx\"", advice],
    );
    check("geometric", "\"Sphere\"", &[]);
    // L2Explorer draws objects of unknown classes and models anyway.
    let original = r#"{ "objects": [{ "class": "Tree", "model": "77", "coordinates": ["3", 4] }] }"#;
    write(&here.join("o.json"), original);
    let done = output(&mut driftworld_in(here, "validate --l2explorer o.json"));
    let warned = String::from_utf8_lossy(&done.stderr).into_owned();
    assert!(
        done.status.success() && warned.contains("model \"77\" of class \"tree\"; a placeholder is shown"),
        "{warned}"
    );
}

/// The classes of a library are known only with `--assets`.
#[cfg(feature = "gltf")]
#[test]
fn classes_of_a_named_library_are_known() {
    let folder = scratch();
    let here = folder.path();
    let model = format!("{}/examples/assets/lighthouse.gltf", env!("CARGO_MANIFEST_DIR"));
    succeed_in(here, &["assets", "pack", &model, "-o", "h.assets"]);
    let harbour = format!("{}/examples/assets/harbour.json", env!("CARGO_MANIFEST_DIR"));
    fs::copy(harbour, here.join("harbour.json")).expect("it can be copied");
    assert!(fail_in(here, 1, &["validate", "harbour.json"]).contains("unknown class"));
    succeed_in(here, &["validate", "harbour.json", "--assets", "h.assets"]);
}

#[test]
fn curriculum_starts_with_the_first_named_variant() {
    let folder = scratch();
    let first = |names: &str| {
        let scenario = json_in(folder.path(), &format!("curriculum {names} --worlds 0"));
        let blocks = scenario["blocks"].as_array().expect("there are blocks").clone();
        let learned = blocks.into_iter().filter(|block| block["type"] == "learning");
        learned
            .map(|block| block["regimes"][0]["variant"].as_str().unwrap_or_default().to_owned())
            .collect::<Vec<_>>()
    };
    let names = ["blue", "red", "dusk", "huddle"];
    for a in names.into_iter().take(quick_or_full(1, 4)) {
        for b in names.into_iter().filter(|b| *b != a) {
            assert_eq!(first(&format!("find_objects#{a} {b}")), [a, b]);
        }
    }
    let three = "find_objects#dusk blue red";
    assert_eq!(first(three)[0], "dusk", "whichever order is shorter");
    assert_eq!(first(&format!("{three} --order named")), ["dusk", "blue", "red"]);
    assert_eq!(first(&format!("{three} --start red"))[0], "red");
}

#[test]
fn probe_takes_the_named_variants_or_says_why_not() {
    let folder = scratch();
    let shown = succeed_in(
        folder.path(),
        "curriculum find_objects#red dusk --probe observation -o s.json",
    );
    assert!(shown.contains("distances from find_objects#red"), "{shown}");
    assert!(!shown.contains("find_objects#blue"), "only the named variants: {shown}");
    let error = fail_in(folder.path(), 1, "curriculum find_objects#red dusk --probe reward");
    error.says("find_objects#red and find_objects#dusk, which differ in observation");
}

#[test]
fn planner_tries_the_worlds_of_validate_and_reports_failures() {
    let folder = scratch();
    let task = |name: &str, wall: &str| {
        let text = format!(
            r#"{{ "version": 2, "name": "{name}", "world": {{ "max_steps": 400, "environment_params": {{ "map_size": [30, 30],
                "walls": [{wall}], "zones": [{{ "disc": {{ "center": [0, 10], "radius": 1 }}, "ends": "success" }}] }} }} }}"#
        );
        write(&folder.path().join(format!("{name}.json")), &text);
    };
    task("ways", r#"{ "polygon": [[-9, 4], [9, 4], [9, 5], [-9, 5]] }"#);
    task("closed", r#"{ "polygon": [[-15, 4], [15, 4], [15, 5], [-15, 5]] }"#);
    let trial_of = |name: &str| {
        let verdicts = json_in(folder.path(), &format!("validate {name} --worlds 3 --json"));
        (
            verdicts[0]["worlds"][0]["expert"]["succeeded"].as_u64(),
            verdicts[0]["warnings"].to_string(),
        )
    };
    assert_eq!(trial_of("ways.json"), (Some(3), "[]".to_owned()));
    let (succeeded, warnings) = trial_of("closed.json");
    assert_eq!(succeeded, Some(0));
    assert!(warnings.contains("0 of 3 worlds, but not in 0, 1, 2"), "{warnings}");
}
