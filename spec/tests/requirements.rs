//! Comparisons that `require` allows, and the messages for all others. The grammar is tested in `task/expression/mod.rs`.

use driftworld_spec::{TaskSpec, Value};
use proptest::prelude::*;

fn task(require: &str) -> Result<std::sync::Arc<TaskSpec>, String> {
    let text = format!(
        r#"{{ "name": "t", "require": [{require:?}], "parameters": {{
            "count": {{ "role": "variant", "type": "integer", "affects": ["S"], "range": [0, 9], "default": 3 }},
            "drawn": {{ "role": "randomized", "type": "number", "affects": ["S"], "distribution": {{ "uniform": {{ "low": 0, "high": 1 }} }} }},
            "day": {{ "role": "variant", "type": "boolean", "affects": ["O"], "choices": [true, false], "default": true }},
            "trigger": {{ "role": "variant", "type": "string", "affects": ["T"], "choices": ["touch", "near", "red"], "default": "touch" }},
            "other_trigger": {{ "role": "variant", "type": "string", "affects": ["T"], "choices": ["touch", "far"], "default": "far" }},
            "mode": {{ "role": "fixed", "type": "string", "value": "hard" }},
            "good": {{ "role": "variant", "type": "color", "affects": ["O"], "choices": ["red", "green"], "default": "green" }},
            "bad": {{ "role": "variant", "type": "color", "affects": ["O"], "choices": ["red", "blue"], "default": "red" }},
            "name_of_color": {{ "role": "variant", "type": "string", "affects": ["O"], "choices": ["red", "blue"], "default": "red" }},
            "start": {{ "role": "fixed", "type": "point", "value": [1, 2] }},
            "pays": {{ "role": "variant", "type": "vector", "affects": ["R"], "range": [-9, 9], "default": [1, 2, 3] }},
            "law": {{ "role": "variant", "type": "distribution", "affects": ["S"], "choices": [{{ "constant": {{ "value": 1 }} }}], "default": {{ "constant": {{ "value": 1 }} }} }}
        }} }}"#
    );
    TaskSpec::from_json("t.json", &text).map_err(|error| error.to_string())
}

#[test]
fn values_of_the_same_type_are_compared() {
    for require in [
        "trigger != other_trigger",
        "trigger == 'touch' or other_trigger == 'far'",
        "'near' != trigger",
        "mode == 'hard'",
        "mode != trigger",
        "good != bad and good != 'blue'",
        "good != name_of_color",
        "distance(good, name_of_color) >= 0",
        "good[1] > bad[1]",
        "day == (count > 2)",
        "not day or drawn < count",
        "pays[2] > start[0]",
    ] {
        task(require).unwrap_or_else(|error| panic!("{require}: {error}"));
    }
}

#[test]
fn incomparable_values_are_refused_with_found_and_expected() {
    let messages = [
        "trigger == count",
        "trigger == 'tuoch'",
        "trigger < other_trigger",
        "trigger == good",
        "good < bad",
        "good == 'rde'",
        "good == 3",
        "distance(good, 3) < 1",
        "distance(trigger, 'red') < 1",
        "day == 1",
        "day < 1",
        "day and count",
        "not count",
        "-day < 0",
        "min(count, trigger) > 1",
        "abs(good) > 1",
        "start == 3",
        "start[2] > 3",
        "count[0] > 3",
        "pays[3] > 0",
        "count + 1",
        "trigger",
        "law == 1",
        "1 > 2",
    ]
    .map(|require| {
        let error = task(require).expect_err(require);
        error
            .replace('\n', " ")
            .split_whitespace()
            .collect::<Vec<_>>()
            .join(" ")
    });
    insta::assert_snapshot!(messages.join("\n"));
}

/// Conditions made of random parts, which may be invalid.
fn condition() -> impl Strategy<Value = String> {
    let parts =
        "count drawn day trigger other_trigger mode good bad name_of_color pays[0] start[1] 2 'red' 'touch' true";
    let part = prop::sample::select(parts.split(' ').collect::<Vec<_>>());
    let leaf = part.prop_map(str::to_owned);
    leaf.prop_recursive(3, 12, 2, |inner| {
        let symbol = prop::sample::select(vec!["==", "!=", "<", ">=", "and", "or", "+", "*"]);
        prop_oneof![
            (inner.clone(), symbol, inner.clone()).prop_map(|(a, symbol, b)| format!("({a} {symbol} {b})")),
            inner.clone().prop_map(|a| format!("not {a}")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("distance({a}, {b})")),
            (inner.clone(), inner).prop_map(|(a, b)| format!("min({a}, {b})")),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

    /// Conditions that load are true or false for all values.
    #[test]
    fn accepted_condition_is_always_defined(require in condition(), count in 0_i64..10, drawn in 0.0..1.0, pick in any::<[bool; 6]>()) {
        let Ok(task) = task(&require) else { return Ok(()) };
        let text = |which: bool, one: &str, other: &str| Value::Text(if which { one } else { other }.to_owned());
        let color = |which: bool, one: &str, other: &str| {
            Value::Color(driftworld_spec::Color::from_name(if which { one } else { other }).expect("a CSS name"))
        };
        let value_of = |name: &str| Some(match name {
            "count" => Value::Integer(count),
            "drawn" => Value::Number(drawn),
            "day" => Value::Boolean(pick[0]),
            "trigger" => text(pick[1], "near", "red"),
            "other_trigger" => text(pick[2], "touch", "far"),
            "mode" => Value::Text("hard".to_owned()),
            "good" => color(pick[3], "red", "green"),
            "bad" => color(pick[4], "red", "blue"),
            "name_of_color" => text(pick[5], "red", "blue"),
            "pays" => Value::Vector(vec![1.0, 2.0, 3.0]),
            "start" => Value::Point([1.0, 2.0]),
            _ => return None,
        });
        prop_assert!(task.requirements()[0].holds(value_of).is_some(), "{require}");
    }
}
