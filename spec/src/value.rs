//! Values of parameters and their types. Where a value may stand in a world is in `world/fields/`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::Color;
use crate::describe::plain_number;
use crate::distribution::{Distribution, Number};

/// The type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema, strum::IntoStaticStr)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
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
    /// A direction in degrees, 0 is +y, growing clockwise; 350 is as near to 10 as 10 to 30.
    Heading,
    /// A list of numbers, as long in every variant.
    Vector,
    /// A distribution: what is drawn, or where objects stand, is itself a parameter.
    Distribution,
}

impl ParameterType {
    /// The type's name as documents write it.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Whether a value of this type can stand where `other` is wanted.
    pub fn fits(self, other: Self) -> bool {
        match self {
            Self::Integer => matches!(other, Self::Integer | Self::Number | Self::Heading),
            Self::Number => matches!(other, Self::Number | Self::Heading),
            _ => self == other,
        }
    }

    /// Whether its values are numbers in an order, so that they may have a range.
    pub fn is_numeric(self) -> bool {
        matches!(self, Self::Number | Self::Integer | Self::Heading | Self::Vector)
    }
}

/// A value of a parameter.
///
/// Reads any JSON that can be a value; [`Value::cast`] then gives it the parameter's type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(
    untagged,
    expecting = "a number, true or false, text, a list of numbers, or a distribution"
)]
pub enum Value {
    /// True or false.
    Boolean(bool),
    /// A whole number.
    Integer(i64),
    /// A real number, or a heading in degrees.
    Number(f64),
    /// Text, or the name of a colour before it is cast.
    Text(String),
    /// A point on the ground in metres.
    Point([f64; 2]),
    /// A colour.
    Color(Color),
    /// A list of numbers.
    Vector(#[schemars(length(min = 1, max = 100))] Vec<f64>),
    /// A distribution whose numbers may refer to parameters.
    Distribution(Box<Distribution<Number>>),
}

impl Value {
    /// This value as one of the given type, if it can be one: whole numbers are numbers, CSS names are colours, and a heading
    /// of any size is turned into 0..360.
    pub fn cast(&self, kind: ParameterType) -> Option<Self> {
        use ParameterType as P;
        match (kind, self) {
            (P::Boolean, Self::Boolean(_))
            | (P::Integer, Self::Integer(_))
            | (P::Number, Self::Number(_))
            | (P::String, Self::Text(_))
            | (P::Point, Self::Point(_))
            | (P::Color, Self::Color(_))
            | (P::Vector, Self::Vector(_))
            | (P::Distribution, Self::Distribution(_)) => Some(self.clone()),
            (P::Number, Self::Integer(whole)) => Some(Self::Number(*whole as f64)),
            (P::Heading, Self::Number(_) | Self::Integer(_)) => {
                self.as_number().map(|degrees| Self::Number(turned(degrees)))
            }
            (P::Color, Self::Text(name)) => Color::from_name(name).map(Self::Color),
            (P::Vector, _) => self.as_vector().map(|vector| Self::Vector(vector.to_vec())),
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

    /// The numbers of a vector, or of a point or colour, which are read from JSON where a vector of their length is meant.
    pub fn as_vector(&self) -> Option<&[f64]> {
        match self {
            Self::Vector(numbers) => Some(numbers),
            Self::Point(numbers) => Some(numbers),
            Self::Color(Color(numbers)) => Some(numbers),
            _ => None,
        }
    }

    /// The value, or the number at a place of a vector or point.
    pub fn at(&self, index: Option<usize>) -> Option<Self> {
        match index {
            None => Some(self.clone()),
            Some(index) => self.as_vector()?.get(index).copied().map(Self::Number),
        }
    }

    /// The value in JSON.
    pub fn to_json(&self) -> serde_json::Value {
        serde_json::to_value(self)
            .expect("values are numbers, texts and lists and maps of them, which always serialise")
    }
}

/// A heading of any size as one in 0..360: a tiny negative one would be rounded up to 360 itself.
pub(crate) fn turned(degrees: f64) -> f64 {
    let turned = degrees.rem_euclid(360.0);
    if turned >= 360.0 { 0.0 } else { turned }
}

/// As people read it: colours by name where they have one.
impl std::fmt::Display for Value {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::Color(color) => f.write_str(&color.describe()),
            Self::Text(text) => f.write_str(text),
            Self::Distribution(distribution) => write!(f, "{distribution}"),
            Self::Number(number) => f.write_str(&plain_number(*number)),
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
        let red = || Some(Value::Color(Color([1.0, 0.0, 0.0])));
        check("3", ParameterType::Integer, Some(Value::Integer(3)));
        check("3", ParameterType::Number, Some(Value::Number(3.0)));
        check("3.5", ParameterType::Integer, None);
        check("\"red\"", ParameterType::Color, red());
        check("\"bleu\"", ParameterType::Color, None);
        check("\"red\"", ParameterType::String, Some(Value::Text("red".into())));
        check("[1, 2]", ParameterType::Point, Some(Value::Point([1.0, 2.0])));
        check("[1, 0, 0]", ParameterType::Color, red());
        check("true", ParameterType::Number, None);
        check("-90", ParameterType::Heading, Some(Value::Number(270.0)));
        check("360", ParameterType::Heading, Some(Value::Number(0.0)));
        check("[1, 2]", ParameterType::Vector, Some(Value::Vector(vec![1.0, 2.0])));
        check(
            "[0, 0, 1]",
            ParameterType::Vector,
            Some(Value::Vector(vec![0.0, 0.0, 1.0])),
        );
        check(
            "[7, 8, 9, 10]",
            ParameterType::Vector,
            Some(Value::Vector(vec![7.0, 8.0, 9.0, 10.0])),
        );
        check("[7, 8, 9, 10]", ParameterType::Point, None);
    }

    #[test]
    fn a_distribution_is_a_value_of_its_own_type() {
        let value: Value = serde_json::from_str(r#"{"disc": {"center": [0, 0], "radius": {"param": "r"}}}"#).unwrap();
        assert!(value.cast(ParameterType::Distribution).is_some() && value.cast(ParameterType::Point).is_none());
    }
}
