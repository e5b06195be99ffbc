//! Errors of look-ups in tasks, and their pointers. The resulting worlds are tested in the generator.

use driftworld_spec::{TaskSpec, Value};

const PARAMETERS: &str = r#"
    "cue": { "role": "randomized", "type": "string", "affects": ["S"], "distribution": { "choice": { "values": ["red", "blue"] } } },
    "far": { "role": "variant", "type": "boolean", "affects": ["S"], "choices": [true, false], "default": false },
    "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0, 4], "default": 2 },
    "lamps": { "role": "variant", "type": "integer", "affects": ["O"], "range": [0, 2], "default": 1 },
    "tint": { "role": "variant", "type": "color", "affects": ["O"], "choices": ["red", [0, 0, 1]], "default": "red" },
    "size": { "role": "randomized", "type": "number", "affects": ["S"], "distribution": { "uniform": { "low": 1, "high": 2 } } },
    "map": { "role": "variant", "type": "layout", "affects": ["S"], "choices": [{ "walls": [] }], "default": { "walls": [] } }"#;

/// A task with this light and additional parameters.
fn task(light: &str, more: &str) -> String {
    format!(
        r#"{{ "name": "t", "parameters": {{ {PARAMETERS}{more} }},
             "world": {{ "environment_params": {{ "light_intensity": {light} }} }},
             "variants": {{ "near": {{}}, "away": {{ "far": true, "light": 1 }} }} }}"#
    )
}

fn message_for(text: &str) -> String {
    TaskSpec::from_json("t.json", text).map_or_else(|error| error.to_string(), |_| "accepted".to_owned())
}

#[test]
fn invalid_look_up_is_reported_at_its_place() {
    let lights = [
        r#"{ "case": { "param": "cue" }, "of": { "red": 1 } }"#,
        r#"{ "case": { "param": "cue" }, "of": { "red": 1, "bleu": 2 } }"#,
        r#"{ "case": { "param": "queue" }, "of": { "red": 1 }, "else": 2 }"#,
        r#"{ "case": { "param": "cue", "index": 0 }, "of": { "red": 1 }, "else": 2 }"#,
        r#"{ "case": { "param": "far" }, "of": { "yes": 1 }, "else": 2 }"#,
        r#"{ "case": { "param": "light" }, "of": { "1": 1 } }"#,
        r#"{ "case": { "param": "lamps" }, "of": { "0": 1, "1": 2 } }"#,
        r#"{ "case": { "param": "tint" }, "of": { "red": 1, "green": 2 } }"#,
        r#"{ "case": { "param": "map" }, "of": { "open": 1 }, "else": 2 }"#,
        r#"{ "case": { "param": "size" }, "of": { "1": 1 }, "else": 2 }"#,
        r#"{ "case": { "param": "cue" }, "of": { "red": "bright", "blue": 2 } }"#,
        r#"{ "case": { "param": "cue" }, "of": { "red": -1, "blue": 2 } }"#,
        r#"{ "case": { "param": "cue" }, "of": { "red": { "param": "tint" }, "blue": { "uniform": { "low": 2, "high": 1 } } } }"#,
        r#"{ "case": { "param": "cue" }, "of": { "red": { "case": { "param": "far" }, "of": { "true": 1 } } }, "else": 2 }"#,
        r#"{ "uniform": { "low": 0, "high": { "case": { "param": "cue" }, "of": { "red": 1 }, "else": -1 } } }"#,
        r#"{ "uniform": { "low": 0, "high": { "case": { "param": "cue" }, "of": { "red": { "param": "size" } }, "else": 1 } } }"#,
        r#"{ "case": { "param": "cue" } }"#,
        r#"{ "case": "cue", "of": { "red": 1 } }"#,
        r#"{ "case": { "param": "cue" }, "of": { "red": 1 }, "otherwise": 2 }"#,
    ];
    let parameters = [
        r#""a": { "role": "randomized", "type": "number", "affects": ["S"], "distribution": { "case": { "param": "b" }, "of": { "1": 2 }, "else": 3 } },
           "b": { "role": "randomized", "type": "number", "affects": ["S"], "distribution": { "case": { "param": "c" }, "of": { "1": 2 }, "else": 3 } },
           "c": { "role": "randomized", "type": "number", "affects": ["S"], "distribution": { "uniform": { "low": 0, "high":
                    { "case": { "param": "a" }, "of": { "1": 2 }, "else": 3 } } } }"#,
        r#""a": { "role": "randomized", "type": "number", "affects": ["S"], "distribution": { "case": { "param": "cue" }, "of": { "red": { "param": "size" } }, "else": 3 } }"#,
        r#""a": { "role": "randomized", "type": "number", "affects": ["S"], "distribution": { "case": { "param": "cue" }, "of": { "red": "high" }, "else": 3 } }"#,
        r#""a": { "role": "fixed", "type": "distribution", "value": { "uniform": { "low": 0, "high": { "case": { "param": "cue" }, "of": { "red": 1 }, "else": 3 } } } }"#,
    ];
    let lights = lights.iter().map(|light| (*light, message_for(&task(light, ""))));
    let parameters = parameters
        .iter()
        .map(|more| (*more, message_for(&task("1", &format!(", {more}")))));
    let report: Vec<String> = lights
        .chain(parameters)
        .map(|(text, error)| format!("{text}\n{error}\n"))
        .collect();
    insta::assert_snapshot!(report.join("\n"));
}

#[test]
fn value_without_a_case_is_refused_in_a_variant_that_has_it() {
    let text = task(r#"{ "case": { "param": "tint" }, "of": { "red": 1, "blue": 2 } }"#, "");
    let task = TaskSpec::from_json("t.json", &text).unwrap_or_else(|error| panic!("{error}"));
    let near = task.variant("near").expect("the task declares it");
    let between = |color: &str| near.with("between", [("tint".to_owned(), Value::Text(color.to_owned()))]);
    assert!(between("blue").is_ok());
    let error = between("purple").expect_err("purple has no case").to_string();
    assert!(
        error.contains("tint = purple") && error.contains("red, blue"),
        "{error}"
    );
}

#[test]
fn margin_without_a_case_is_refused_in_a_variant_that_needs_it() {
    let distance = r#"{ "case": { "param": "tint" }, "of": { "red": 1, "blue": 2 } }"#;
    let group = |margins: &str| {
        let cubes =
            r#""count": 1, "object": { "class": "cube" }, "placement": { "disc": { "center": [0, 0], "radius": 9 } }"#;
        format!(
            r#""name": "t", "parameters": {{ {PARAMETERS} }},
               "groups": [{{ "name": "a", {cubes} }}, {{ "name": "b", {cubes}, {margins} }}]"#
        )
    };
    for margins in [
        format!(r#""separation": {distance}"#),
        format!(r#""keep_out": {{ "groups": {{ "a": {distance} }} }}"#),
        format!(r#""facing": {{ "point": [0, {distance}] }}"#),
    ] {
        let task = TaskSpec::from_json("t.json", &format!("{{ {} }}", group(&margins)));
        let task = task.unwrap_or_else(|error| panic!("{error}"));
        let variant = task.variant("default").expect("the default variant always exists");
        let error = variant.with("between", [("tint".to_owned(), Value::Text("purple".into()))]);
        assert!(
            error
                .expect_err("purple has no case")
                .to_string()
                .contains("tint = purple")
        );
    }
}
