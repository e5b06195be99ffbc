//! The values that parameters take, and their types. Which value a variant has is in `variant.rs`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Color;

/// The type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ParameterType {
    /// A finite real number.
    Number,
    /// A whole number.
    Integer,
    /// True or false.
    Boolean,
    /// Text, chosen from a list.
    String,
    /// A colour: `[r, g, b]` in 0..1 or a CSS name.
    Color,
    /// A point on the ground, `[x, y]` in metres.
    Point,
}

impl ParameterType {
    /// The type's name as documents write it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Number => "number",
            Self::Integer => "integer",
            Self::Boolean => "boolean",
            Self::String => "string",
            Self::Color => "color",
            Self::Point => "point",
        }
    }

    /// Whether a value of this type can stand where `other` is wanted.
    pub fn fits(self, other: Self) -> bool {
        self == other || (self == Self::Integer && other == Self::Number)
    }
}

/// A value of a parameter.
///
/// Reads any JSON that can be a value; [`Value::cast`] then gives it the parameter's type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, true or false, text, [r, g, b] or [x, y]")]
pub enum Value {
    /// True or false.
    Boolean(bool),
    /// A whole number.
    Integer(i64),
    /// A real number.
    Number(f64),
    /// Text, or the name of a colour before it is cast.
    Text(String),
    /// A point on the ground in metres.
    Point([f64; 2]),
    /// A colour.
    Color(Color),
}

impl Value {
    /// This value as one of the given type, if it can be one: whole numbers are numbers, CSS names are colours.
    pub fn cast(&self, kind: ParameterType) -> Option<Self> {
        match (kind, self) {
            (ParameterType::Boolean, Self::Boolean(_))
            | (ParameterType::Integer, Self::Integer(_))
            | (ParameterType::Number, Self::Number(_))
            | (ParameterType::String, Self::Text(_))
            | (ParameterType::Point, Self::Point(_))
            | (ParameterType::Color, Self::Color(_)) => Some(self.clone()),
            (ParameterType::Number, Self::Integer(whole)) => Some(Self::Number(*whole as f64)),
            (ParameterType::Color, Self::Text(name)) => Color::from_name(name).map(Self::Color),
            _ => None,
        }
    }

    /// The number, if the value is a real or whole one.
    pub fn as_number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Integer(whole) => Some(*whole as f64),
            _ => None,
        }
    }

    /// The whole number, if the value is one.
    pub fn as_integer(&self) -> Option<i64> {
        if let Self::Integer(whole) = self {
            Some(*whole)
        } else {
            None
        }
    }

    /// The value in JSON.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::to_value(self).expect("values are numbers, texts and lists of numbers, which always serialise")
    }
}

/// As people read it: colours by name where they have one.
impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::Color(color) => f.write_str(&color.describe()),
            Self::Text(text) => f.write_str(text),
            other => write!(f, "{}", other.to_json()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[expect(clippy::needless_pass_by_value, reason = "the cases read better with plain values")]
    fn check(json: &str, kind: ParameterType, expected: Option<Value>) {
        let value: Value = serde_json::from_str(json).unwrap();
        assert_eq!(value.cast(kind), expected, "{json} as {}", kind.name());
    }

    #[test]
    fn json_becomes_a_value_of_the_parameters_type_or_none() {
        check("3", ParameterType::Integer, Some(Value::Integer(3)));
        check("3", ParameterType::Number, Some(Value::Number(3.0)));
        check("3.5", ParameterType::Integer, None);
        check(
            "\"red\"",
            ParameterType::Color,
            Some(Value::Color(Color([1.0, 0.0, 0.0]))),
        );
        check("\"bleu\"", ParameterType::Color, None);
        check("\"red\"", ParameterType::String, Some(Value::Text("red".into())));
        check("[1, 2]", ParameterType::Point, Some(Value::Point([1.0, 2.0])));
        check(
            "[1, 0, 0]",
            ParameterType::Color,
            Some(Value::Color(Color([1.0, 0.0, 0.0]))),
        );
        check("true", ParameterType::Number, None);
    }
}
