//! [`TaskDocument`]: a task spec as written, and its schema.

use std::sync::LazyLock;

use driftworld_text::{IDENTIFIER_PATTERN, NAME_PATTERN};
use indexmap::IndexMap;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};
use serde_json::{Value as Json, json};

use super::{By, ElementWeights, Group, Parameter, VariantSpec};
use crate::schema::document::DocumentSchema;
use crate::serde_defaults::is_default;

/// A task spec as written, checked against its schema only.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "version": 2, "name": "light_and_dark",
        "parameters": { "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0.2, 4], "default": 2.3 } },
        "world": { "max_steps": 100, "environment_params": { "light_intensity": { "param": "light" } } },
        "variants": { "day": {}, "dusk": { "light": 0.3 } } },
]))]
pub(crate) struct TaskDocument {
    /// The address of this document's JSON Schema, for editors.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub(crate) schema: Option<String>,
    /// The version of the document format: 2. Older versions are read, newer ones rejected; 1 if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 2))]
    pub(crate) version: Option<u32>,
    /// The task's name: lower-case letters, digits and underscores.
    #[schemars(length(max = 100), regex(pattern = IDENTIFIER_PATTERN))]
    pub(crate) name: String,
    /// The task in a sentence or two.
    #[serde(default)]
    pub(crate) description: String,
    /// The parameters by name.
    #[serde(default)]
    #[schemars(schema_with = "parameters_schema")]
    pub(crate) parameters: IndexMap<String, Parameter>,
    /// The world, except for its groups. Any leaf may be a value, a parameter, or a distribution.
    #[serde(default)]
    #[schemars(schema_with = "super::template::world_schema")]
    pub(crate) world: Json,
    /// Groups of objects, placed one after another.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub(crate) groups: Vec<Group>,
    /// Conditions over parameters that every variant and every world must meet, such as `"min_size < max_size"`: comparisons,
    /// arithmetic, min, max, abs, and, or, not; `==` and `!=` also for texts and colours; `distance(a, b)` of colours in Oklab,
    /// 0 to 1. A world that violates one is sampled again, a limited number of times.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100), inner(length(min = 1, max = 500)))]
    pub(crate) require: Vec<String>,
    /// The weight of each element of the decision process when variants are compared; 1 by default.
    #[serde(default, skip_serializing_if = "is_default")]
    pub(crate) element_weights: ElementWeights,
    /// How variants are compared by default; by parameters if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) compare_by: Option<By>,
    /// Named variants: each sets some of the variant parameters, overriding another variant's values or the defaults. An entry
    /// with a grid or a sweep is a family of variants.
    #[serde(default)]
    #[schemars(schema_with = "variants_schema")]
    pub(crate) variants: IndexMap<String, VariantSpec>,
}

impl TaskDocument {
    /// The schema of a task spec.
    pub(crate) fn schema() -> &'static DocumentSchema {
        static SCHEMA: LazyLock<DocumentSchema> =
            LazyLock::new(|| DocumentSchema::of::<TaskDocument>("task", "Driftworld task spec"));
        &SCHEMA
    }
}

fn parameters_schema(generator: &mut SchemaGenerator) -> Schema {
    by_name::<Parameter>(generator, json!({ "pattern": IDENTIFIER_PATTERN, "maxLength": 100 }))
}

fn variants_schema(generator: &mut SchemaGenerator) -> Schema {
    let names = json!({ "pattern": NAME_PATTERN, "minLength": 1, "maxLength": 100 });
    by_name::<VariantSpec>(generator, names)
}

/// The schema of an object with named entries, with the schema of the names.
fn by_name<T: JsonSchema>(generator: &mut SchemaGenerator, names: Json) -> Schema {
    let mut schema = generator.subschema_for::<IndexMap<String, T>>();
    schema.insert("propertyNames".to_owned(), names);
    schema
}
