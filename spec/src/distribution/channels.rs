//! [`Channels`]: a colour in a distribution; its channels may be references.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::number::Number;
use super::reference::ParamRef;
use crate::Color;

/// A number that can be a channel of a colour: [`Number`] in a spec, `f64` in a variant.
pub trait Channel: From<f64> {
    /// The channels that refer to a parameter's colour; `None` if this type has no references.
    fn of_parameter(reference: &ParamRef) -> Option<[Self; 3]>;

    /// The parameter to whose whole colour these channels refer, if they do.
    fn parameter_of(channels: &[Self; 3]) -> Option<ParamRef>;
}

impl Channel for f64 {
    fn of_parameter(_: &ParamRef) -> Option<[Self; 3]> {
        None
    }

    fn parameter_of(_: &[Self; 3]) -> Option<ParamRef> {
        None
    }
}

impl Channel for Number {
    fn of_parameter(reference: &ParamRef) -> Option<[Self; 3]> {
        let channel = |index| {
            Self::Param(ParamRef {
                param: reference.param.clone(),
                index: Some(index),
            })
        };
        reference.index.is_none().then(|| [0, 1, 2].map(channel))
    }

    fn parameter_of(channels: &[Self; 3]) -> Option<ParamRef> {
        let Self::Param(first) = &channels[0] else { return None };
        let whole = ParamRef {
            param: first.param.clone(),
            index: None,
        };
        (Self::of_parameter(&whole).as_ref() == Some(channels)).then_some(whole)
    }
}

/// A colour in a distribution: red, green and blue in 0..=1, sRGB.
///
/// Reads `[r, g, b]`, a CSS name, or `{ "param": NAME }` of a colour parameter; writes a list or the reference.
#[derive(Clone, Debug, PartialEq)]
pub struct Channels<N = f64>(pub [N; 3]);

impl From<Color> for Channels {
    fn from(color: Color) -> Self {
        Self(color.0)
    }
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "[r, g, b] in 0..1, a CSS colour name, or {\"param\": NAME}")]
enum Form<N> {
    Each([N; 3]),
    Name(String),
    Param(ParamRef),
}

impl<'de, N: Channel + Deserialize<'de>> Deserialize<'de> for Channels<N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match Form::deserialize(deserializer)? {
            Form::Each(channels) => Ok(Self(channels)),
            Form::Name(name) => Color::from_name(&name)
                .map(|color| Self(color.0.map(N::from)))
                .ok_or_else(|| D::Error::custom(format!("found {name:?}, expected a CSS colour name or [r, g, b]"))),
            Form::Param(reference) => N::of_parameter(&reference)
                .map(Self)
                .ok_or_else(|| D::Error::custom("expected a whole colour: {\"param\": NAME} without an index")),
        }
    }
}

impl<N: Channel + Serialize> Serialize for Channels<N> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match N::parameter_of(&self.0) {
            Some(reference) => reference.serialize(serializer),
            None => self.0.serialize(serializer),
        }
    }
}

impl<N: JsonSchema> JsonSchema for Channels<N> {
    fn schema_name() -> Cow<'static, str> {
        "Channels".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut channel = generator.subschema_for::<N>();
        for (key, limit) in [("minimum", 0), ("maximum", 1)] {
            channel.insert(key.to_owned(), limit.into());
        }
        let color = generator.subschema_for::<Color>();
        let reference = generator.subschema_for::<ParamRef>();
        json_schema!({
            "description": "A colour: [r, g, b] in 0..1, a CSS name, or {\"param\": NAME} of a parameter that is a colour.",
            "anyOf": [
                color,
                { "type": "array", "items": channel, "minItems": 3, "maxItems": 3 },
                reference
            ]
        })
    }
}

/// The spread of the channels of a colour.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, or [r, g, b]")]
#[schemars(rename = "ChannelSpread")]
pub enum ChannelSpread<N = f64> {
    /// The same for all channels.
    Same(N),
    /// Separate spreads for red, green and blue.
    Each([N; 3]),
}

impl ChannelSpread {
    /// The spreads of red, green and blue.
    pub fn to_array(&self) -> [f64; 3] {
        match self {
            Self::Same(spread) => [*spread; 3],
            Self::Each(spreads) => *spreads,
        }
    }
}

/// Whether the channels of a colour vary independently.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ChannelChance {
    /// Independently: red may rise while green falls.
    #[default]
    Apart,
    /// Together, from one random number: all three rise and fall together, like shades of one colour.
    #[serde(rename = "together")]
    Shared,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[track_caller]
    fn check(text: &str, expected: Option<&str>) {
        let read = serde_json::from_str::<Channels<Number>>(text).ok();
        let written = read.map(|channels| serde_json::to_string(&channels).expect("a colour serialises"));
        assert_eq!(written.as_deref(), expected, "{text}");
    }

    #[test]
    fn colour_is_a_list_a_name_or_a_parameter() {
        check("[0, 0.5, 1]", Some("[0.0,0.5,1.0]"));
        check("\"red\"", Some("[1.0,0.0,0.0]"));
        check(r#"{"param": "leaf"}"#, Some(r#"{"param":"leaf"}"#));
        let mixed = r#"[{"param":"leaf","index":1},0.5,{"param":"light"}]"#;
        check(mixed, Some(mixed));
        check("\"bleu\"", None);
        check(r#"{"param": "leaf", "index": 1}"#, None);
        check("[0, 0]", None);
    }

    #[test]
    fn resolved_channels_reject_references() {
        let red: Channels = serde_json::from_str("\"red\"").expect("a CSS name");
        assert_eq!(red, Channels::from(Color([1.0, 0.0, 0.0])));
        assert!(serde_json::from_str::<Channels>(r#"{"param": "leaf"}"#).is_err());
    }
}
