//! The JSON Schemas of the documents, made from the Rust types, and what they find wrong. Checks over several values are the types' own.

use std::sync::LazyLock;

use jsonschema::error::{TypeKind, ValidationErrorKind};
use jsonschema::{ValidationError, Validator};
use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema};
use serde_json::{Value, json};

use crate::document::{describe, escape};
use crate::error::Problem;
use crate::maps::MapsDocument;
use crate::scenario::Scenario;
use crate::task::TaskDocument;
use crate::world::World;

/// One document type's schema, ready to check values.
pub struct DocumentSchema {
    json: Value,
    validator: Validator,
}

impl DocumentSchema {
    pub(crate) fn new(json: Value) -> Self {
        let validator = jsonschema::validator_for(&json).expect("the schema is made from our own types and is tested");
        Self { json, validator }
    }

    /// The schema as JSON.
    pub fn json(&self) -> &Value {
        &self.json
    }

    /// Everything in a value that the schema does not allow.
    pub(crate) fn problems(&self, value: &Value) -> Vec<Problem> {
        // Nearly every document is sound, and the short answer is much faster than the list.
        if self.validator.is_valid(value) {
            return Vec::new();
        }
        self.validator
            .iter_errors(value)
            .flat_map(|error| self.explain(&error))
            .collect()
    }

    fn explain(&self, error: &ValidationError) -> Vec<Problem> {
        let pointer = error.instance_path().as_str().to_owned();
        let found = describe(error.instance());
        let one = |code, expected: String| vec![Problem::new(code, pointer.clone(), found.clone(), expected)];
        match error.kind() {
            ValidationErrorKind::AdditionalProperties { unexpected } => {
                let known = self.known_keys(error);
                unexpected
                    .iter()
                    .map(|key| unknown_key(&pointer, key, &known))
                    .collect()
            }
            ValidationErrorKind::Required { property } => {
                vec![Problem::new(
                    "spec/missing-key",
                    pointer,
                    "nothing",
                    format!("the key {property}"),
                )]
            }
            ValidationErrorKind::Enum { options } => {
                let words: Vec<String> = options.as_array().into_iter().flatten().map(describe).collect();
                let plain: Vec<&str> = options
                    .as_array()
                    .into_iter()
                    .flatten()
                    .filter_map(Value::as_str)
                    .collect();
                let word = error.instance().as_str().unwrap_or_default().to_owned();
                let expected = if words.len() > 12 {
                    "a known name".to_owned()
                } else {
                    format!("one of {}", words.join(", "))
                };
                one("spec/value", expected)
                    .into_iter()
                    .map(|problem| problem.suggest(&word, &plain))
                    .collect()
            }
            ValidationErrorKind::AnyOf { context } | ValidationErrorKind::OneOfNotValid { context } => {
                self.nearest_branch(error, context)
            }
            ValidationErrorKind::OneOfMultipleValid { .. } => {
                one("spec/value", "exactly one of the forms allowed here".into())
            }
            ValidationErrorKind::PropertyNames { error } => self.explain(error),
            kind => one(code_of(kind), expected(kind, error)),
        }
    }

    /// The keys that the object at fault may have.
    fn known_keys(&self, error: &ValidationError) -> Vec<String> {
        let place = error.schema_path().as_str();
        let parent = place.rfind('/').map_or("", |slash| &place[..slash]);
        let keys = self
            .json
            .pointer(parent)
            .and_then(|schema| schema.get("properties"))
            .and_then(Value::as_object);
        keys.into_iter()
            .flatten()
            .map(|(key, _)| key.clone())
            .filter(|key| key != "$schema")
            .collect()
    }

