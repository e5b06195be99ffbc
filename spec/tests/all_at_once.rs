//! Tests that mistakes of different kinds in different parts of a task are reported together, without problems that merely
//! follow from them.

use std::collections::BTreeSet;

use driftworld_spec::{Classes, TaskSpec};
use proptest::prelude::*;
use serde_json::{Value, json};

/// A mistake: a pointer, and the value to put there.
type Mistake = (&'static str, Value);

/// Mistakes that the schema finds and mistakes that only later checks find, each in a separate part.
fn mistakes() -> Vec<Mistake> {
    vec![
        ("/groups/0/colour", json!("red")),
        ("/groups/0/separation", json!("far")),
        ("/groups/1/count", json!(-1)),
        ("/groups/1/object/class", json!("bushh")),
        ("/parameters/light/default", json!(60)),
        ("/parameters/spread/type", json!("numbr")),
        ("/parameters/trigger/chioces", json!([])),
        ("/variants/green/target_color", json!("bleu")),
        ("/variants/dusk/extends", json!("rde")),
        ("/variants/penalty/target_reward", json!({ "a": 1 })),
        ("/world/max_steps", json!({ "param": "stepps" })),
        ("/world/rules/step_reward", json!("none")),
        ("/world/agent_params/agent_width", json!({ "param": "agent_widht" })),
        ("/world/agent_params/colour", json!(1)),
        ("/require", json!(["hold +"])),
        ("/element_weights", json!({ "S": "much" })),
    ]
}

fn valid_task() -> Value {
    let path = format!("{}/../examples/tasks/find_objects.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("the example tasks ship with the project");
    serde_json::from_str(&text).expect("the task is JSON")
}

/// The problems of a task with these mistakes, without line and column.
fn problems_with(chosen: &[&Mistake]) -> BTreeSet<String> {
    let mut task = valid_task();
    for (pointer, value) in chosen {
        let (parent, key) = pointer.rsplit_once('/').expect("the pointer has a parent");
        let parent = task
            .pointer_mut(parent)
            .unwrap_or_else(|| panic!("{pointer}: nothing there"));
        parent
            .as_object_mut()
            .expect("the parent is an object")
            .insert(key.to_owned(), value.clone());
    }
    let classes = Classes::new(["geometric", "tree", "rock"]);
    let error = TaskSpec::from_json_with("t.json", &task.to_string(), Some(&classes)).err();
    let problems = error.as_ref().map_or(&[][..], |error| error.problems());
    problems
        .iter()
        .map(|problem| format!("{} {}", problem.pointer, problem.found))
        .collect()
}

#[test]
fn single_mistake_is_reported_at_its_place() {
    assert!(problems_with(&[]).is_empty(), "{:?}", problems_with(&[]));
    for mistake in &mistakes() {
        let found = problems_with(&[mistake]);
        let near = |problem: &String| {
            problem.starts_with(mistake.0) || mistake.0.starts_with(problem.split(' ').next().unwrap_or("-"))
        };
        assert!(!found.is_empty() && found.iter().all(near), "{}: {found:?}", mistake.0);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 150)))]

    #[test]
    fn combined_mistakes_report_each_problem(chosen in prop::sample::subsequence((0..mistakes().len()).collect::<Vec<_>>(), 1..7)) {
        let all = mistakes();
        // A group that the schema rejects is not checked any further.
        let hidden = |mistake: &Mistake| mistake.0 == "/groups/1/object/class" && chosen.iter().any(|other| all[*other].0 == "/groups/1/count");
        let chosen: Vec<&Mistake> = chosen.iter().map(|number| &all[*number]).filter(|mistake| !hidden(mistake)).collect();
        let alone: BTreeSet<String> = chosen.iter().flat_map(|mistake| problems_with(&[mistake])).collect();
        prop_assert_eq!(problems_with(&chosen), alone);
    }
}

#[test]
fn both_mistakes_in_the_docs_are_reported_together() {
    let variant = ("/variants/dusk/light", json!(60));
    let reference = ("/world/environment_params/light_intensity", json!({ "param": "ligth" }));
    let found: Vec<String> = problems_with(&[&variant, &reference]).into_iter().collect();
    assert_eq!(found.len(), 2, "{found:?}");
    assert!(found[0].starts_with("/variants/dusk/light 60"), "{found:?}");
    assert!(
        found[1].starts_with("/world/environment_params/light_intensity"),
        "{found:?}"
    );
}

/// When checking stops before the end of a list, there may be more problems than were counted; the message says so.
#[test]
fn incomplete_count_of_problems_is_reported_as_a_minimum() {
    let summary_of = |num: usize| {
        let objects = vec![json!({ "class": "cube", "coordinates": [0, "x"], "heading": "h", "reward": "r" }); num];
        let text = json!({ "objects": objects }).to_string();
        let error = driftworld_spec::World::from_json("w", &text).unwrap_err();
        (
            error.has_more(),
            error.to_string().lines().last().unwrap_or_default().to_owned(),
        )
    };
    let (more, last) = summary_of(20);
    assert!(
        !more && last.starts_with("w: and ") && !last.contains("at least"),
        "{last}"
    );
    for num in [101, 110, 400] {
        let (more, last) = summary_of(num);
        assert!(more && last.starts_with("w: and at least "), "{num}: {last}");
    }
}
