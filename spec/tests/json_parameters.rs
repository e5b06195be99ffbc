//! Parameters of type JSON: when the task is read, their values are checked against the schema of each place of use.

use driftworld_spec::{ParameterType, TaskSpec, Value};

/// The message for a task with this parameter, used in this world.
fn message_for(parameter: &str, world: &str, variants: &str) -> String {
    let text = format!(
        r#"{{ "name": "t", "parameters": {{ "p": {parameter} }}, "world": {world}, "variants": {{ "v": {variants} }} }}"#
    );
    TaskSpec::from_json("t.json", &text).map_or_else(|error| error.to_string(), |_| String::new())
}

#[test]
fn values_are_checked_at_their_places_of_use_and_reported_where_written() {
    let sees = |choices: &str| {
        format!(
            r#"{{ "role": "variant", "type": "json", "affects": ["O"], "choices": [{choices}], "default": ["rgb"] }}"#
        )
    };
    let modalities = r#"{ "agent_params": { "modalities": { "param": "p" } } }"#;
    let fog = r#"{ "environment_params": { "fog_distance": { "param": "p" } } }"#;
    let drawn = r#"{ "role": "randomized", "type": "json", "affects": ["O"],
        "distribution": { "choice": { "values": [["rgb"], ["depht"]] } } }"#;
    let number = r#"{ "role": "fixed", "type": "number", "value": 3 }"#;
    let absent = r#"{ "role": "fixed", "type": "json", "value": null }"#;
    let cases = [
        (sees(r#"["rgb"], ["rgb", "detph"]"#), modalities, "{}"),
        (sees(r#"["rgb"], "rgb""#), modalities, "{}"),
        (
            sees(r#"["rgb"], ["rgb", "depth"]"#),
            modalities,
            r#"{ "p": ["depth", "rgb"] }"#,
        ),
        (sees(r#"["rgb"], ["rgb", "depth"]"#), fog, "{}"),
        (drawn.to_owned(), modalities, "{}"),
        (number.to_owned(), modalities, "{}"),
        (
            absent.to_owned(),
            r#"{ "environment_params": { "light_intensity": { "param": "p" } } }"#,
            "{}",
        ),
        (
            number.to_owned(),
            r#"{ "environment_params": { "fog_distance": { "choice": { "values": [null, -3] } } } }"#,
            "{}",
        ),
        (
            number.to_owned(),
            r#"{ "rules": { "success": [{ "choice": { "values": ["all_colected", { "touch": "a" }] } }] } }"#,
            "{}",
        ),
        (absent.to_owned(), r#"{ "environment_params": { "param": "p" } }"#, "{}"),
        (absent.to_owned(), r#"{ "seed": { "param": "p" } }"#, "{}"),
        (
            r#"{ "role": "variant", "type": "distribution", "affects": ["S"],
                 "choices": [{ "poisson": { "mean": 3 } }], "default": { "poisson": { "mean": 3 } } }"#
                .to_owned(),
            "{}",
            r#"{ "p": { "poison": { "mean": 3 } } }"#,
        ),
        (
            r#"{ "role": "variant", "type": "number", "affects": ["O"], "range": [1, 4], "default": 2 }"#.to_owned(),
            "{}",
            r#"{ "p": null }"#,
        ),
        (
            r#"{ "role": "randomized", "type": "string", "affects": ["S"],
                 "distribution": { "choice": { "values": ["tree", { "class": "rock" }] } } }"#
                .to_owned(),
            "{}",
            "{}",
        ),
    ];
    let report: Vec<String> = cases
        .iter()
        .map(|(parameter, world, variant)| {
            let message = message_for(parameter, world, variant);
            assert!(!message.is_empty(), "{parameter} {world} {variant}");
            format!("{parameter} {world} {variant}\n{message}\n")
        })
        .collect();
    insta::assert_snapshot!(report.join("\n"));
}

#[test]
fn choice_named_default_is_checked_where_it_is_used() {
    let parameter = r#"{ "role": "variant", "type": "json", "affects": ["O"],
        "choices": { "a": ["depht"], "default": ["depht"] }, "default": "a" }"#;
    let message = message_for(
        parameter,
        r#"{ "agent_params": { "modalities": { "param": "p" } } }"#,
        "{}",
    );
    assert!(message.contains("/choices/a/0"), "{message}");
    assert!(message.contains("/choices/default/0"), "{message}");
}

#[test]
fn value_outside_the_choices_is_refused_when_set_in_code() {
    let text = r#"{ "name": "t", "parameters": { "p": {
        "role": "variant", "type": "json", "affects": ["O"], "choices": [["rgb"], null], "default": ["rgb"] } } }"#;
    let task = TaskSpec::from_json("t", text).unwrap();
    let variant = task.variant("default").unwrap();
    let with = |json: &str| variant.with("x", [("p".to_owned(), serde_json::from_str::<Value>(json).unwrap())]);
    assert!(
        with("null")
            .unwrap()
            .value("p")
            .is_some_and(|value| value.to_json().is_null())
    );
    let message = with(r#"["depth"]"#).unwrap_err().to_string();
    assert!(
        message.contains(r#"found ["depth"], expected one of ["rgb"], null"#),
        "{message}"
    );
}

#[test]
fn variants_of_families_are_named_after_their_values() {
    let text = r#"{ "name": "t", "parameters": { "p": { "role": "variant", "type": "json", "affects": ["O"], "default": null,
        "choices": [null, 20, ["rgb", "depth"], { "scale": 2.0 }, [[1, 2]]] } },
        "variants": { "v": { "grid": { "p": [null, 20, ["rgb", "depth"], { "scale": 2 }, [[1, 2]]] } } } }"#;
    let task = TaskSpec::from_json("t", text).unwrap();
    assert_eq!(
        task.variant_names(),
        ["v-none", "v-20", "v-rgb_depth", "v-scale3", "v-list4"]
    );
    let scale = task.variant("v-scale3").unwrap();
    assert_eq!(scale.value("p").unwrap().to_string(), r#"{"scale":2}"#);
    let reread = TaskSpec::from_json("again", &task.to_json()).unwrap();
    assert_eq!(reread.variant("v-scale3").unwrap().hash(), scale.hash());
    assert_eq!(task.parameters()["p"].kind, ParameterType::Json);
}