    /// Of several forms a value may take, the one that the author most likely meant: that which fails deepest and least.
    fn nearest_branch(&self, error: &ValidationError, context: &[Vec<ValidationError<'static>>]) -> Vec<Problem> {
        let own = error.instance_path().as_str();
        let wrong_kind = |branch: &[ValidationError]| {
            branch
                .iter()
                .any(|e| e.instance_path().as_str() == own && is_shape_error(e.kind()))
        };
        let meant = context
            .iter()
            .filter(|branch| !wrong_kind(branch))
            .min_by_key(|branch| branch.len());
        if let Some(branch) = meant {
            return branch.iter().flat_map(|error| self.explain(error)).collect();
        }
        vec![self.none_of(error, context)]
    }

    /// Says which forms a value could have had, when it has the form of none.
    fn none_of(&self, error: &ValidationError, context: &[Vec<ValidationError<'static>>]) -> Problem {
        let own = error.instance_path().as_str();
        let (mut words, mut keys, mut forms) = (Vec::new(), Vec::new(), Vec::new());
        for error in context
            .iter()
            .flatten()
            .filter(|error| error.instance_path().as_str() == own)
        {
            match error.kind() {
                ValidationErrorKind::Constant { expected_value } => words.push(describe(expected_value)),
                ValidationErrorKind::Required { property } => keys.push(describe(property)),
                _ => forms.extend(
                    self.explain(error)
                        .into_iter()
                        .filter(|p| p.pointer == own)
                        .map(|p| p.expected),
                ),
            }
        }
        let is_object = error.instance().is_object();
        if is_object && !keys.is_empty() {
            // An object was meant: what other forms there are does not help.
            (words, forms) = (Vec::new(), Vec::new());
        } else if error.instance().is_string() && !words.is_empty() {
            forms.retain(|form| !matches!(form.as_str(), "text" | "an object"));
        }
        let word = match &**error.instance() {
            Value::Object(map) => map.keys().next().cloned().unwrap_or_default(),
            other => other.as_str().unwrap_or_default().to_owned(),
        };
        let known: Vec<String> = words
            .iter()
            .chain(&keys)
            .map(|word| word.trim_matches('"').to_owned())
            .collect();
        let one_of = |what: &str, mut list: Vec<String>| {
            list.sort();
            list.dedup();
            (!list.is_empty()).then(|| format!("{what}{}", list.join(", ")))
        };
        forms.sort();
        forms.dedup();
        let expected: Vec<String> = one_of("one of ", words)
            .into_iter()
            .chain(one_of("an object with one of the keys ", keys))
            .chain(forms)
            .collect();
        Problem::new("spec/value", own, describe(error.instance()), expected.join(", or ")).suggest(&word, known)
    }
}

fn unknown_key(pointer: &str, key: &str, known: &[String]) -> Problem {
    let expected = if known.is_empty() {
        "no further keys".to_owned()
    } else {
        format!("one of {}", known.join(", "))
    };
    Problem::new(
        "spec/unknown-key",
        format!("{pointer}/{}", escape(key)),
        format!("the unknown key {key:?}"),
        expected,
    )
    .suggest(key, known)
}

/// Whether an error says that a value is of another form altogether.
fn is_shape_error(kind: &ValidationErrorKind) -> bool {
    matches!(
        kind,
        ValidationErrorKind::Type { .. }
            | ValidationErrorKind::Required { .. }
            | ValidationErrorKind::Constant { .. }
            | ValidationErrorKind::FalseSchema
    )
}

fn code_of(kind: &ValidationErrorKind) -> &'static str {
    match kind {
        ValidationErrorKind::Type { .. } => "spec/type",
        ValidationErrorKind::Minimum { .. }
        | ValidationErrorKind::Maximum { .. }
        | ValidationErrorKind::ExclusiveMinimum { .. }
        | ValidationErrorKind::ExclusiveMaximum { .. } => "spec/range",
        ValidationErrorKind::MinItems { .. } | ValidationErrorKind::MaxItems { .. } => "spec/length",
        _ => "spec/value",
    }
}

fn expected(kind: &ValidationErrorKind, error: &ValidationError) -> String {
    match kind {
        ValidationErrorKind::Type {
            kind: TypeKind::Single(kind),
        } => article(&kind.to_string()),
        ValidationErrorKind::Type {
            kind: TypeKind::Multiple(kinds),
        } => kinds
            .iter()
            .map(|kind| article(&kind.to_string()))
            .collect::<Vec<_>>()
            .join(" or "),
        ValidationErrorKind::Minimum { limit } => format!("at least {}", plain(limit)),
        ValidationErrorKind::Maximum { limit } => format!("at most {}", plain(limit)),
        ValidationErrorKind::ExclusiveMinimum { limit } => format!("more than {}", plain(limit)),
        ValidationErrorKind::ExclusiveMaximum { limit } => format!("less than {}", plain(limit)),
        ValidationErrorKind::MinItems { limit } => format!("at least {}", counted(*limit, "value")),
        ValidationErrorKind::MaxItems { limit } => format!("at most {}", counted(*limit, "value")),
        ValidationErrorKind::MinLength { limit } => format!("at least {}", counted(*limit, "character")),
        ValidationErrorKind::MaxLength { limit } => format!("at most {}", counted(*limit, "character")),
        ValidationErrorKind::MinProperties { limit } => format!("at least {}", counted(*limit, "key")),
        ValidationErrorKind::MaxProperties { limit } => format!("at most {}", counted(*limit, "key")),
        ValidationErrorKind::Pattern { pattern } => format!("text of the form {pattern}"),
        ValidationErrorKind::Constant { expected_value } => expected_value.to_string(),
        ValidationErrorKind::UniqueItems => "no value twice".to_owned(),
        _ => error.to_string(),
    }
}

/// A limit as people write it: 360 rather than 360.0.
fn plain(limit: &Value) -> String {
    limit
        .as_f64()
        .map_or_else(|| limit.to_string(), |number| number.to_string())
}

fn counted(number: u64, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

fn article(kind: &str) -> String {
    match kind {
        "integer" => "a whole number".to_owned(),
        "array" => "a list".to_owned(),
        "object" => "an object".to_owned(),
        "boolean" => "true or false".to_owned(),
        "string" => "text".to_owned(),
        other => format!("a {other}"),
    }
}

/// The schema of a Rust type under a title and an identifier of its own.
pub(crate) fn of_type<T: JsonSchema>(id: &str, title: &str) -> Value {
    let schema: Schema = SchemaSettings::draft2020_12()
        .into_generator()
        .into_root_schema_for::<T>();
    let mut json = Value::from(schema);
    json["$id"] = json!(format!("urn:driftworld:{id}"));
    json["title"] = json!(title);
    json
}

/// The schema of [`World`].
pub fn world() -> &'static DocumentSchema {
    static SCHEMA: LazyLock<DocumentSchema> =
        LazyLock::new(|| DocumentSchema::new(of_type::<World>("world", "Driftworld world")));
    &SCHEMA
}

/// The schema of [`TaskSpec`](crate::TaskSpec).
pub fn task() -> &'static DocumentSchema {
    static SCHEMA: LazyLock<DocumentSchema> =
        LazyLock::new(|| DocumentSchema::new(of_type::<TaskDocument>("task", "Driftworld task spec")));
    &SCHEMA
}

/// The schema of [`Scenario`].
pub fn scenario() -> &'static DocumentSchema {
    static SCHEMA: LazyLock<DocumentSchema> =
        LazyLock::new(|| DocumentSchema::new(of_type::<Scenario>("scenario", "Driftworld scenario")));
    &SCHEMA
}

/// The schema of a maps file, as [`MapLibrary`](crate::maps::MapLibrary) reads it.
pub fn maps() -> &'static DocumentSchema {
    static SCHEMA: LazyLock<DocumentSchema> =
        LazyLock::new(|| DocumentSchema::new(of_type::<MapsDocument>("maps", "Driftworld maps file")));
    &SCHEMA
}

/// The schemas of all document types with their file names.
pub fn all() -> [(&'static str, &'static DocumentSchema); 4] {
    [
        ("world.schema.json", world()),
        ("task.schema.json", task()),
        ("scenario.schema.json", scenario()),
        ("maps.schema.json", maps()),
    ]
}
