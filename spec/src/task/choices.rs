//! [`Choices`]: the values that a parameter may have, as a list or by name.

use std::ops::Deref;

use driftworld_text::NAME_PATTERN;
use indexmap::IndexMap;
use schemars::{Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::describe::escape;
use crate::value::Value;

/// The values that a parameter may have. Defaults, variants and captions refer to named values by name.
///
/// # Example
/// ```
/// use driftworld_spec::TaskSpec;
/// let task = TaskSpec::from_json("t", r#"{ "name": "t", "parameters": { "map": { "role": "variant", "type": "layout",
///     "affects": ["S"], "choices": { "open": { "walls": [] }, "maze": { "maze": { "cells": [4, 4] } } }, "default": "open" } },
///   "variants": { "inside": { "map": "maze" } } }"#)?;
/// let map = &task.parameters()["map"];
/// assert_eq!(map.name_of(task.variant("inside")?.value("map").unwrap()), Some("maze"));
/// # Ok::<(), driftworld_spec::SpecError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Choices {
    /// One name for each value, or no names.
    names: Vec<String>,
    values: Vec<Value>,
}

impl Choices {
    /// The names of the values; empty for a list.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// The value with this name.
    pub(super) fn named(&self, name: &Value) -> Option<&Value> {
        let name = name.as_text()?;
        let index = self.names.iter().position(|known| known == name)?;
        self.values.get(index)
    }

    /// Each value with its key in the document.
    pub(super) fn entries(&self) -> impl Iterator<Item = (String, &Value)> {
        let key = |index: usize| {
            self.names
                .get(index)
                .map_or_else(|| index.to_string(), |name| escape(name))
        };
        self.values
            .iter()
            .enumerate()
            .map(move |(index, value)| (key(index), value))
    }
}

impl Deref for Choices {
    type Target = [Value];

    fn deref(&self) -> &[Value] {
        &self.values
    }
}

impl<'a> IntoIterator for &'a Choices {
    type Item = &'a Value;
    type IntoIter = std::slice::Iter<'a, Value>;

    fn into_iter(self) -> Self::IntoIter {
        self.values.iter()
    }
}

impl<'de> Deserialize<'de> for Choices {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(untagged, expecting = "a list of values, or an object that names the values")]
        enum Either {
            Listed(Vec<Value>),
            Named(IndexMap<String, Value>),
        }
        let (names, values) = match Either::deserialize(deserializer)? {
            Either::Listed(values) => (Vec::new(), values),
            Either::Named(values) => values.into_iter().unzip(),
        };
        Ok(Self { names, values })
    }
}

impl Serialize for Choices {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        if self.names.is_empty() {
            serializer.collect_seq(&self.values)
        } else {
            serializer.collect_map(self.names.iter().zip(&self.values))
        }
    }
}

pub(super) fn schema(_: &mut SchemaGenerator) -> Schema {
    json_schema!({
        "type": ["array", "object"],
        "items": true,
        "minItems": 1,
        "maxItems": 10_000,
        "additionalProperties": true,
        "propertyNames": { "pattern": NAME_PATTERN, "maxLength": 100 },
        "minProperties": 1,
        "maxProperties": 10_000
    })
}
