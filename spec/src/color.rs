//! [`Color`]: a colour in a document, as `[r, g, b]` in 0..1 or a CSS name.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Error, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

/// An sRGB colour: red, green and blue, each in 0..=1, gamma-encoded as in an image file.
///
/// Reads `[r, g, b]` or a lower-case CSS name (`"green"` is `(0, 128, 0)`, as in CSS); always writes `[r, g, b]`.
///
/// # Example
/// ```
/// use driftworld_spec::Color;
/// assert_eq!(Color::from_name("red"), Some(Color([1.0, 0.0, 0.0])));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Color(pub [f64; 3]);

impl Color {
    /// The colour with this CSS name in lower case, if there is one.
    pub fn from_name(name: &str) -> Option<Self> {
        palette::named::from_str(name).map(|c| Self([c.red, c.green, c.blue].map(|channel| f64::from(channel) / 255.0)))
    }

    /// All CSS names, sorted.
    pub fn names() -> Vec<&'static str> {
        let mut names: Vec<_> = palette::named::names().collect();
        names.sort_unstable();
        names
    }

    /// The three channels as `f32`, for the renderer.
    pub fn to_f32(self) -> [f32; 3] {
        self.0.map(|channel| channel as f32)
    }

    /// Six hexadecimal digits, rounded to 8 bits per channel: `ff8000`.
    pub fn hex(self) -> String {
        let [red, green, blue] = self.0.map(|channel| (channel * 255.0).round() as u8);
        format!("{red:02x}{green:02x}{blue:02x}")
    }

    /// The CSS name of exactly this colour, otherwise `[r, g, b]` with two decimals; for messages.
    pub fn describe(self) -> String {
        let name = Self::names()
            .into_iter()
            .find(|name| Self::from_name(name) == Some(self));
        name.map_or_else(
            || format!("[{:.2}, {:.2}, {:.2}]", self.0[0], self.0[1], self.0[2]),
            str::to_owned,
        )
    }
}

impl<'de> Deserialize<'de> for Color {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ColorVisitor)
    }
}

struct ColorVisitor;

impl<'de> Visitor<'de> for ColorVisitor {
    type Value = Color;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("a colour: [r, g, b] with numbers in 0..1, or a CSS name such as \"red\"")
    }

    fn visit_str<E: Error>(self, name: &str) -> Result<Color, E> {
        Color::from_name(name).ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str(name), &self))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Color, A::Error> {
        let mut channels = [0.0; 3];
        for (index, channel) in channels.iter_mut().enumerate() {
            *channel = seq
                .next_element()?
                .ok_or_else(|| A::Error::invalid_length(index, &self))?;
        }
        if seq.next_element::<serde::de::IgnoredAny>()?.is_some() {
            return Err(A::Error::invalid_length(4, &self));
        }
        if channels.iter().any(|c: &f64| !(0.0..=1.0).contains(c)) {
            return Err(A::Error::custom("a colour channel is outside 0..1"));
        }
        Ok(Color(channels))
    }
}

impl JsonSchema for Color {
    fn schema_name() -> Cow<'static, str> {
        "Color".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "description": "A colour: [r, g, b] in 0..1, or a CSS name (\"green\" is (0, 128, 0)).",
            "anyOf": [
                { "type": "array", "items": { "type": "number", "minimum": 0, "maximum": 1 }, "minItems": 3, "maxItems": 3 },
                { "type": "string", "enum": Self::names() }
            ],
            "examples": ["red", [1, 0.5, 0]]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expected: Option<[f64; 3]>) {
        assert_eq!(
            serde_json::from_str::<Color>(text).ok().map(|c| c.0),
            expected,
            "{text}"
        );
    }

    #[test]
    fn names_and_triples_are_read_and_everything_else_is_refused() {
        check("[0, 0.5, 1]", Some([0.0, 0.5, 1.0]));
        check("\"green\"", Some([0.0, 128.0 / 255.0, 0.0]));
        check("\"bleu\"", None);
        check("[0, 0]", None);
        check("[0, 0, 0, 0]", None);
        check("[0, 0, 1.01]", None);
        check("{}", None);
    }

    #[test]
    fn describe_prefers_the_css_name() {
        assert_eq!(Color([0.0, 0.0, 1.0]).describe(), "blue");
        assert_eq!(Color([0.1, 0.2, 0.3]).describe(), "[0.10, 0.20, 0.30]");
    }
}
