//! Every error code of this crate, with a document that causes it and the message shown to its author.

use std::collections::BTreeSet;

use driftworld_spec::{Classes, Scenario, SpecError, TaskSpec, World};

fn world(text: &str) -> SpecError {
    World::from_json("w.json", text).expect_err("the world is broken on purpose")
}

fn layout(text: &str) -> SpecError {
    world(&format!("{{ \"environment_params\": {{ \"layout\": {text} }} }}"))
}

fn task(body: &str) -> SpecError {
    let text = format!("{{ \"name\": \"t\", {body} }}");
    TaskSpec::from_json("t.json", &text).expect_err("the task is broken on purpose")
}

fn parameter(body: &str) -> SpecError {
    task(&format!("\"parameters\": {{ \"p\": {body} }}"))
}

fn look_ups() -> [SpecError; 2] {
    [
        task(
            r#""parameters": { "p": { "role": "fixed", "type": "number", "value": 0 } },
               "world": { "max_steps": { "case": { "param": "p" }, "of": { "1": 100 } } }"#,
        ),
        parameter(
            r#"{ "role": "randomized", "type": "number", "affects": ["S"], "distribution": { "case": { "param": "p" }, "of": { "1": 1 }, "else": 2 } }"#,
        ),
    ]
}

fn cases() -> Vec<SpecError> {
    let number = r#""parameters": { "p": { "role": "variant", "type": "number", "affects": ["S"], "range": [0, 1], "default": 0 } }"#;
    let plain = TaskSpec::from_json("t.json", "{ \"name\": \"t\" }").expect("a name is enough for a task");
    let limited = TaskSpec::from_json(
        "t.json",
        &format!(r#"{{ "name": "t", {number}, "require": ["p > 0"] }}"#),
    )
    .expect("no declared variant breaks the requirement");
    vec![
        world("{"),
        World::from_json("w.json", &" ".repeat((64 << 20) + 1)).expect_err("the text is too long"),
        task(&format!("\"world\": {{ \"objects\": [{}0] }}", "0,".repeat(1_000_000))),
        world(&format!("{{ \"{}\": 1 }}", "k".repeat(401))),
        plain.variant("red").expect_err("the task declares no variant"),
        world(r#"{ "max_steps": 1, "max_steps": 2 }"#),
        world(r#"{ "max_step": 1 }"#),
        world(r#"{ "objects": [{ "class": "tree" }] }"#),
        world(r#"{ "max_steps": "many" }"#),
        world(r#"{ "agent_params": { "heading": 361 } }"#),
        world(r#"{ "objects": [{ "class": "tree", "coordinates": [1] }] }"#),
        world(r#"{ "environment_params": { "sun_direction": [0, 0, 0] } }"#),
        world(r#"{ "environment_params": { "map_size": [0, 10] } }"#),
        world(r#"{ "agent_params": { "observation_size": 4096, "supersampling": 3 } }"#),
        world(r#"{ "agent_params": { "action_model": "bywaypoint", "actions": "default_discrete" } }"#),
        world(r#"{ "progress": { "objects": [{}] } }"#),
        world(r#"{ "agent_params": { "energy": { "start": 101 } } }"#),
        world(r#"{ "environment_params": { "zones": [{ "speed_factor": 0.5 }] } }"#),
        world(
            r#"{ "objects": [{ "class": "tree", "coordinates": [1, 1], "unique_name": "a" },
                             { "class": "tree", "coordinates": [2, 2], "unique_name": "a" }] }"#,
        ),
        layout("{}"),
        layout(r#"{ "maze": {}, "rooms": {} }"#),
        layout(r#"{ "maze": {}, "legend": { "G": "wall" } }"#),
        world(r#"{ "environment_params": { "predefined_map": 1, "layout": { "maze": {} } } }"#),
        layout(r#"{ "maze": { "cells": [1000, 1000], "cell": 0.2, "wall": 0.1 } }"#),
        layout(r#"{ "maze": { "cells": [100, 100], "cell": 4 } }"#),
        layout(r#"{ "maze": { "wall": 3 } }"#),
        layout(r#"{ "rooms": { "room": [1, 8] } }"#),
        layout(r#"{ "text": ["*****", "*.GX*", "*****"] }"#),
        layout(r#"{ "text": ["*****", "*..*", "*****"] }"#),
        layout(r#"{ "text": ["***"] }"#),
        layout(r#"{ "text": ["*.*"], "legend": { "ab": "wall" } }"#),
        layout(
            r#"{ "walls": [{ "height": 2 }, { "from": [0, 0] }, { "from": [1, 1], "to": [1, 1] },
                               { "circle": { "center": [0, 0], "radius": 1 }, "thickness": 1 }] }"#,
        ),
        task(&format!(r#"{number}, "variants": {{ "a": {{ "extends": "b" }} }}"#)),
        task(&format!(r#"{number}, "variants": {{ "a": {{ "extends": "a" }} }}"#)),
        task(r#""world": { "max_steps": { "param": "steps" } }"#),
        parameter(
            r#"{ "role": "randomized", "type": "number", "affects": ["S"], "distribution": { "uniform": { "low": 1, "high": 0 } } }"#,
        ),
        task(r#""parameters": { "max-steps": { "role": "fixed", "type": "integer", "value": 1 } }"#),
        task(r#""parameters": { "extends": { "role": "fixed", "type": "number", "value": 1 } }"#),
        task(
            r#""parameters": { "p": { "role": "fixed", "type": "number", "value": 1 } }, "variants": { "a": { "p": 2 } }"#,
        ),
        parameter(
            r#"{ "role": "variant", "type": "number", "affects": ["S"], "range": [0, 1], "default": 0, "compare": { "measure": "oklab" } }"#,
        ),
        Scenario::from_json("s.json", r#"{ "name": "s", "blocks": [] }"#).expect_err("a scenario has blocks"),
        world(r#"{ "version": 9 }"#),
        Scenario::from_json(
            "s.json",
            r#"{ "name": "s", "blocks": [{ "type": "learning", "regimes": [
                { "task": "t", "variant": "v", "name": "w", "count": 1 },
                { "task": "t", "variant": "v", "values": { "p": 1 }, "count": 1 }] }] }"#,
        )
        .expect_err("a name and values go together"),
        task(&format!(
            r#"{number}, "require": ["p > 2"], "variants": {{ "a": {{}} }}"#
        )),
        task(&format!(r#"{number}, "require": ["p +"]"#)),
        task(&format!(
            r#"{number}, "world": {{ "max_steps": {{ "param": "p", "index": 1 }} }}"#
        )),
        task(
            r#""groups": [{ "name": "fences", "count": 1, "object": { "class": "fence" }, "around": "houses",
               "placement": { "disc": { "center": [0, 0], "radius": 9 } } }]"#,
        ),
        task(
            r#""groups": [{ "name": "stalls", "count": 5, "object": { "class": "table" }, "separation": 3,
               "placement": { "points": { "values": [[0, 0], [2, 0], [4, 0], [6, 0], [8, 0]] } } }]"#,
        ),
        World::from_json_with(
            "w.json",
            r#"{ "objects": [{ "class": "shrb", "coordinates": [1, 1] }] }"#,
            Some(&Classes::new(["shrub", "tree"]).with_advice("name the library that has it")),
        )
        .expect_err("there is no such class"),
        World::from_json_with(
            "w.json",
            r#"{ "objects": [{ "class": "tree", "model": "oka", "coordinates": [1, 1] }] }"#,
            Some(&Classes::new(["tree"]).with_models(crate::models::Wood)),
        )
        .expect_err("there is no such model"),
        limited
            .variant("default")
            .expect_err("the default breaks the requirement"),
    ]
}

#[test]
fn every_code_in_the_source_has_a_case_with_a_message() {
    let mut errors = cases();
    errors.extend(look_ups());
    let messages: Vec<String> = errors
        .iter()
        .map(|error| format!("{}\n{error}\n", error.code()))
        .collect();
    insta::assert_snapshot!(messages.join("\n"));
    let covered: BTreeSet<String> = errors.iter().map(|error| error.code().to_owned()).collect();
    let missing: Vec<String> = codes_in_source().difference(&covered).cloned().collect();
    assert!(missing.is_empty(), "no case for {missing:?}");
}

/// Every quoted `"spec/…"` in the crate's source.
fn codes_in_source() -> BTreeSet<String> {
    let mut folders = vec![std::path::PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/src"))];
    let mut codes = BTreeSet::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("the source exists while its tests run") {
            let path = entry.expect("the source can be listed").path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("the source is UTF-8");
            codes.extend(
                text.split('"')
                    .filter(|word| word.starts_with("spec/"))
                    .map(str::to_owned),
            );
        }
    }
    assert!(codes.len() > 10, "the scan found the codes: {codes:?}");
    codes
}
