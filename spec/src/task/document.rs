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

/// A task spec as its document has it, before anything but the schema has been checked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "version": 2, "name": "light_and_dark",
        "parameters": { "light": { "role": "variant", "type": "number", "affects": ["O"], "range": [0.2, 4], "default": 2.3 } },
        "world": { "max_steps": 100, "environment_params": { "light_intensity": { "param": "light" } } },
        "variants": { "day": {}, "dusk": { "light": 0.3 } } },
]))]
pub(crate) struct TaskDocument {
    /// Where the JSON Schema of this document is, for editors.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub(crate) schema: Option<String>,
    /// The version of this form of document: 2. Older ones are read, newer ones refused; without it, it is taken to be 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 1, max = 2))]
    pub(crate) version: Option<u32>,
    /// The task's name: lower-case letters, digits and underscores.
    #[schemars(length(max = 100), regex(pattern = IDENTIFIER_PATTERN))]
    pub(crate) name: String,
    /// What the task is, in a sentence or two.
    #[serde(default)]
    pub(crate) description: String,
    /// The parameters by name.
    #[serde(default)]
    #[schemars(schema_with = "parameters_schema")]
    pub(crate) parameters: IndexMap<String, Parameter>,
    /// The world, but for its groups. Any leaf may be a value, a parameter, or a distribution.
    #[serde(default)]
    #[schemars(schema_with = "super::template::world_schema")]
    pub(crate) world: Json,
    /// Groups of objects, placed one after the other.
    #[serde(default)]
    #[schemars(length(max = 1000))]
    pub(crate) groups: Vec<Group>,
    /// Conditions over parameters that every variant and every world must meet, such as `"min_size < max_size"`: comparisons,
    /// arithmetic, min, max, abs, and, or, not; texts by `==` and `!=`; colours by
    /// those and by `distance(a, b)` in Oklab, 0 to 1. A world that breaks one is drawn again, a bounded number of times.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    #[schemars(length(max = 100), inner(length(min = 1, max = 500)))]
    pub(crate) require: Vec<String>,
    /// What each element of the decision process weighs when variants are compared; 1 where nothing is said.
    #[serde(default, skip_serializing_if = "is_default")]
    pub(crate) element_weights: ElementWeights,
    /// What variants are compared by where nobody says: parameters if absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub(crate) compare_by: Option<By>,
    /// Named variants: each sets some of the variant parameters, over another variant's values or the defaults. One with a
    /// grid or a sweep is a family of variants.
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
