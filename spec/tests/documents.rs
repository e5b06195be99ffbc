//! The documents under `tests/documents`: the committed schemas alone reject the bad ones and accept the good ones, and each
//! bad one gives the message in its snapshot. Checks beyond the schemas are tested in `tasks.rs` and `codes.rs`.

use std::collections::BTreeSet;
use std::panic::catch_unwind;
use std::path::{Path, PathBuf};

use driftworld_spec::maps::MapLibrary;
use driftworld_spec::{Scenario, SpecError, TaskSpec, World};
use serde_json::Value;

const KINDS: [&str; 4] = ["world", "task", "scenario", "maps"];
/// Keys of a schema that no good document contains, as pointers into the schema, each with a reason.
const KEYS_WITHOUT_A_DOCUMENT: [(&str, &str); 0] = [];

/// One file of the suite.
struct Case {
    kind: &'static str,
    /// The file's path below `tests/documents`, used as its name in messages.
    name: String,
    path: PathBuf,
}

impl Case {
    fn text(&self) -> String {
        std::fs::read_to_string(&self.path).expect("the file was listed")
    }

    fn value(&self) -> Value {
        serde_json::from_str(&self.text()).unwrap_or_else(|error| panic!("{}: {error}", self.name))
    }

    /// Reads the document like a user's document.
    fn load(&self) -> Result<(), SpecError> {
        let text = self.text();
        match self.kind {
            "world" => World::from_json(&self.name, &text).map(drop),
            "task" => TaskSpec::from_json(&self.name, &text).map(drop),
            "scenario" => Scenario::from_json(&self.name, &text).map(drop),
            _ => MapLibrary::from_json(&self.name, &text).map(drop),
        }
    }
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn folder(verdict: &str, kind: &str) -> PathBuf {
    root().join("tests/documents").join(verdict).join(kind)
}

/// The names, without extension, of a folder's files with this extension; sorted.
fn stems(folder: &Path, ending: &str) -> BTreeSet<String> {
    let entries = std::fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let names = entries.map(|entry| entry.expect("the folder can be listed").file_name());
    names
        .filter_map(|name| name.to_str()?.strip_suffix(ending).map(str::to_owned))
        .collect()
}

/// The documents of a verdict and a kind, sorted by name.
fn cases(verdict: &str, kind: &'static str) -> Vec<Case> {
    let folder = folder(verdict, kind);
    let case = |stem| Case {
        kind,
        name: format!("{verdict}/{kind}/{stem}.json"),
        path: folder.join(format!("{stem}.json")),
    };
    stems(&folder, ".json").into_iter().map(case).collect()
}

fn schema(kind: &str) -> Value {
    let path = root().join(format!("schemas/{kind}.schema.json"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).expect("a committed schema is JSON")
}

/// The documents of a verdict that the committed schemas judge differently, and the number of all documents of that verdict.
fn misjudged(verdict: &str, expect_valid: bool) -> (Vec<String>, usize) {
    let mut misjudged_names = Vec::new();
    let mut count = 0;
    for kind in KINDS {
        let validator = jsonschema::validator_for(&schema(kind)).expect("a committed schema is a schema");
        let cases = cases(verdict, kind);
        count += cases.len();
        let differing = cases
            .iter()
            .filter(|case| validator.is_valid(&case.value()) != expect_valid);
        misjudged_names.extend(differing.map(|case| case.name.clone()));
    }
    (misjudged_names, count)
}

#[test]
fn schemas_alone_refuse_every_bad_document() {
    let (accepted, count) = misjudged("bad", false);
    assert!(accepted.is_empty(), "accepted, though bad: {accepted:#?}");
    assert!(count >= 300, "{count} bad documents");
}

#[test]
fn schemas_alone_accept_every_good_document() {
    let (rejected, count) = misjudged("good", true);
    assert!(rejected.is_empty(), "refused, though good: {rejected:#?}");
    assert!(count >= 30, "{count} good documents");
}

#[test]
fn every_good_document_loads() {
    for case in KINDS.iter().flat_map(|kind| cases("good", kind)) {
        case.load().unwrap_or_else(|error| panic!("{error}"));
    }
}

/// Compares a bad document's message with its snapshot.
fn compare(case: &Case) {
    let error = case.load().expect_err(&case.name);
    let mut settings = insta::Settings::new();
    settings.set_snapshot_path(case.path.parent().expect("a file lies in a folder"));
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    let stem = case.path.file_stem().and_then(|stem| stem.to_str());
    settings.bind(|| insta::assert_snapshot!(stem.expect("the file's name is UTF-8"), error.to_string()));
}

#[test]
fn every_bad_document_gives_its_snapshot_message() {
    // A change of wording affects many messages, so continues after the first difference.
    let differs = |case: &Case| catch_unwind(|| compare(case)).is_err();
    let cases = KINDS.iter().flat_map(|kind| cases("bad", kind));
    let changed: Vec<String> = cases.filter(differs).map(|case| case.name).collect();
    assert!(
        changed.is_empty(),
        "the message of each of these differs from its snapshot: {changed:#?}\n\
         if the new ones are what authors should read, rewrite them: INSTA_UPDATE=always cargo test -p driftworld-spec"
    );
    // Whatever insta's settings, each document must have a snapshot, and each snapshot a document.
    for kind in KINDS {
        let folder = folder("bad", kind);
        assert_eq!(stems(&folder, ".json"), stems(&folder, ".snap"), "bad/{kind}");
    }
}

/// Collects pointers to the schema's properties that a value has, or to all properties if there is no value.
fn properties(schema: &Value, pointer: &str, value: Option<&Value>, found: &mut BTreeSet<String>) {
    let Some(node) = schema.pointer(pointer).and_then(Value::as_object) else {
        return;
    };
    if let Some(target) = node.get("$ref").and_then(Value::as_str) {
        properties(schema, target.trim_start_matches('#'), value, found);
    }
    for key in ["anyOf", "oneOf", "allOf"] {
        let count = node.get(key).and_then(Value::as_array).map_or(0, Vec::len);
        for index in 0..count {
            properties(schema, &format!("{pointer}/{key}/{index}"), value, found);
        }
    }
    let own = node.get("properties").and_then(Value::as_object);
    for (key, schema_of_key) in own.into_iter().flatten() {
        let inner = value.map(|value| value.get(key));
        let pointer_of_key = format!("{pointer}/properties/{key}");
        let is_new =
            *schema_of_key != Value::Bool(false) && inner != Some(None) && found.insert(pointer_of_key.clone());
        // Without a value, a property that was visited before adds nothing.
        if is_new || matches!(inner, Some(Some(_))) {
            properties(schema, &pointer_of_key, inner.flatten(), found);
        }
    }
    let items = value.map(|value| value.as_array().into_iter().flatten().collect::<Vec<_>>());
    for item in each(items) {
        properties(schema, &format!("{pointer}/items"), item, found);
    }
    let others = value.map(|value| {
        let entries = value.as_object().into_iter().flatten();
        let others = entries.filter(|(key, _)| !own.is_some_and(|own| own.contains_key(*key)));
        others.map(|(_, value)| value).collect::<Vec<_>>()
    });
    for other in each(others) {
        properties(schema, &format!("{pointer}/additionalProperties"), other, found);
    }
}

/// Each value of a list, or a single `None` if there is no list.
fn each(values: Option<Vec<&Value>>) -> Vec<Option<&Value>> {
    values.map_or_else(|| vec![None], |values| values.into_iter().map(Some).collect())
}

#[test]
fn every_key_of_the_schemas_occurs_in_a_good_document() {
    let mut missing = BTreeSet::new();
    for kind in KINDS {
        let schema = schema(kind);
        let (mut all, mut used) = (BTreeSet::new(), BTreeSet::new());
        properties(&schema, "", None, &mut all);
        for case in cases("good", kind) {
            properties(&schema, "", Some(&case.value()), &mut used);
        }
        assert!(
            all.len() >= 9 && used.is_subset(&all),
            "{kind}: {} keys found",
            all.len()
        );
        missing.extend(all.difference(&used).map(|pointer| format!("{kind}{pointer}")));
    }
    let excused = KEYS_WITHOUT_A_DOCUMENT.map(|(pointer, _)| pointer.to_owned());
    assert_eq!(missing, BTreeSet::from(excused), "keys that no good document has");
}
