//! Single mistakes in the shipped tasks: nearly all messages point to the place of the mistake.

use driftworld_spec::TaskSpec;
use serde_json::{Value, json};

/// A mistake in a key.
#[derive(Clone, Copy, Debug)]
enum Mistake {
    Misspelt,
    Missing,
    Mistyped,
}

/// Objects whose keys are names chosen by the author: renaming one is not a mistake at that place.
fn is_chosen(parent: &str) -> bool {
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
                if !is_chosen(pointer) {
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

/// The document with a mistake, and the place of the mistake.
fn mistaken(document: &Value, parent: &str, key: &str, mistake: Mistake) -> (Value, String) {
    let mut document = document.clone();
    let map = document
        .pointer_mut(parent)
        .and_then(Value::as_object_mut)
        .expect("the key is there");
    let mut at = key.to_owned();
    match mistake {
        Mistake::Missing => drop(map.shift_remove(key)),
        Mistake::Misspelt => {
            let value = map.shift_remove(key).expect("the key is there");
            at.insert(at.len() / 2, 'q');
            map.insert(at.clone(), value);
        }
        Mistake::Mistyped => {
            let wrong = match &map[key] {
                Value::Null | Value::Number(_) | Value::Bool(_) => json!("what"),
                Value::String(_) => json!(7.5),
                Value::Array(items) => items
                    .first()
                    .filter(|first| first.is_string())
                    .cloned()
                    .unwrap_or(json!("what")),
                Value::Object(_) => json!([true]),
            };
            map.insert(at.clone(), wrong);
        }
    }
    (document, format!("{parent}/{}", escaped(&at)))
}

#[test]
fn nearly_every_mistake_in_a_shipped_task_is_reported_at_its_place() {
    let (mut refused, mut missed) = (0, Vec::new());
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/tasks");
    for entry in std::fs::read_dir(folder).expect("the tasks are there") {
        let path = entry.expect("the folder can be read").path();
        let text = std::fs::read_to_string(&path).expect("it is text");
        let document: Value = serde_json::from_str(&text).expect("it is JSON");
        let mut all = Vec::new();
        keys(&document, "", &mut all);
        // A sample is enough, a different one for each task.
        let step = crate::tier::quick_or_full(11, 2);
        for (place, (parent, key)) in all
            .iter()
            .enumerate()
            .filter(|(place, _)| place % step == text.len() % step)
        {
            let mistake = [Mistake::Misspelt, Mistake::Missing, Mistake::Mistyped][place / step % 3];
            let (wrong, at) = mistaken(&document, parent, key, mistake);
            let Err(error) = TaskSpec::from_json("t", &wrong.to_string()) else {
                continue;
            };
            refused += 1;
            let names = |pointer: &str| {
                let missing = pointer == parent && matches!(mistake, Mistake::Missing | Mistake::Misspelt);
                missing || pointer == at || pointer.starts_with(&format!("{at}/"))
            };
            if !error.problems().iter().any(|problem| names(&problem.pointer)) {
                missed.push(format!("{:?} {mistake:?} {at}: {error}", path.file_name()));
            }
        }
    }
    assert!(refused > 100, "{refused}");
    let share = 1.0 - missed.len() as f64 / f64::from(refused);
    assert!(share >= 0.95, "{share} of {refused}:\n{}", missed.join("\n"));
}
