//! Tests that the schemas are valid, equal to the committed files, and agree with the types.

use driftworld_spec::{Object, World, reference, schema};
use serde_json::Value;

#[test]
fn every_schema_is_a_valid_schema() {
    for (name, schema) in schema::all() {
        jsonschema::meta::validate(schema.json()).unwrap_or_else(|error| panic!("{name}: {error}"));
    }
}

#[test]
fn committed_schemas_are_up_to_date() {
    for (name, schema) in schema::all() {
        let path = format!("{}/../schemas/{name}", env!("CARGO_MANIFEST_DIR"));
        let committed = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        let current = schema.text();
        assert!(committed == current, "{path} is stale; run: cargo xtask schemas");
        let read: Value = serde_json::from_str(&current).expect("a schema is JSON");
        assert_eq!(&read, schema.json());
    }
}

#[test]
fn committed_reference_is_up_to_date() {
    for (name, page) in reference::pages() {
        let path = format!("{}/../docs/reference/{name}", env!("CARGO_MANIFEST_DIR"));
        let committed = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        assert!(committed == page, "{path} is stale; run: cargo xtask schemas");
    }
}

#[test]
fn schemas_accept_documents_that_the_types_write() {
    let mut world = World::default();
    world.push(Object::new("tree", [1.0, 2.0])).expect("a tree is valid");
    let reread = World::from_json("written", &world.to_json()).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(reread, world);
}

/// Every part of a schema with its pointer, without conditions (`if`, `then`), which repeat other parts.
fn parts(part: &Value, pointer: &str, visit: &mut impl FnMut(&str, &Value)) {
    visit(pointer, part);
    let keep = |key: &str| !matches!(key, "if" | "then" | "examples" | "default" | "allOf" | "not");
    match part {
        Value::Object(map) => {
            for (key, child) in map.iter().filter(|(key, _)| keep(key)) {
                parts(child, &format!("{pointer}/{key}"), visit);
            }
        }
        Value::Array(items) => {
            for (index, item) in items.iter().enumerate() {
                parts(item, &format!("{pointer}/{index}"), visit);
            }
        }
        _ => {}
    }
}

#[test]
fn every_key_has_a_description_and_every_schema_an_identifier() {
    for (name, schema) in schema::all() {
        assert!(
            schema.json()["$id"]
                .as_str()
                .is_some_and(|id| id.starts_with("urn:driftworld:")),
            "{name}"
        );
        let mut without_description = Vec::new();
        parts(schema.json(), "", &mut |pointer, part| {
            for (key, property) in part["properties"].as_object().into_iter().flatten() {
                let referred = property["$ref"]
                    .as_str()
                    .and_then(|text| schema.json().pointer(text.trim_start_matches('#')));
                let described = |schema: &Value| schema["description"].is_string();
                if property.is_object() && !described(property) && !referred.is_some_and(described) {
                    without_description.push(format!("{pointer}/properties/{key}"));
                }
            }
        });
        assert_eq!(
            without_description,
            Vec::<String>::new(),
            "{name}: keys that an editor cannot explain"
        );
    }
}

#[test]
fn every_definition_of_an_object_has_examples_and_every_example_is_valid() {
    for (name, schema) in schema::all() {
        let json = schema.json();
        assert!(
            json["examples"].as_array().is_some_and(|examples| !examples.is_empty()),
            "{name}"
        );
        let mut all: Vec<(String, Value)> = vec![(name.to_owned(), json.clone())];
        for (definition, part) in json["$defs"].as_object().into_iter().flatten() {
            let is_object = part["properties"].is_object() || part["oneOf"].is_array();
            assert!(
                !is_object || part["examples"].is_array() || is_enumeration(part),
                "{name}: {definition} has no example"
            );
            let examples = part["examples"].as_array().cloned().unwrap_or_default();
            let reference = format!("#/$defs/{definition}");
            let alone = serde_json::json!({ "$ref": reference, "$defs": json["$defs"], "examples": examples });
            all.push((format!("{name}: {definition}"), alone));
        }
        for (definition_name, schema) in all {
            let validator =
                jsonschema::validator_for(&schema).unwrap_or_else(|error| panic!("{definition_name}: {error}"));
            for example in schema["examples"].as_array().into_iter().flatten() {
                let errors: Vec<String> = validator.iter_errors(example).map(|error| error.to_string()).collect();
                assert_eq!(errors, Vec::<String>::new(), "{definition_name}: {example}");
            }
        }
    }
}

/// Whether a schema is a list of words, which needs no example.
fn is_enumeration(part: &Value) -> bool {
    part["oneOf"]
        .as_array()
        .is_some_and(|forms| forms.iter().all(|form| form["const"].is_string()))
}
