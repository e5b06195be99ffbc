//! [`ParamRef`]: a reference to a parameter, or to one number of it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

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
