//! [`Number`]: a number in a distribution, or a reference to a numeric parameter.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Serialize};

use super::case::{self, Case};
use super::reference::ParamRef;

/// A number in a distribution: a literal, the value of a fixed or variant parameter, or one selected by the value of any
/// parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, or {\"param\": NAME}")]
pub enum Number {
    /// The number itself.
    Literal(f64),
    /// The value of a parameter.
    Param(ParamRef),
    /// A number selected by the value of a parameter.
    Case(Box<Case<Number>>),
}

impl Number {
    /// The parameters that it names, including those in look-ups.
    pub(crate) fn names(&self) -> Vec<&str> {
        match self {
            Self::Literal(_) => Vec::new(),
            Self::Param(reference) => vec![&reference.param],
            Self::Case(case) => {
                let cases = case.entries().flat_map(|(_, number)| number.names());
                std::iter::once(case.by.param.as_str()).chain(cases).collect()
            }
        }
    }
}

impl From<f64> for Number {
    fn from(number: f64) -> Self {
        Self::Literal(number)
    }
}

impl JsonSchema for Case<Number> {
    fn schema_name() -> Cow<'static, str> {
        "NumberCase".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let number = generator.subschema_for::<Number>();
        case::schema(generator, "A number selected by the value of a parameter.", &number)
    }
}
