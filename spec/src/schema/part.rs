//! Parts of a schema, found by pointers into the values that it describes.

use serde_json::Value;

/// What a part of a schema refers to, or the part itself.
pub(crate) fn resolve<'a>(schema: &'a Value, part: &'a Value) -> &'a Value {
    match part.get("$ref").and_then(Value::as_str) {
        Some(reference) => schema.pointer(reference.trim_start_matches('#')).unwrap_or(part),
        None => part,
    }
}

/// The part of a schema that a pointer into the values of another part of it leads to; any number, or `*`, is that of an
/// item.
pub(crate) fn at<'a>(schema: &'a Value, part: &'a Value, pointer: &str) -> Option<&'a Value> {
    property(schema, part, pointer).map(|property| whole(schema, property))
}

/// The same as it is declared there, with its default, and references not resolved.
pub(crate) fn property<'a>(schema: &'a Value, part: &'a Value, pointer: &str) -> Option<&'a Value> {
    pointer.split('/').skip(1).try_fold(part, |part, key| {
        let part = whole(schema, part);
        let of_key = |part: &'a Value| part.get("properties")?.get(key);
        let mut forms = part["oneOf"].as_array().into_iter().flatten();
        let own = of_key(part).or_else(|| part.get("items"));
        own.or_else(|| forms.find_map(of_key))
    })
}

/// A part that may be absent without its `null`, references resolved.
fn whole<'a>(schema: &'a Value, part: &'a Value) -> &'a Value {
    let part = resolve(schema, part);
    match part["anyOf"].as_array().map(Vec::as_slice) {
        Some([only, null]) if null["type"] == "null" => resolve(schema, only),
        _ => part,
    }
}
