//! `driftworld elements`, and `driftworld validate --elements`.

use std::fs;

use serde_json::Value;

use crate::terminal::{driftworld, fail, output, scratch, succeed, text};

/// A task whose light is said to change what its parameter says, and which sets a reach that nothing reads.
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
fn what_is_declared_stands_beside_what_is_measured() {
    let said = succeed(&["elements", "blue_red_green", "--worlds", "3"]);
    assert!(said.starts_with("blue_red_green, beside a:"), "{said}");
    let row = |name: &str| {
        let line = said.lines().find(|line| line.starts_with(&format!("{name}  ")));
        let words = line.unwrap_or_else(|| panic!("{name} in {said}")).split_whitespace();
        words.map(str::to_owned).collect::<Vec<_>>()
    };
    assert_eq!(row("b")[1..6], ["S", "R", "S", "yes", "3"]);
    assert_eq!(row("d")[1..8], ["S", "R", "O", "S", "phi", "yes", "3"]);
    assert_eq!(row("d").last().map(String::as_str), Some("sound"));
}

#[test]
fn two_variants_are_compared_for_the_images_of_a_learner() {
    let measured = |modalities: &str| {
        let said = succeed(&[
            "elements",
            "find_objects",
            "red",
            "penalty",
            "--modalities",
            modalities,
            "--worlds",
            "2",
            "--json",
        ]);
        let found: Value = serde_json::from_str(&said).expect("JSON");
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
    fail(
        1,
        &[
            "elements",
            "find_objects",
            "red",
            "penalty",
            "--modalities",
            "segmentation",
            "--worlds",
            "2",
        ],
    );
}

#[test]
fn a_contradiction_is_told_by_its_first_case() {
    let folder = scratch();
    let path = folder.path().join("lamp.json");
    fs::write(&path, task("R")).expect("the folder can be written to");
    for arguments in [&["elements", text(&path)][..], &["validate", "--elements", text(&path)]] {
        let said = fail(1, arguments);
        assert!(
            said.contains(
                "lamp#dusk: found that phi (emission) differs from day: in world 0, step 0 (still), the rgb image"
            ),
            "{said}"
        );
        assert!(
            said.contains("expected no more than light (R) affects; add \"phi\" to its \"affects\""),
            "{said}"
        );
        assert!(
            said.contains("warning: ") && said.contains("lamp#reaching: nothing reads reach there"),
            "{said}"
        );
    }
    let report = output(&mut driftworld(&["validate", "--elements", "--json", text(&path)]));
    let report: Value = serde_json::from_slice(&report.stdout).expect("JSON");
    assert_eq!(
        (&report[0]["valid"], &report[0]["problems"][0]["code"]),
        (&false.into(), &"task/elements".into())
    );
    // The advice is taken.
    fs::write(&path, task("phi")).expect("the folder can be written to");
    let said = succeed(&["validate", "--elements", text(&path)]);
    assert!(said.contains("a valid task"), "{said}");
    succeed(&["elements", text(&path)]);
}

#[test]
fn arguments_that_make_no_experiment_are_refused() {
    fail(2, &["elements", "find_objects", "red"]);
    fail(2, &["elements", "find_objects", "--worlds", "0"]);
    fail(2, &["elements", "find_objects", "--modalities", "sound"]);
    assert!(fail(1, &["elements", "find_objects", "red", "blu"]).contains("did you mean \"blue\""));
}
