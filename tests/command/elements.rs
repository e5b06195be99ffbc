//! `driftworld elements`, and `driftworld validate --elements`.

use std::fs;

use serde_json::Value;

use super::terminal::{Says, driftworld_in, fail_in, json, output, scratch, succeed, succeed_in, text};
use crate::tier::quick_or_full;

/// A task whose parameter for the light declares the elements in `affects`, and whose reach has no effect.
fn task(affects: &str) -> String {
    format!(
        r#"{{ "name": "lamp", "parameters": {{
            "light": {{ "role": "variant", "type": "number", "affects": ["{affects}"], "range": [0, 4], "default": 2 }},
            "reach": {{ "role": "variant", "type": "number", "affects": ["T"], "range": [0, 9], "default": 0 }} }},
           "world": {{ "environment_params": {{ "light_intensity": {{ "param": "light" }} }} }},
           "groups": [{{ "name": "trees", "count": 3, "object": {{ "class": "tree", "range_stimulus_distance": {{ "param": "reach" }} }},
             "placement": {{ "disc": {{ "center": [0, 0], "radius": 9 }} }} }}],
           "variants": {{ "day": {{}}, "dusk": {{ "light": 1 }}, "reaching": {{ "light": 1, "reach": 3 }} }} }}"#
    )
}

#[test]
fn declared_and_measured_elements_are_shown_together() {
    let stdout = succeed(&["elements", "blue_red_green", "--worlds", "3"]);
    assert!(stdout.starts_with("blue_red_green, compared with a:"), "{stdout}");
    let row = |name: &str| {
        let line = stdout.lines().find(|line| line.starts_with(&format!("{name}  ")));
        let words = line.unwrap_or_else(|| panic!("{name} in {stdout}")).split_whitespace();
        words.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(row("b")[1..6], ["S", "R", "S", "yes", "3"]);
    assert_eq!(row("d")[1..8], ["S", "R", "O", "S", "phi", "yes", "3"]);
    assert_eq!(row("d").last().map(String::as_str), Some("sound"));
    let looks_alone = succeed(&["elements", "find_objects", "blue", "red", "--worlds", "1"]);
    assert!(!looks_alone.contains("best changes"), "{looks_alone}");
}

#[test]
fn two_variants_are_compared_for_a_learners_images() {
    let measured = |modalities: &str| {
        let found = json(&format!(
            "elements find_objects red penalty --modalities {modalities} --worlds 2 --json"
        ));
        assert_eq!(
            (&found["base"], &found["variants"][0]["variant"]),
            (&"red".into(), &"penalty".into())
        );
        let measured = found["variants"][0]["measured"].as_array().cloned().unwrap_or_default();
        measured
            .iter()
            .map(|one| one["element"].as_str().unwrap_or_default().to_owned())
            .collect::<Vec<_>>()
    };
    assert_eq!(measured("rgb,depth"), ["R"]);
}

#[test]
fn contradiction_is_reported_with_its_first_case() {
    let folder = scratch();
    let lamp = |affects: &str| fs::write(folder.path().join("lamp.json"), task(affects)).expect("it is writable");
    lamp("R");
    for arguments in ["elements lamp.json", "validate --elements lamp.json"] {
        let error = fail_in(folder.path(), 1, arguments);
        assert!(
            error.contains(
                "lamp#dusk: found that phi (emission) differs from day: in world 0, step 0 (still), the rgb image"
            ),
            "{error}"
        );
        error.says("expected no more than light (R) affects; add \"phi\" to its \"affects\"");
        error.says("warning: ");
        error.says("lamp#reaching: reach made no difference");
    }
    let report = output(&mut driftworld_in(
        folder.path(),
        "validate --elements --json lamp.json",
    ));
    let report: Value = serde_json::from_slice(&report.stdout).expect("it is JSON");
    assert_eq!(
        (&report[0]["valid"], &report[0]["problems"][0]["code"]),
        (&false.into(), &"task/elements".into())
    );
    // Follow the advice in the message.
    lamp("phi");
    let stdout = succeed_in(folder.path(), "validate --elements lamp.json");
    assert!(stdout.contains("a valid task"), "{stdout}");
    succeed_in(folder.path(), "elements lamp.json");
}

#[test]
fn scenario_is_refused_for_false_claims_of_its_tasks() {
    let folder = scratch();
    let scenario = r#"{ "version": 1, "name": "s", "blocks": [
        { "type": "learning", "regimes": [{ "task": "./lamp.json", "variant": "dusk", "count": 1, "seed": 1, "max_steps": 5 }] }] }"#;
    fs::write(folder.path().join("s.json"), scenario).unwrap();
    for (affects, is_sound) in [("phi", true), ("R", false)] {
        fs::write(folder.path().join("lamp.json"), task(affects)).unwrap();
        let done = output(&mut driftworld_in(folder.path(), "validate s.json --elements --json"));
        assert_eq!(done.status.success(), is_sound, "{affects}");
        let verdicts: Value = serde_json::from_slice(&done.stdout).expect("it is JSON");
        assert_eq!(verdicts[0]["valid"], is_sound);
        assert_eq!(verdicts[0]["elements"][0]["task"], "lamp", "{verdicts}");
    }
}

