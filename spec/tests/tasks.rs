//! Tests that the shipped task specs load, and that broken ones are rejected with the expected messages.

use driftworld_spec::{Color, TaskSpec, Value};

fn read(name: &str) -> String {
    std::fs::read_to_string(format!("{}/../examples/tasks/{name}.json", env!("CARGO_MANIFEST_DIR")))
        .expect("the example tasks ship with the project")
}

#[test]
fn every_example_task_loads_with_its_variants() {
    for name in ["find_objects", "get_to_goal"] {
        let task = TaskSpec::from_json(name, &read(name)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(task.name(), name);
        assert!(task.all_variants().len() >= 4);
    }
}

#[test]
fn variant_overrides_those_it_extends_and_the_defaults() {
    let task = TaskSpec::from_json("find_objects.json", &read("find_objects")).unwrap();
    let dusk = task.variant("dusk").unwrap();
    assert_eq!(dusk.id(), "find_objects#dusk");
    assert_eq!(dusk.value("target_color"), Some(&Value::Color(Color([1.0, 0.0, 0.0]))));
    assert_eq!(dusk.value("light"), Some(&Value::Number(0.6)));
    assert_eq!(dusk.value("spread"), Some(&Value::Number(20.0)));
    assert_eq!(dusk.value("start_heading"), None);
}

/// The message for `find_objects` with one string replaced by another.
fn broken(from: &str, to: &str) -> String {
    let text = read("find_objects");
    assert!(text.contains(from), "{from}");
    match TaskSpec::from_json("task.json", &text.replacen(from, to, 1)) {
        Ok(_) => panic!("accepted with {to}"),
        Err(error) => error.to_string(),
    }
}

#[test]
fn broken_tasks_are_refused_and_the_message_says_how_to_fix_them() {
    let cases = [
        ("\"param\": \"light\"", "\"param\": \"ligth\""),
        ("\"param\": \"light\"", "\"param\": \"target_color\""),
        (
            "\"light_intensity\": { \"perturb\": { \"value\": { \"param\": \"light\" }, \"noise\": { \"param\": \"light_noise\" }, \"low\": 0.2, \"high\": 4 } }",
            "\"light_intensity\": { \"uniform\": { \"low\": -1, \"high\": 2 } }",
        ),
        ("\"param\": \"spread\"", "\"param\": \"start_heading\""),
        ("\"range\": [0.2, 4]", "\"range\": [4, 0.2]"),
        (
            "\"range\": [0.2, 4], \"default\": 2.3",
            "\"range\": [0.2, 4], \"default\": 23",
        ),
        (
            "\"range\": [1, 10], \"default\": 1",
            "\"range\": [1, 1e9], \"default\": 1",
        ),
        ("\"low\": 0, \"high\": 360", "\"low\": 360, \"high\": 0"),
        (
            "\"uniform\": { \"low\": 0, \"high\": 360 }",
            "\"unifrom\": { \"low\": 0, \"high\": 360 }",
        ),
        ("\"extends\": \"red\"", "\"extends\": \"rde\""),
        ("\"light\": 0.6", "\"lihgt\": 0.6"),
        ("\"light\": 0.6", "\"light\": 60"),
        (
            "\"light\": 0.6",
            "\"light\": { \"uniform\": { \"low\": 0.2, \"high\": 0.4 } }",
        ),
        ("\"light\": 0.6", "\"target_count\": 6"),
        ("\"target_color\": \"green\"", "\"target_color\": \"gren\""),
        ("\"description\": \"The same with red cubes.\"", "\"extends\": \"dusk\""),
        ("\"value\": 5", "\"value\": \"five\""),
        ("\"value\": 5", "\"value\": 1000000000"),
        ("\"value\": 5, ", ""),
        ("\"count\": 4", "\"count\": 1000000000"),
        ("\"class\": \"rock\"", "\"clas\": \"rock\""),
        ("\"max_seconds\": 30", "\"max_second\": 30"),
        ("\"max_seconds\": 30", "\"max_steps\": { \"param\": \"light\" }"),
        ("\"role\": \"fixed\"", "\"role\": \"constant\""),
        ("\"gaussian\"", "\"gausian\""),
        (
            "\"success\": [\"all_collected\"]",
            "\"success\": [{ \"param\": \"light\" }]",
        ),
        ("\"name\": \"rocks\"", "\"name\": \"trees\""),
        ("\"separation\": 2", "\"separation\": -2"),
        (
            "\"values\": [\"1\", \"4\", \"7\"]",
            "\"values\": [\"1\", \"4\", \"7\"], \"weights\": [1, 2]",
        ),
        ("\"affects\": [\"O\"], ", ""),
    ];
    let report: Vec<String> = cases
        .iter()
        .map(|(from, to)| format!("{from}  →  {to}\n{}\n", broken(from, to)))
        .collect();
    insta::assert_snapshot!(report.join("\n"));
}

#[test]
fn task_spec_of_version_1_is_read_with_its_margins() {
    let text = r#"{ VERSION "name": "old", "groups": [{ "name": "trees", "count": 3, "object": { "class": "tree" },
        "placement": { "disc": { "center": [0, 0], "radius": 20 } }, "wall_margin": 3, "agent_margin": 5 }] }"#;
    for version in ["", "\"version\": 1,"] {
        let task = TaskSpec::from_json("old.json", &text.replace("VERSION", version)).unwrap();
        let keep_out = &task.groups()[0].spec.keep_out;
        assert_eq!(
            (keep_out.walls.clone(), keep_out.agent.clone()),
            (3.0.into(), 5.0.into())
        );
    }
    let error = TaskSpec::from_json("old.json", &text.replace("VERSION", "\"version\": 2,")).unwrap_err();
    assert_eq!(
        error.code(),
        "spec/unknown-key",
        "in a document of version 2 they are unknown"
    );
}

