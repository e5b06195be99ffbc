//! Tests that messages about single mistakes in the shipped tasks nearly always point to the mistake.

use driftworld_spec::TaskSpec;
use serde_json::{Value, json};

/// A mistake in a key.
#[derive(Clone, Copy, Debug)]
enum Mistake {
    Misspelt,
    Missing,
    Mistyped,
}

/// Whether an object's keys are names chosen by the author, so that renaming one is not a mistake in that object.
fn has_chosen_keys(parent: &str) -> bool {
    let words: Vec<&str> = parent.split('/').skip(1).collect();
    matches!(
        words.as_slice(),
        ["parameters" | "variants"] | ["groups", _, "keep_out", "groups"] | [.., "legend"]
    )
}

/// Every key of a document, with the pointer to its parent.
fn keys(json: &Value, pointer: &str, found: &mut Vec<(String, String)>) {
    match json {
        Value::Object(map) => {
            for (key, child) in map {
                if !has_chosen_keys(pointer) {
                    found.push((pointer.to_owned(), key.clone()));
                }
                keys(child, &format!("{pointer}/{}", escaped(key)), found);
            }
        }
        Value::Array(items) => {
            let children = items.iter().enumerate();
            children.for_each(|(index, child)| keys(child, &format!("{pointer}/{index}"), found));
        }
        _ => {}
    }
}

fn escaped(key: &str) -> String {
    key.replace('~', "~0").replace('/', "~1")
}

/// The document with a mistake, and the pointer to the mistake.
fn with_mistake(document: &Value, parent: &str, key: &str, mistake: Mistake) -> (Value, String) {
    let mut document = document.clone();
    let map = document
        .pointer_mut(parent)
        .and_then(Value::as_object_mut)
        .expect("the key exists");
    let mut at = key.to_owned();
    match mistake {
        Mistake::Missing => drop(map.shift_remove(key)),
        Mistake::Misspelt => {
            let value = map.shift_remove(key).expect("the key exists");
            at.insert(at.len() / 2, 'q');
            map.insert(at.clone(), value);
        }
        Mistake::Mistyped => {
            let mistyped = match &map[key] {
                Value::Null | Value::Number(_) | Value::Bool(_) => json!("what"),
                Value::String(_) => json!(7.5),
                Value::Array(items) => items
                    .first()
                    .filter(|first| first.is_string())
                    .cloned()
                    .unwrap_or(json!("what")),
                Value::Object(_) => json!([true]),
            };
            map.insert(at.clone(), mistyped);
        }
    }
    (document, format!("{parent}/{}", escaped(&at)))
}

#[test]
fn nearly_every_mistake_in_a_shipped_task_is_reported_at_its_place() {
    let (mut num_rejected, mut missed) = (0, Vec::new());
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/tasks");
    for entry in std::fs::read_dir(folder).expect("the tasks ship with the project") {
        let path = entry.expect("the folder can be read").path();
        let text = std::fs::read_to_string(&path).expect("a task is UTF-8");
        let document: Value = serde_json::from_str(&text).expect("a task is JSON");
        let mut all = Vec::new();
        keys(&document, "", &mut all);
        // A sample is enough, a different one for each task.
        let step = crate::tier::quick_or_full(11, 2);
        for (index, (parent, key)) in all
            .iter()
            .enumerate()
            .filter(|(index, _)| index % step == text.len() % step)
        {
            let mistake = [Mistake::Misspelt, Mistake::Missing, Mistake::Mistyped][index / step % 3];
            let (mistyped, at) = with_mistake(&document, parent, key, mistake);
            let Err(error) = TaskSpec::from_json("t", &mistyped.to_string()) else {
                continue;
            };
            num_rejected += 1;
            let names = |pointer: &str| {
                let missing = pointer == parent && matches!(mistake, Mistake::Missing | Mistake::Misspelt);
                missing || pointer == at || pointer.starts_with(&format!("{at}/"))
            };
            if !error.problems().iter().any(|problem| names(&problem.pointer)) {
                missed.push(format!("{:?} {mistake:?} {at}: {error}", path.file_name()));
            }
        }
    }
    assert!(num_rejected > 100, "{num_rejected}");
    let share = 1.0 - missed.len() as f64 / f64::from(num_rejected);
    assert!(share >= 0.95, "{share} of {num_rejected}:\n{}", missed.join("\n"));
}
