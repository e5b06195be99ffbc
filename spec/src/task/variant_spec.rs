//! [`VariantSpec`]: a variant, or a family of them, as declared in a document.

use driftworld_text::IDENTIFIER_PATTERN;
use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::parameter::{Parameter, Role};
use super::sweep::Sweep;
use crate::error::first_of;
use crate::value::Value;

/// Name of the variant in which every parameter has its default, unless the task declares one with this name.
pub const DEFAULT_VARIANT: &str = "default";

/// A variant, or a family of them, as a document declares it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[schemars(transform = values_of_parameters)]
#[schemars(extend("examples" = [
    { "extends": "day", "description": "Red cubes at dusk.", "light": 0.6 },
    { "name": "{target_color}-{light}", "grid": { "target_color": ["red", "green"], "light": [0.6, 2.3] } },
    { "sweep": { "light": { "from": 0.2, "to": 4, "steps": 5 } } },
]))]
pub struct VariantSpec {
    /// The variant that it extends, overriding its values; the defaults if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 200))]
    pub extends: Option<String>,
    /// The variant in a sentence.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// For a family: the name pattern of its members, with a parameter in braces for each value, such as
    /// `{target_color}-{light}`. If absent, members are named after the family and its values, such as `look-red-0.5`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 200))]
    pub name: Option<String>,
    /// Makes it a family: lists values for each parameter; one variant for every combination, named by `name`.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(schema_with = "grid_schema")]
    pub grid: IndexMap<String, Vec<Value>>,
    /// Makes it a family: evenly spaced values for each parameter, combined with the grid and with each other.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(length(min = 1, max = 20))]
    pub sweep: IndexMap<String, Sweep>,
    /// Values of variant parameters.
    #[serde(flatten)]
    #[schemars(with = "IndexMap<String, serde_json::Value>")]
    pub values: IndexMap<String, Value>,
}

/// The keys of a variant that are not names of parameters.
pub(crate) const RESERVED: [&str; 5] = ["extends", "description", "name", "grid", "sweep"];

fn values_of_parameters(schema: &mut schemars::Schema) {
    schema.insert(
        "propertyNames".to_owned(),
        serde_json::json!({ "pattern": IDENTIFIER_PATTERN, "maxLength": 100 }),
    );
    if let Some(map) = schema
        .pointer_mut("/properties/sweep")
        .and_then(serde_json::Value::as_object_mut)
    {
        map.insert("minProperties".to_owned(), serde_json::json!(1));
        map.insert("maxProperties".to_owned(), serde_json::json!(20));
    }
}

/// For each parameter, a list of values; the parameter's type determines what is allowed.
fn grid_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
    schemars::json_schema!({
        "type": "object",
        "additionalProperties": { "type": "array", "items": true, "minItems": 1, "maxItems": 1000 },
        "minProperties": 1,
        "maxProperties": 20
    })
}

/// The parameters that variants may set, and the expectation to report if a different name is found.
pub(super) fn variant_parameters(parameters: &IndexMap<String, Parameter>) -> (Vec<&String>, String) {
    let settable = parameters
        .iter()
        .filter(|(_, parameter)| parameter.role == Role::Variant);
    let known: Vec<&String> = settable.map(|(name, _)| name).collect();
    let expected = format!("a variant parameter, one of {}", first_of(&known));
    (known, expected)
}
