//! Describes the expectations of a schema for messages: types, limits, patterns.

use driftworld_text::{IDENTIFIER_PATTERN, NAME_PATTERN, counted};
use jsonschema::ValidationError;
use jsonschema::error::{TypeKind, ValidationErrorKind};
use serde_json::Value;

use super::part;

/// Pattern of the text on a sign.
pub(crate) const TEXT_PATTERN: &str = "^[A-Z0-9!?<>+ -]*$";

pub(super) fn code_of(kind: &ValidationErrorKind) -> &'static str {
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

/// What an error expected; `schema` is the part of `root` that contains the violated keyword.
pub(super) fn expected(error: &ValidationError, root: &Value, schema: &Value) -> String {
    match error.kind() {
        ValidationErrorKind::Type { kind } => {
            // Null means an absent key, which is irrelevant to an author who wrote a value.
            let is_one = matches!(kind, TypeKind::Single(_));
            let kinds = types(kind).into_iter().filter(|kind| is_one || kind != "null");
            let word = |kind: String| match kind.as_str() {
                "array" => list(root, schema),
                "object" if is_one => object(schema),
                kind => article(kind),
            };
            either(kinds.map(word).collect())
        }
        ValidationErrorKind::Minimum { limit } => format!("at least {}", plain(limit)),
        ValidationErrorKind::Maximum { limit } => format!("at most {}", plain(limit)),
        ValidationErrorKind::ExclusiveMinimum { limit } => format!("more than {}", plain(limit)),
        ValidationErrorKind::ExclusiveMaximum { limit } => format!("less than {}", plain(limit)),
        ValidationErrorKind::MinItems { limit } | ValidationErrorKind::MaxItems { limit }
            if schema.get("minItems") == schema.get("maxItems") =>
        {
            format!("exactly {}", counted(*limit as usize, "value"))
        }
        ValidationErrorKind::MinItems { limit } => format!("at least {}", counted(*limit as usize, "value")),
        ValidationErrorKind::MaxItems { limit } => format!("at most {}", counted(*limit as usize, "value")),
        ValidationErrorKind::MinLength { limit } => format!("at least {}", counted(*limit as usize, "character")),
        ValidationErrorKind::MaxLength { limit } => format!("at most {}", counted(*limit as usize, "character")),
        ValidationErrorKind::MinProperties { limit } => format!("at least {}", counted(*limit as usize, "key")),
        ValidationErrorKind::MaxProperties { limit } => format!("at most {}", counted(*limit as usize, "key")),
        ValidationErrorKind::MultipleOf { multiple_of } if (multiple_of - 1.0).abs() < f64::EPSILON => {
            article("integer")
        }
        ValidationErrorKind::Pattern { pattern } => describe_pattern(pattern),
        ValidationErrorKind::Constant { expected_value } => expected_value.to_string(),
        ValidationErrorKind::UniqueItems => "no repeated values".to_owned(),
        _ => error.to_string(),
    }
}

/// The names of the allowed types.
pub(super) fn types(kind: &TypeKind) -> Vec<String> {
    match kind {
        TypeKind::Single(kind) => vec![kind.to_string()],
        TypeKind::Multiple(kinds) => kinds.iter().map(|kind| kind.to_string()).collect(),
    }
}

/// A pattern of our schemas in words.
fn describe_pattern(pattern: &str) -> String {
    match pattern {
        IDENTIFIER_PATTERN => "lower-case letters, digits and underscores, starting with a letter".to_owned(),
        NAME_PATTERN => "a name of letters, digits, _, -, + and ., which begins with a letter, a digit or _ and does not end with a dot".to_owned(),
        TEXT_PATTERN => "capital letters A to Z, digits, spaces and ! ? < > + -".to_owned(),
        other => format!("text of the form {other}"),
    }
}

/// A limit in readable form: 360 rather than 360.0.
fn plain(limit: &Value) -> String {
    limit
        .as_f64()
        .map_or_else(|| limit.to_string(), |number| number.to_string())
}

/// A JSON Schema type in plain words.
pub(super) fn article(kind: &str) -> String {
    match kind {
        "integer" => "a whole number".to_owned(),
        "array" => "a list".to_owned(),
        "object" => "an object".to_owned(),
        "boolean" => "true or false".to_owned(),
        "string" => "text".to_owned(),
        other => format!("a {other}"),
    }
}

/// The words that a part of a schema allows, if it allows nothing else.
pub(super) fn words_of<'a>(root: &'a Value, part: &'a Value) -> Vec<&'a str> {
    let part = part::resolve(root, part);
    let forms = part
        .get("oneOf")
        .and_then(Value::as_array)
        .map_or(std::slice::from_ref(part), Vec::as_slice);
    let words = forms.iter().map(|form| {
        let options = form["enum"]
            .as_array()
            .map(Vec::as_slice)
            .or_else(|| form.get("const").map(std::slice::from_ref));
        options?.iter().map(Value::as_str).collect::<Option<Vec<_>>>()
    });
    words.collect::<Option<Vec<_>>>().unwrap_or_default().concat()
}

/// Describes a list by its items.
pub(super) fn list(root: &Value, schema: &Value) -> String {
    let items = part::resolve(root, &schema["items"]);
    let words = words_of(root, items);
    match items["type"].as_str() {
        _ if !words.is_empty() => {
            format!("a list of words ({})", quoted(&words).join(", "))
        }
        Some("number" | "integer") if schema["minItems"] == 2 && schema["maxItems"] == 2 => {
            "a list of two numbers".to_owned()
        }
        Some("number" | "integer") => "a list of numbers".to_owned(),
        Some("string") => "a list of texts".to_owned(),
        Some("object") => "a list of objects".to_owned(),
        Some("array") => "a list of lists".to_owned(),
        _ => article("array"),
    }
}

/// Describes an object by its required keys.
pub(super) fn object(schema: &Value) -> String {
    let required = schema["required"].as_array().into_iter().flatten();
    let keys: Vec<&str> = required.filter_map(Value::as_str).collect();
    match keys.len() {
        0 => article("object"),
        1 => format!("an object with the key {}", both(&keys)),
        _ => format!("an object with the keys {}", both(&keys)),
    }
}

/// "a, b or c".
pub(super) fn either(words: Vec<String>) -> String {
    join(words, "or")
}

/// `"a" and "b"`.
pub(super) fn both(words: &[&str]) -> String {
    join(quoted(words), "and")
}

/// Words in quotes.
pub(super) fn quoted(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| format!("{word:?}")).collect()
}

fn join(mut words: Vec<String>, conjunction: &str) -> String {
    match words.pop() {
        Some(last) if !words.is_empty() => format!("{} {conjunction} {last}", words.join(", ")),
        last => last.unwrap_or_default(),
    }
}
