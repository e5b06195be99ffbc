//! Names of variants, groups, regimes and scenarios: a document is accepted if and only if the grammar allows its names.

use std::sync::Arc;

use driftworld_spec::{Scenario, SpecError, TaskSpec};
use driftworld_text::{check_name, is_unprintable};
use proptest::prelude::*;
use serde_json::json;

fn task(variant: &str, group: &str) -> Result<Arc<TaskSpec>, SpecError> {
    let group = json!({ "name": group, "count": 1, "object": { "class": "geometric" }, "placement": { "disc": { "center": [0, 0], "radius": 9 } } });
    let document = json!({ "version": 2, "name": "t", "groups": [group], "variants": { variant: {} } });
    TaskSpec::from_json("t.json", &document.to_string())
}

fn scenario(name: &str, regime: &str) -> Result<Scenario, SpecError> {
    let values = json!({ "light": 1 });
    let regime = json!({ "task": "t", "variant": "v", "values": values, "name": regime, "count": 1 });
    let document = json!({ "name": name, "blocks": [{ "type": "learning", "regimes": [regime] }] });
    Scenario::from_json("s.json", &document.to_string())
}

/// The errors for a name, for each kind of name.
fn refusals(name: &str) -> [Option<SpecError>; 4] {
    [
        task(name, "g").err(),
        task("v", name).err(),
        scenario(name, "r").err(),
        scenario("s", name).err(),
    ]
}

#[track_caller]
fn check(name: &str) {
    let is_valid = check_name(name).is_ok();
    for (place, refusal) in refusals(name).into_iter().enumerate() {
        assert_eq!(refusal.is_none(), is_valid, "{name:?} in place {place}: {refusal:?}");
        if let Some(refusal) = refusal {
            let message = refusal.to_string();
            assert!(!message.contains(is_unprintable), "{message:?}");
            let known = ["spec/name", "spec/value", "spec/length"];
            assert!(
                known.contains(&refusal.code()),
                "{name:?}: {} {message}",
                refusal.code()
            );
        }
    }
}

#[test]
fn names_that_leave_a_folder_or_deceive_a_terminal_are_refused_everywhere() {
    for name in [
        ".",
        "..",
        "a.",
        ".a",
        "-a",
        "+a",
        "a/b",
        "a\\b",
        "a:b",
        "con",
        "NUL.txt",
        "a\u{202e}b",
        "a\u{1b}[2J",
        "a\nb",
        "a\u{0}",
        "e\u{301}",
        "é",
        "größer",
        "look-red-0.5",
        "=1",
        "@a",
        "a b",
        "a\u{a0}b",
        "a\u{3164}",
        "→",
        "語",
    ] {
        check(name);
    }
    for long in [("a", 100), ("a", 101), ("語", 66), ("語", 67)] {
        check(&long.0.repeat(long.1));
    }
}

#[test]
fn message_states_place_name_and_fault() {
    let error_for = |variant: &str| task(variant, "g").expect_err("the name is invalid").to_string();
    assert_eq!(
        error_for("con"),
        "t.json:1:151 (/variants/con): found the name \"con\" with a word that Windows reserves for devices, expected a valid file \
         name on every system"
    );
    assert!(
        error_for("..").contains("(/variants/..): found the name \"..\", expected a name of letters, digits"),
        "{}",
        error_for("..")
    );
}

#[test]
fn device_name_is_refused_for_a_task_and_allowed_for_a_parameter() {
    let spec = |task: &str| {
        let parameters =
            json!({ "aux": { "role": "variant", "type": "number", "affects": ["O"], "range": [0, 1], "default": 0 } });
        let document = json!({ "version": 2, "name": task, "parameters": parameters, "variants": { "v": {} } });
        TaskSpec::from_json("t.json", &document.to_string())
    };
    assert!(spec("task").is_ok());
    assert_eq!(spec("con").expect_err("con is a device").code(), "spec/name");
}

#[test]
fn members_of_a_family_have_valid_names() {
    let choices = json!(["a b", "c/d", "x"]);
    let parameters = json!({ "word": { "role": "variant", "type": "string", "affects": ["S"], "choices": choices, "default": "x" } });
    let variants = json!({ "look": { "grid": { "word": choices } } });
    let document = json!({ "version": 2, "name": "t", "parameters": parameters, "variants": variants });
    let task = TaskSpec::from_json("t.json", &document.to_string()).expect("invalid characters are replaced in names");
    assert!(
        task.variant_names().iter().all(|name| check_name(name).is_ok()),
        "{:?}",
        task.variant_names()
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

    #[test]
    fn document_is_read_if_and_only_if_the_grammar_allows_its_names(
        name in prop_oneof!["[a-z._+-]{1,5}", "[ -~]{1,5}", "\\PC{1,4}", "(?s).{1,4}", "(con|nul|com1|lpt¹)(\\.[a-z]{0,2})?"]
    ) {
        check(&name);
    }
}
