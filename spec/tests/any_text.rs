//! Tests that reading any text gives a document or an error with a line and column, but never panics.

use driftworld_spec::{Scenario, SpecError, TaskSpec, World};
use proptest::prelude::*;
use serde_json::Value;

fn example(name: &str) -> String {
    let path = format!("{}/../examples/tasks/{name}.json", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("the example tasks ship with the project")
}

/// Reads a text as every kind of document; every problem must have a line and column in the text.
fn read_all(text: &str) {
    let lines = text.lines().count().max(1) + 1;
    let errors = [
        TaskSpec::from_json("d", text).err(),
        World::from_json("d", text).err(),
        World::from_l2explorer("d", text).err(),
        Scenario::from_json("d", text).err(),
    ];
    for error in errors.into_iter().flatten() {
        assert!(!error.to_string().is_empty());
        let places: Vec<(usize, usize)> = match &error {
            SpecError::Syntax { line, column, .. } => vec![(*line, *column)],
            other => other
                .problems()
                .iter()
                .map(|problem| (problem.line, problem.column))
                .collect(),
        };
        for (line, column) in places {
            assert!((1..=lines).contains(&line) && column >= 1, "{line}:{column} in {text}");
        }
    }
}

/// Values of the wrong kind.
fn wrong_value() -> impl Strategy<Value = Value> {
    prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        (-1e300..1e300).prop_map(Value::from),
        ".{0,12}".prop_map(Value::from),
        Just(serde_json::json!([])),
        Just(serde_json::json!({})),
        Just(serde_json::json!({ "param": "light" })),
        Just(serde_json::json!({ "param": "nobody" })),
        Just(serde_json::json!({ "uniform": { "low": 1, "high": { "param": "spread" } } })),
        Just(serde_json::json!({ "points": { "values": [[0, 0]] } })),
        Just(serde_json::json!([[[[1]]]])),
    ]
}

/// Replaces the nth value of a document, counted depth first.
fn replace_nth(json: &mut Value, n: &mut usize, with: &Value) {
    if *n == 0 {
        *json = with.clone();
    }
    *n = n.wrapping_sub(1);
    match json {
        Value::Array(list) => list.iter_mut().for_each(|child| replace_nth(child, n, with)),
        Value::Object(map) => map.values_mut().for_each(|child| replace_nth(child, n, with)),
        _ => {}
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 192)))]

    #[test]
    fn any_text_is_read_or_refused(text in "\\PC{0,200}") {
        read_all(&text);
    }

    #[test]
    fn truncated_task_is_read_or_refused(end in 0usize..4000) {
        let text = example("find_objects");
        read_all(&text[..text.floor_char_boundary(end.min(text.len()))]);
    }

    #[test]
    fn task_with_any_value_replaced_is_read_or_refused(index in 0usize..260, with in wrong_value()) {
        let mut json: Value = serde_json::from_str(&example("find_objects")).expect("the example is JSON");
        replace_nth(&mut json, &mut index.clone(), &with);
        read_all(&serde_json::to_string_pretty(&json).expect("JSON serialises"));
    }

    #[test]
    fn task_with_swapped_bytes_is_read_or_refused(at in 0usize..3500, with in "[{}\\[\\],:\"0-9a-z ]{1,3}") {
        let mut text = example("get_to_goal");
        let at = text.floor_char_boundary(at.min(text.len() - 1));
        let end = text.ceil_char_boundary((at + with.len()).min(text.len()));
        text.replace_range(at..end, &with);
        read_all(&text);
    }
}

#[test]
fn huge_and_deeply_nested_documents_are_refused_quickly() {
    read_all(&"[".repeat(1_000_000));
    read_all(&"{\"a\":".repeat(100_000));
    let text = example("find_objects").replace("\"value\": 5", "\"value\": 1000000000");
    assert!(TaskSpec::from_json("d", &text).is_err());
}