/// A door that opens by itself late in the episode: too late for a few steps.
#[test]
fn more_steps_find_later_differences() {
    let folder = scratch();
    let late = r#"{ "name": "late", "parameters": {
        "period": { "role": "variant", "type": "number", "affects": ["T"], "range": [2, 400], "default": 400 } },
      "world": { "objects": [{ "class": "door", "coordinates": [9, 9], "door": { "opens_on": [], "period": { "param": "period" } } }] },
      "variants": { "never": {}, "later": { "period": 120 } } }"#;
    fs::write(folder.path().join("late.json"), late).unwrap();
    let warned = |steps: u32| {
        let line = format!("validate late.json --elements --steps {steps}");
        let done = output(&mut driftworld_in(folder.path(), &line));
        assert!(done.status.success());
        String::from_utf8(done.stderr).unwrap()
    };
    let soon = warned(50);
    soon.says("period made no difference");
    soon.says("give --steps more than 50");
    assert_eq!(warned(700), "");
}

#[test]
fn claims_of_the_examples_hold() {
    let files = ["worlds", "tasks"].into_iter().flat_map(|folder| {
        fs::read_dir(format!("{}/examples/{folder}", env!("CARGO_MANIFEST_DIR")))
            .unwrap()
            .map(|entry| entry.unwrap().path())
    });
    let files = files.filter(|path| path.extension().is_some_and(|extension| extension == "json"));
    let mut number = 0;
    for (_, path) in files.enumerate().filter(|(turn, _)| crate::is_turn(*turn, 5)) {
        let task = driftworld::spec::TaskSpec::from_json(text(&path), &fs::read_to_string(&path).unwrap()).unwrap();
        let request = driftworld::elements::ElementsRequest {
            worlds: quick_or_full(1, 2),
            ..driftworld::elements::ElementsRequest::of(task.name())
        };
        let found = driftworld::elements::elements_of(&task, &request)
            .unwrap_or_else(|failure| panic!("{}: {failure:?}", path.display()));
        let wrong: Vec<&str> = found.contradictions().collect();
        assert!(wrong.is_empty(), "{wrong:#?}");
        number += 1;
    }
    assert!(number >= quick_or_full(9, 45), "{number} examples");
}

#[test]
fn remarks_on_worlds_are_shown_for_the_task_that_draws_them() {
    let folder = scratch();
    let odd = r#"{ "name": "odd", "world": { "environment_params": { "map_size": [20, 20], "zones": [{ "disc": { "center": [90, 0], "radius": 1 }, "name": "far" }] },
        "objects": [{ "class": "switch", "coordinates": [2, 2], "switch": { "target": "nothing" } }] },
      "variants": { "a": {}, "b": {} } }"#;
    fs::write(folder.path().join("odd.json"), odd).unwrap();
    for (arguments, of) in [
        ("", "in 2 of 2 worlds, from 2 variants"),
        ("--worlds 7", "in 14 of 14 worlds, from 2 variants"),
    ] {
        let done = output(&mut driftworld_in(
            folder.path(),
            &format!("validate odd.json {arguments}"),
        ));
        assert!(done.status.success());
        let warnings = String::from_utf8(done.stderr)
            .unwrap()
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ");
        for expected in [
            "(/environment_params/zones/0): the zone lies outside",
            "(/objects/0/switch/target): ",
        ] {
            assert!(warnings.contains(expected), "{warnings}");
        }
        assert_eq!(warnings.matches(of).count(), 2, "{warnings}");
    }
}
