//! Follows the advice in messages: for every bad document under `tests/documents`, applying the advice fixes the reported
//! problem. The messages themselves are compared in `documents.rs`.

use std::path::Path;

use driftworld_spec::maps::MapLibrary;
use driftworld_spec::{Problem, Scenario, SpecError, TaskSpec, World};
use serde_json::Value;

/// Phrases that precede a value spelt out in advice.
const BEFORE_A_VALUE: [&str; 4] = [
    "drop the quotes: ",
    "write only the number: ",
    "divide by 255: ",
    "write ",
];

fn load(kind: &str, text: &str) -> Result<(), SpecError> {
    match kind {
        "world" => World::from_json(kind, text).map(drop),
        "task" => TaskSpec::from_json(kind, text).map(drop),
        "scenario" => Scenario::from_json(kind, text).map(drop),
        _ => MapLibrary::from_json(kind, text).map(drop),
    }
}

/// The document after following the advice; `None` if the advice leaves the author a choice.
fn corrected(document: &Value, problem: &Problem) -> Option<Value> {
    let mut document = document.clone();
    let advice = problem.advice.as_deref()?;
    let spelt_out = BEFORE_A_VALUE.iter().find_map(|before| advice.strip_prefix(before));
    if let Some(value) = spelt_out.and_then(|text| serde_json::from_str(text.trim_end_matches(", without quotes")).ok())
    {
        *document.pointer_mut(&problem.pointer)? = value;
        return Some(document);
    }
    let (parent, key) = problem.pointer.rsplit_once('/')?;
    if advice.starts_with("remove it") || advice == "remove one of the two" {
        document.pointer_mut(parent)?.as_object_mut()?.shift_remove(key)?;
        return Some(document);
    }
    let near: String = serde_json::from_str(advice.strip_prefix("did you mean ")?.strip_suffix('?')?).ok()?;
    if matches!(problem.code, "spec/unknown-key" | "spec/name") {
        rename(document.pointer_mut(parent)?, key, near)?;
        return Some(document);
    }
    let place = document.pointer_mut(&problem.pointer)?;
    match place.as_object().map(|object| object.keys().next().cloned()) {
        Some(first) => rename(place, &first?, near)?,
        None => *place = near.into(),
    }
    Some(document)
}

fn rename(object: &mut Value, key: &str, near: String) -> Option<()> {
    let object = object.as_object_mut()?;
    let value = object.shift_remove(key)?;
    object.insert(near, value);
    Some(())
}

/// The problems of a document as pairs of pointer and finding, without line numbers.
fn complaints(kind: &str, text: &str) -> Vec<(String, String)> {
    let error = load(kind, text).err();
    let problems = error.iter().flat_map(SpecError::problems);
    problems
        .map(|problem| (problem.pointer.clone(), problem.found.clone()))
        .collect()
}

/// The texts of the invalid documents of a kind.
fn bad_documents(kind: &str) -> impl Iterator<Item = String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("../tests/documents/bad")
        .join(kind);
    let files = std::fs::read_dir(folder).expect("the suite has a folder for each kind");
    let paths = files.map(|file| file.expect("the folder can be listed").path());
    let documents = paths.filter(|path| path.extension().is_some_and(|ending| ending == "json"));
    documents.map(|path| std::fs::read_to_string(path).expect("the file was listed"))
}

#[test]
fn following_the_advice_fixes_the_reported_problem() {
    let mut followed = 0;
    for kind in ["world", "task", "scenario", "maps"] {
        for text in bad_documents(kind) {
            let document: Value = serde_json::from_str(&text).unwrap();
            for problem in load(kind, &text).unwrap_err().problems() {
                let Some(corrected) = corrected(&document, problem).map(|corrected| corrected.to_string()) else {
                    continue;
                };
                followed += 1;
                let complaint = (problem.pointer.clone(), problem.found.clone());
                assert!(
                    !complaints(kind, &corrected).contains(&complaint),
                    "{problem}\n{corrected}"
                );
            }
        }
    }
    assert!(followed >= 50, "{followed} pieces of advice followed");
}
