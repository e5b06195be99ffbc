//! Additions to the schema of distributions: limits of items, and keys that require or exclude each other.

use serde_json::json;

/// Requires a literal number to be at least 0, alone or in a list; the value of a parameter is checked when a variant resolves
/// it.
pub(super) fn none_negative(schema: &mut schemars::Schema) {
    if schema.get("items").is_none() {
        schema.insert("minimum".to_owned(), json!(0));
    }
    limit_items(schema, &json!({ "minimum": 0 }));
}

pub(super) fn shapes(schema: &mut schemars::Schema) {
    limit_items(schema, &json!({ "minimum": 0.001, "maximum": 1_000_000 }));
}

/// Requires a literal spread of channels to be in 0..10, alone or in a list.
pub(super) fn small_spread(schema: &mut schemars::Schema) {
    let limits = json!({ "minimum": 0, "maximum": 10 });
    for (key, limit) in limits.as_object().into_iter().flatten() {
        schema.insert(key.clone(), limit.clone());
    }
    limit_items(schema, &limits);
}

pub(super) fn up_to_1(schema: &mut schemars::Schema) {
    limit_items(schema, &json!({ "minimum": 0, "maximum": 1 }));
}

/// Adds limits to the items of a list.
fn limit_items(schema: &mut schemars::Schema, limits: &serde_json::Value) {
    let mut items = schema.remove("items").unwrap_or_else(|| json!({}));
    if let (Some(items), Some(limits)) = (items.as_object_mut(), limits.as_object()) {
        items.extend(limits.clone());
    }
    schema.insert("items".to_owned(), items);
}

pub(super) fn gaussian_needs_one_spread(schema: &mut schemars::Schema) {
    let forms = schema
        .get_mut("oneOf")
        .and_then(serde_json::Value::as_array_mut)
        .into_iter()
        .flatten();
    for form in forms {
        if let Some(gaussian) = form
            .pointer_mut("/properties/gaussian")
            .and_then(serde_json::Value::as_object_mut)
        {
            let one_of = json!([
                { "required": ["std"], "properties": { "covariance": false } },
                { "required": ["covariance"], "properties": { "std": false, "correlation": false } }
            ]);
            gaussian.insert("oneOf".to_owned(), one_of);
        }
    }
}
