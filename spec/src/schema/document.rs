//! [`DocumentSchema`]: the schema of a document type, generated from the Rust type, and the problems that it finds.

use std::collections::BTreeSet;
use std::sync::OnceLock;

use driftworld_schema_errors::BoundedErrors;
use jsonschema::Validator;
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde_json::{Value, json};

use super::explain;
use crate::error::{Listed, MAX_PROBLEMS};

/// Depth beyond which values of a schema are written on one line; the keys of definitions are at this depth.
const MAX_BREAK_DEPTH: usize = 4;

/// Maximum length in bytes of a value that is written on one line at any depth.
const MAX_LINE_LENGTH: usize = 100;

/// The schema of one document type, ready to check values.
pub struct DocumentSchema {
    json: Value,
    validator: Validator,
    /// Lists the errors of invalid documents; compiled when first needed.
    listing: OnceLock<BoundedErrors>,
}

impl DocumentSchema {
    /// The schema of a Rust type with this title and identifier.
    pub(crate) fn of<T: JsonSchema>(id: &str, title: &str) -> Self {
        Self::new(of_type::<T>(id, title))
    }

    /// A schema given as JSON.
    pub(crate) fn new(json: Value) -> Self {
        let validator = jsonschema::validator_for(&json).expect("the schema of our own types is tested");
        Self {
            json,
            validator,
            listing: OnceLock::new(),
        }
    }

    /// The schema as JSON.
    pub fn json(&self) -> &Value {
        &self.json
    }

    /// The schema as text, with one line for each key of a definition.
    pub fn text(&self) -> String {
        let mut text = String::new();
        write_lines(&self.json, 0, &mut text);
        text + "\n"
    }

    /// Whether a value is valid.
    pub(crate) fn allows(&self, value: &Value) -> bool {
        self.validator.is_valid(value)
    }

    /// The problems of a value, at most about [`MAX_PROBLEMS`] for any one list or object.
    pub(crate) fn problems(&self, value: &Value) -> Listed {
        // Nearly every document is valid, and this check is much faster than listing errors.
        if self.allows(value) {
            return Listed::default();
        }
        let listing = self.listing.get_or_init(|| {
            BoundedErrors::new(&self.json, MAX_PROBLEMS).expect("the first validator was compiled from the same schema")
        });
        let (problems, more) = listing.list(value, |errors| explain::problems(&self.json, value, errors));
        Listed { problems, more }
    }
}

/// Writes a value on one line if it is short or deeply nested, otherwise with one line per entry.
fn write_lines(value: &Value, depth: usize, text: &mut String) {
    let line = value.to_string();
    let entries: Vec<(String, &Value)> = match value {
        _ if depth == MAX_BREAK_DEPTH || line.len() <= MAX_LINE_LENGTH => Vec::new(),
        Value::Object(map) => map
            .iter()
            .map(|(key, value)| (format!("{}:", json!(key)), value))
            .collect(),
        Value::Array(items) => items.iter().map(|item| (String::new(), item)).collect(),
        _ => Vec::new(),
    };
    if entries.is_empty() {
        return text.push_str(&line);
    }
    let [open, close] = if value.is_array() { ["[", "]"] } else { ["{", "}"] };
    let mut before = open;
    for (key, value) in entries {
        text.extend([before, "\n", &" ".repeat(depth + 1), &key]);
        write_lines(value, depth + 1, text);
        before = ",";
    }
    text.extend(["\n", &" ".repeat(depth), close]);
}

/// The schema of a Rust type with this title and identifier.
pub(crate) fn of_type<T: JsonSchema>(id: &str, title: &str) -> Value {
    let schema: Schema = SchemaSettings::draft2020_12()
        .into_generator()
        .into_root_schema_for::<T>();
    let mut json = Value::from(schema);
    json["$id"] = json!(format!("urn:driftworld:{id}"));
    json["title"] = json!(title);
    drop_unused(&mut json);
    describe_forms(&mut json);
    put_examples_last(&mut json);
    for (_, definition) in json["$defs"].as_object_mut().into_iter().flatten() {
        put_examples_last(definition);
    }
    json
}

/// Moves the examples to the end.
fn put_examples_last(part: &mut Value) {
    if let Some(map) = part.as_object_mut()
        && let Some(examples) = map.shift_remove("examples")
    {
        map.insert("examples".to_owned(), examples);
    }
}

/// Removes unused definitions: those that templates have inlined.
fn drop_unused(schema: &mut Value) {
    let mut used = BTreeSet::new();
    let mut next = schema.clone();
    if let Some(map) = next.as_object_mut() {
        map.remove("$defs");
    }
    let mut open = vec![next];
    while let Some(part) = open.pop() {
        for name in references(&part) {
            if used.insert(name.clone()) {
                open.push(schema["$defs"][&name].clone());
            }
        }
    }
    if let Some(definitions) = schema.get_mut("$defs").and_then(Value::as_object_mut) {
        definitions.retain(|name, _| used.contains(name));
    }
}

/// The definitions that a part of a schema refers to.
fn references(part: &Value) -> Vec<String> {
    match part {
        Value::Object(map) => {
            let own = map
                .get("$ref")
                .and_then(Value::as_str)
                .and_then(|text| text.strip_prefix("#/$defs/"));
            own.map(str::to_owned)
                .into_iter()
                .chain(map.values().flat_map(references))
                .collect()
        }
        Value::Array(items) => items.iter().flat_map(references).collect(),
        _ => Vec::new(),
    }
}

/// Copies the description of a form with a single key to that key, where editors look for it.
fn describe_forms(part: &mut Value) {
    match part {
        Value::Object(map) => {
            let words = map.get("description").cloned();
            if let (Some(words), Some(properties)) = (words, map.get_mut("properties").and_then(Value::as_object_mut))
                && properties.len() == 1
            {
                for (_, property) in properties {
                    if let Some(property) = property.as_object_mut() {
                        property.entry("description").or_insert_with(|| words.clone());
                    }
                }
            }
            map.values_mut().for_each(describe_forms);
        }
        Value::Array(items) => items.iter_mut().for_each(describe_forms),
        _ => {}
    }
}
