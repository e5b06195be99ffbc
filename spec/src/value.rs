//! [`Value`] and [`ParameterType`]: values of parameters and their types.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::describe::plain_number;
use crate::distribution::{Distribution, Number};
use crate::{Color, Layout};

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
    /// A direction in degrees clockwise from +y; 350 is as near to 10 as 10 is to 30.
    Heading,
    /// A list of numbers, of the same length in every variant.
    Vector,
    /// A distribution: the distribution of a draw or of positions is itself a parameter.
    Distribution,
    /// The walls that divide the arena: a maze, rooms, a text, a predefined map, or a list of walls.
    Layout,
    /// Any JSON that is valid where it is used: a list, an object, a word, a number, or `null` for a key that may be absent.
    /// Its values are checked against the schema of each place of use.
    Json,
}

impl ParameterType {
    /// The type's name in documents.
    pub fn name(self) -> &'static str {
        self.into()
    }

    /// Whether a value of this type fits where `other` is required.
    pub fn fits(self, other: Self) -> bool {
        match self {
            Self::Integer => matches!(other, Self::Integer | Self::Number | Self::Heading),
            Self::Number => matches!(other, Self::Number | Self::Heading),
            _ => self == other,
        }
    }

    /// Whether its values are ordered numbers, which may have a range.
    pub fn is_numeric(self) -> bool {
        matches!(self, Self::Number | Self::Integer | Self::Heading | Self::Vector)
    }
}

/// A value of a parameter.
///
/// Reads any JSON that can be a value; [`Value::cast`] then gives it the parameter's type.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "any JSON")]
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
    /// A layout; any JSON before it is cast.
    #[schemars(skip)]
    #[serde(skip_deserializing)]
    Layout(Box<Layout>),
    /// Any other JSON, and any JSON after a cast to [`ParameterType::Json`].
    #[schemars(skip)]
    Json(#[serde(deserialize_with = "canonical_json")] Box<serde_json::Value>),
}

impl Value {
    /// Converts the value to a type if possible: integers become numbers, CSS names become colours, headings of any size are
    /// wrapped into 0..360, and everything can become JSON.
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
            | (P::Distribution, Self::Distribution(_))
            | (P::Layout, Self::Layout(_)) => Some(self.clone()),
            (P::Number, Self::Integer(whole)) => Some(Self::Number(*whole as f64)),
            (P::Integer, Self::Number(number)) => whole(*number).map(Self::Integer),
            (P::Heading, Self::Number(_) | Self::Integer(_)) => {
                self.as_number().map(|degrees| Self::Number(turned(degrees)))
            }
            (P::Color, Self::Text(name)) => Color::from_name(name).map(Self::Color),
            (P::Vector, _) => self.as_vector().map(|vector| Self::Vector(vector.to_vec())),
            (P::Layout, Self::Json(json)) => Layout::deserialize(&**json)
                .ok()
                .map(|layout| Self::Layout(Box::new(layout))),
            (P::Json, _) => Some(Self::Json(Box::new(canonical(self.to_json())))),
            _ => None,
        }
    }

    /// Whether it is [`Value::Json`]: when read, a list of words or of lists, an object, or `null`.
    pub(crate) fn is_json(&self) -> bool {
        matches!(self, Self::Json(_))
    }

    /// The number, if the value is real or an integer.
    pub fn as_number(&self) -> Option<f64> {
        match self {
            Self::Number(number) => Some(*number),
            Self::Integer(whole) => Some(*whole as f64),
            _ => None,
        }
    }

    /// The colour, if the value is one or names one.
    pub fn as_color(&self) -> Option<Color> {
        match self.cast(ParameterType::Color)? {
            Self::Color(color) => Some(color),
            _ => None,
        }
    }

    /// The integer, if the value is one.
    pub fn as_integer(&self) -> Option<i64> {
        let Self::Integer(whole) = self else { return None };
        Some(*whole)
    }

    /// The string, if the value is one.
    pub(crate) fn as_text(&self) -> Option<&str> {
        let Self::Text(text) = self else { return None };
        Some(text)
    }

    /// The numbers of a vector, point or colour: JSON may have been read as a point or colour where a vector is meant.
    pub fn as_vector(&self) -> Option<&[f64]> {
        match self {
            Self::Vector(numbers) => Some(numbers),
            Self::Point(numbers) => Some(numbers),
            Self::Color(Color(numbers)) => Some(numbers),
            _ => None,
        }
    }

    /// The value, or the component at an index of a vector or point.
    pub fn at(&self, index: Option<usize>) -> Option<Self> {
        match index {
            None => Some(self.clone()),
            Some(index) => self.as_vector()?.get(index).copied().map(Self::Number),
        }
    }

    /// The value in JSON.
    pub fn to_json(&self) -> serde_json::Value {
        match self {
            Self::Json(json) => (**json).clone(),
            other => serde_json::to_value(other)
                .expect("values consist of numbers and strings in lists and maps, which always serialise"),
        }
    }
}