/// The error message of a task, or `None` if the task is valid.
#[track_caller]
fn error_for(text: &str) -> Option<String> {
    TaskSpec::from_json("t.json", text).err().map(|error| error.to_string())
}

#[test]
fn counts_in_any_notation_are_read_or_refused_without_panic() {
    let with = |count: &str| {
        error_for(&format!(
            r#"{{ "version": 2, "name": "t", "parameters": {{ "v": {{ "role": "fixed", "type": "vector", "value": [1, 2] }} }},
                "groups": [{{ "name": "g", "count": {count}, "object": {{ "class": "cube" }},
                "placement": {{ "disc": {{ "center": [0, 0], "radius": 20 }} }} }}] }}"#
        ))
    };
    assert_eq!(with("3.0"), None);
    assert_eq!(with("1e2"), None);
    assert_eq!(with("-0"), None);
    assert!(with("1.5").is_some() && with("1e9").is_some() && with("-1").is_some());
    assert!(with(r#"{ "param": "v", "index": 1.0 }"#).is_some());
}

#[test]
fn single_place_needs_a_distribution_that_ignores_earlier_objects() {
    let start = |law: &str| {
        error_for(&format!(
            r#"{{ "version": 2, "name": "t", "world": {{ "agent_params": {{ "coordinates": {law} }} }} }}"#
        ))
    };
    assert!(
        start(r#"{ "points": { "values": [[1, 1], [2, 2]] } }"#)
            .is_some_and(|error| error.contains("\"order\": \"random\""))
    );
    assert_eq!(
        start(r#"{ "points": { "values": [[1, 1], [2, 2]], "order": "random" } }"#),
        None
    );
    assert!(start(r#"{ "annulus": { "center": [0, 0], "inner": 1e199, "outer": 1e200 } }"#).is_some());
}

#[test]
fn index_is_checked_against_the_shortest_possible_vector() {
    let text = r#"{ "version": 2, "name": "t", "parameters": {
        "d": { "role": "variant", "type": "distribution", "affects": ["R"],
               "choices": [{ "dirichlet": { "alpha": [1, 1, 1] } }, { "dirichlet": { "alpha": [1, 1] } }],
               "default": { "dirichlet": { "alpha": [1, 1, 1] } } },
        "v": { "role": "randomized", "type": "vector", "affects": ["R"], "distribution": { "param": "d" } } },
      "world": { "rules": { "step_reward": { "param": "v", "index": INDEX } } } }"#;
    assert_eq!(error_for(&text.replace("INDEX", "1")), None);
    assert!(error_for(&text.replace("INDEX", "2")).is_some_and(|error| error.contains("which has 2 numbers")));
}

#[test]
fn requirement_without_parameters_that_never_holds_is_refused() {
    for variants in ["{}", r#"{ "v": {} }"#] {
        let text = format!(r#"{{ "version": 2, "name": "t", "require": ["1 > 2"], "variants": {variants} }}"#);
        let error = TaskSpec::from_json("t.json", &text).unwrap_err();
        assert_eq!(
            error.to_string(),
            "t.json:1:42 (/require/0): found \"1 > 2\", which names no parameter and never holds, expected a condition that some values of \
             the parameters meet"
        );
    }
}

#[test]
fn arc_across_north_ends_above_360() {
    let task = |range: &str| {
        let parameter = format!(
            r#"{{ "role": "variant", "type": "heading", "affects": ["S"], "range": {range}, "default": 350 }}"#
        );
        let world = r#"{ "agent_params": { "heading": { "param": "faces" } } }"#;
        let text = format!(r#"{{ "name": "t", "parameters": {{ "faces": {parameter} }}, "world": {world} }}"#);
        TaskSpec::from_json("t", &text)
    };
    task("[300, 420]").expect("the low end is below the high end");
    let error = task("[300, 60]")
        .expect_err("the low end is above the high end")
        .to_string();
    assert!(error.ends_with("; an arc across north is [300, 420]"), "{error}");
}
