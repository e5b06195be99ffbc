//! Finds parts of a schema by pointers into the values that it describes.

use serde_json::Value;

/// Follows a reference; returns other parts unchanged.
pub(crate) fn resolve<'a>(schema: &'a Value, part: &'a Value) -> &'a Value {
    match part.get("$ref").and_then(Value::as_str) {
        Some(reference) => schema.pointer(reference.trim_start_matches('#')).unwrap_or(part),
        None => part,
    }
}

/// The part of a schema for a pointer into the values of another part; any number, or `*`, means an item.
pub(crate) fn at<'a>(schema: &'a Value, part: &'a Value, pointer: &str) -> Option<&'a Value> {
    property(schema, part, pointer).map(|property| whole(schema, property))
}

/// Like [`at`], but as declared, with its default and with references unresolved.
pub(crate) fn property<'a>(schema: &'a Value, part: &'a Value, pointer: &str) -> Option<&'a Value> {
    pointer.split('/').skip(1).try_fold(part, |part, key| {
        let part = whole(schema, part);
        let of_key = |part: &'a Value| part.get("properties")?.get(key);
        let mut forms = part["oneOf"].as_array().into_iter().flatten();
        let own = of_key(part).or_else(|| part.get("items"));
        own.or_else(|| forms.find_map(of_key))
    })
}

/// The part without the `null` of an optional value, with references resolved.
fn whole<'a>(schema: &'a Value, part: &'a Value) -> &'a Value {
    let part = resolve(schema, part);
    match part["anyOf"].as_array().map(Vec::as_slice) {
        Some([only, null]) if null["type"] == "null" => resolve(schema, only),
        _ => part,
    }
}
