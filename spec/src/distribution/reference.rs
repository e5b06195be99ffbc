//! [`Number`]: a number in a distribution, or a reference to a numeric parameter.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::case::Case;

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

/// A reference to a parameter.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "param": "light" },
    { "param": "shares", "index": 0 },
]))]
pub struct ParamRef {
    /// The parameter's name.
    pub param: String,
    /// Index of one number of a vector, point or colour, from 0; absent for the whole value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(range(min = 0, max = 99))]
    pub index: Option<usize>,
}

/// The readable form: `light`, or `shares[1]`.
impl std::fmt::Display for ParamRef {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self.index {
            None => f.write_str(&self.param),
            Some(index) => write!(f, "{}[{index}]", self.param),
        }
    }
}
