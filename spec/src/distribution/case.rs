//! [`Case`]: a look-up that selects a value by the value of a parameter.

use indexmap::IndexMap;
use schemars::{Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Serialize};

use super::reference::ParamRef;

/// Selects a value by the value of a parameter: `{ "case": { "param": "cue" }, "of": { "red": 50 }, "else": 0 }`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, bound(deserialize = "T: Deserialize<'de>"))]
pub struct Case<T> {
    /// The parameter whose value selects the result; it may have any role.
    #[serde(rename = "case")]
    pub by: ParamRef,
    /// The results, keyed by the parameter's value as a string: a word, the name of a choice or colour, a number, `true` or
    /// `false`.
    pub of: IndexMap<String, T>,
    /// The result for all other values; `None` if every value has a case.
    #[serde(rename = "else", default, skip_serializing_if = "Option::is_none")]
    pub otherwise: Option<T>,
}

impl<T> Case<T> {
    /// The cases with their keys in the document; `else` comes last.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (String, &T)> {
        let of = self
            .of
            .iter()
            .map(|(key, case)| (format!("of/{}", crate::describe::escape(key)), case));
        of.chain(self.otherwise.iter().map(|case| ("else".to_owned(), case)))
    }
}

/// The schema of a look-up, given the schema of its cases.
pub(crate) fn schema(generator: &mut SchemaGenerator, description: &str, case: &Schema) -> Schema {
    let parameter = generator.subschema_for::<ParamRef>();
    let of = "The results, keyed by the parameter's value as a string: a word, the name of a choice or colour, a number, `true` or `false`.";
    json_schema!({
        "description": description,
        "type": "object",
        "properties": {
            "case": parameter,
            "of": { "description": of, "type": "object", "additionalProperties": case, "minProperties": 1, "maxProperties": 1000 },
            "else": case
        },
        "required": ["case", "of"],
        "additionalProperties": false,
        "examples": [{ "case": { "param": "cue" }, "of": { "red": 50, "blue": -50 }, "else": 0 }]
    })
}