fn canonical_json<'de, D: serde::Deserializer<'de>>(json: D) -> Result<Box<serde_json::Value>, D::Error> {
    serde_json::Value::deserialize(json).map(|json| Box::new(canonical(json)))
}

/// Canonical JSON, in which equal values have equal texts: sorted keys, and integers without a decimal point.
fn canonical(json: serde_json::Value) -> serde_json::Value {
    let mut json = with_whole_numbers(json);
    json.sort_all_objects();
    json
}

/// The same JSON with numbers such as 10.0 and 1e2 written as integers.
pub(crate) fn with_whole_numbers(json: serde_json::Value) -> serde_json::Value {
    use serde_json::Value as Json;
    match json {
        Json::Number(number) => {
            let whole = number.as_f64().filter(|_| number.is_f64()).and_then(whole);
            whole.map_or(Json::Number(number), Json::from)
        }
        Json::Array(list) => list.into_iter().map(with_whole_numbers).collect(),
        Json::Object(map) => {
            let entries = map.into_iter().map(|(key, child)| (key, with_whole_numbers(child)));
            Json::Object(entries.collect())
        }
        other => other,
    }
}

/// The integer equal to a double; up to 2⁵³ each integer has its own double.
fn whole(number: f64) -> Option<i64> {
    (number.fract() == 0.0 && number.abs() <= 9_007_199_254_740_992.0).then_some(number as i64)
}

/// Wraps a heading of any size into 0..360; a tiny negative heading would otherwise round up to 360.
pub(crate) fn turned(degrees: f64) -> f64 {
    let turned = degrees.rem_euclid(360.0);
    if turned >= 360.0 { 0.0 } else { turned }
}

/// A human-readable form, with colours by name if they have one.
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
    fn cast_converts_json_to_the_parameters_type_or_none() {
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
    fn equal_json_has_the_same_text_and_round_trips() {
        let json = |text: &str| {
            serde_json::from_str::<Value>(text)
                .unwrap()
                .cast(ParameterType::Json)
                .unwrap()
        };
        for (text, expected) in [
            ("null", "null"),
            ("[1.0, 2, 2.5]", "[1,2,2.5]"),
            (r#"["rgb", "depth"]"#, r#"["rgb","depth"]"#),
            (
                r#"{"b": [[1, 0, 0]], "a": {"d": null, "c": -3.0}}"#,
                r#"{"a":{"c":-3,"d":null},"b":[[1,0,0]]}"#,
            ),
            ("\"red\"", "\"red\""),
            ("[]", "[]"),
        ] {
            assert_eq!(json(text).to_string(), expected);
            assert_eq!(json(expected), json(text));
        }
        check("null", ParameterType::Number, None);
        check("[[1, 2], [3, 4]]", ParameterType::Vector, None);
    }

    #[test]
    fn distribution_is_a_value_of_its_own_type() {
        let value: Value = serde_json::from_str(r#"{"disc": {"center": [0, 0], "radius": {"param": "r"}}}"#).unwrap();
        assert!(value.cast(ParameterType::Distribution).is_some() && value.cast(ParameterType::Point).is_none());
    }
}
