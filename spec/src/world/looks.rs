//! [`Looks`]: the style in which a world is rendered: ground and wall textures, shadows, a ceiling. Colours, sun and fog are in
//! `environment.rs`.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value as Json;

use super::fields::{fields, word};
use crate::Color;
use crate::layout::Layout;
use crate::serde_defaults::{is_default, is_one, one};

/// How a world is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Style {
    /// Flat colours, squares on the ground, and light that does not depend on the height of the sun.
    #[default]
    Plain,
    /// Surface patterns, shadows, a sky with clouds, and a sun with warm light when it is low.
    Natural,
}

/// A surface pattern in lighter and darker shades of the face's colour. From afar it blends into the plain colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Surface {
    /// No pattern: the plain colour.
    #[default]
    Plain,
    /// Noise at all scales up to 2 m: grass, earth, plaster, carpet.
    Noise,
    /// Bricks of 0.5 × 0.25 m.
    Brick,
    /// Boards 0.25 m wide and 2 m long.
    Plank,
    /// Square tiles of 0.5 m.
    Tile,
    /// Stripes 0.25 m wide.
    Stripes,
    /// Squares of 0.5 m.
    Checker,
    /// Courses of rough stones 0.33 m high, of varying length.
    Stone,
    /// Fine grain, worn in places.
    Plaster,
    /// Round stones of 0.2 m.
    Cobbles,
}

fields! {
    /// The surface of the ground or walls.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(remote = "Self", deny_unknown_fields)]
    #[schemars(extend("examples" = [{ "surface": "brick", "scale": 1.5 }]))]
    pub struct Covering {
        /// The pattern.
        pub surface: Surface => Field::ours(Measured(&[CameraAndWeather])),
        /// Scale of the pattern, relative to its natural size in metres.
        #[serde(default = "one", skip_serializing_if = "is_one")]
        #[schemars(range(min = 0.1, max = 100.0))]
        pub scale: f64 => Field::ours(Measured(&[CameraAndWeather])),
    }
}

fields! {
    /// Looks, part by part. Absent parts come from the style.
    #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
    #[serde(remote = "Self", default, deny_unknown_fields)]
    #[schemars(extend("examples" = [
        { "style": "natural", "ground": "plank", "walls": { "surface": "brick", "scale": 1.5 }, "shadows": false },
    ]))]
    pub struct Looks {
        /// The style of rendering. In the plain style, all other keys except `fog_in_depth` are ignored.
        pub style: Style = Style::Plain
            => Field::ours(Measured(&[CameraAndWeather, ColorsOfSurroundings, ModelsOfObjects])),
        /// The surface of the ground, including zones; if absent, noise, or tiles under a ceiling.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(with = "Option<CoveringForm>")]
        pub ground: Option<Covering> = None => Field::ours(Measured(&[CameraAndWeather])),
        /// The surface of walls; bricks if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        #[schemars(with = "Option<CoveringForm>")]
        pub walls: Option<Covering> = None => Field::ours(Measured(&[CameraAndWeather])),
        /// Whether there is a ceiling, as high as the highest wall of the layout or, without a layout, of the arena, with
        /// diffuse light below it; if absent, only if the layout is a maze, rooms, or drawn with letters.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub ceiling: Option<bool> = None => Field::ours(Measured(&[CameraAndWeather, ColorsOfSurroundings])),
        /// Colour of the ceiling.
        #[serde(skip_serializing_if = "is_default_ceiling")]
        pub ceiling_color: Color = CEILING => Field::ours(Measured(&[ColorsOfSurroundings])),
        /// Whether objects and walls cast shadows on the ground; they do if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub shadows: Option<bool> = None => Field::ours(Measured(&[CameraAndWeather])),
        /// Whether there are clouds in the sky; there are if absent.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub clouds: Option<bool> = None => Field::ours(Measured(&[CameraAndWeather])),
        /// Whether fog limits depth images: each distance d then becomes d · f / √(d² + f²), which stays below the fog distance
        /// f. Otherwise depth images see through the fog.
        #[serde(skip_serializing_if = "is_default")]
        pub fog_in_depth: bool = false => Field::ours(Measured(&[CameraAndWeather])),
    }
}

/// The default colour of the ceiling.
const CEILING: Color = Color([0.86, 0.85, 0.82]);

fn is_default_ceiling(color: &Color) -> bool {
    *color == CEILING
}

impl Looks {
    /// The looks of a style.
    pub fn of(style: Style) -> Self {
        Self {
            style,
            ..Self::default()
        }
    }

    /// Whether there is a ceiling over a layout, or over an arena without one. Always false in the plain style.
    pub fn has_ceiling(&self, layout: Option<&Layout>) -> bool {
        let is_inside = |layout: &Layout| layout.maze.is_some() || layout.rooms.is_some() || layout.text.is_some();
        self.style == Style::Natural && self.ceiling.unwrap_or_else(|| layout.is_some_and(is_inside))
    }

    /// The covering of the ground, which depends on whether there is a ceiling.
    pub fn ground(&self, has_ceiling: bool) -> Covering {
        let own = if has_ceiling { Surface::Tile } else { Surface::Noise };
        self.covering(self.ground, own)
    }

    /// The covering of walls.
    pub fn walls(&self) -> Covering {
        self.covering(self.walls, Surface::Brick)
    }

    /// The colour of the ceiling; the default colour if there is none.
    pub fn ceiling_color_seen(&self, layout: Option<&Layout>) -> Color {
        if self.has_ceiling(layout) {
            self.ceiling_color
        } else {
            CEILING
        }
    }

    /// Whether objects cast shadows on the ground.
    pub fn has_shadows(&self) -> bool {
        self.style == Style::Natural && self.shadows.unwrap_or(true)
    }

    /// Whether there are clouds.
    pub fn has_clouds(&self) -> bool {
        self.style == Style::Natural && self.clouds.unwrap_or(true)
    }

    fn covering(&self, declared: Option<Covering>, own: Surface) -> Covering {
        match self.style {
            Style::Plain => Covering::of(Surface::Plain),
            Style::Natural => declared.unwrap_or_else(|| Covering::of(own)),
        }
    }
}

impl Covering {
    /// Its scale; 1 if it has no pattern.
    pub(super) fn scale_seen(self) -> f64 {
        if self.surface == Surface::Plain {
            1.0
        } else {
            self.scale
        }
    }

    /// A surface at scale 1.
    pub fn of(surface: Surface) -> Self {
        Self { surface, scale: 1.0 }
    }
}

/// Lets a part of a world be written as a single word, the value of its main key, or as an object with all its keys.
macro_rules! word_or_parts {
    ($type:ident, $form:ident, $word:ident, $expecting:literal, $of:expr) => {
        impl Serialize for $type {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                Self::serialize(self, serializer)
            }
        }

        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                struct Either;

                impl<'de> Visitor<'de> for Either {
                    type Value = $type;

                    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                        f.write_str($expecting)
                    }

                    fn visit_str<E: serde::de::Error>(self, word: &str) -> Result<$type, E> {
                        $word::deserialize(StrDeserializer::new(word)).map($of)
                    }

                    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<$type, A::Error> {
                        $type::deserialize(MapAccessDeserializer::new(map))
                    }
                }

                deserializer.deserialize_any(Either)
            }
        }

        /// The schema of both forms.
        pub(super) struct $form;

        impl JsonSchema for $form {
            fn schema_name() -> Cow<'static, str> {
                stringify!($type).into()
            }

            fn json_schema(generator: &mut SchemaGenerator) -> Schema {
                let (words, mut parts) = ($word::json_schema(generator), $type::json_schema(generator));
                let examples = parts.remove("examples");
                let words = words.get("oneOf").and_then(Json::as_array).into_iter().flatten().cloned();
                let forms: Vec<Json> = words.chain([parts.to_value()]).collect();
                json_schema!({ "description": $expecting, "oneOf": forms, "examples": examples })
            }
        }
    };
}

word_or_parts!(
    Covering,
    CoveringForm,
    Surface,
    "the name of a surface, or an object with surface and scale",
    Covering::of
);
word_or_parts!(
    Looks,
    LooksForm,
    Style,
    "a style, plain or natural, or an object of looks",
    Looks::of
);

word!(Style);
word!(Surface);

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;
    use crate::layout::{Maze, Rooms};

    #[test]
    fn word_equals_the_object_with_that_key() {
        let read = |text: &str| serde_json::from_str::<Looks>(text).map_err(|error| error.to_string());
        assert_eq!(read(r#""natural""#), read(r#"{ "style": "natural" }"#));
        assert_eq!(read("{}"), Ok(Looks::default()));
        let short = read(r#"{ "style": "natural", "ground": "plank" }"#);
        assert_eq!(
            short,
            read(r#"{ "style": "natural", "ground": { "surface": "plank", "scale": 1 } }"#)
        );
        let written = serde_json::to_value(short.expect("the looks are valid")).expect("it serialises");
        assert_eq!(written, json!({ "style": "natural", "ground": { "surface": "plank" } }));
        assert!(read(r#""pretty""#).is_err_and(|error| error.contains("`plain` or `natural`")));
        assert!(read(r#"{ "gound": "plank" }"#).is_err_and(|error| error.contains("gound")));
    }

    #[test]
    fn absent_looks_come_from_the_style() {
        let maze = Layout {
            maze: Some(Maze::default()),
            ..Layout::default()
        };
        let rooms = Layout {
            rooms: Some(Rooms::default()),
            ..Layout::default()
        };
        let natural = Looks::of(Style::Natural);
        for inside in [&maze, &rooms] {
            assert!(natural.has_ceiling(Some(inside)));
            assert!(
                !Looks {
                    ceiling: Some(false),
                    ..natural
                }
                .has_ceiling(Some(inside))
            );
            assert!(
                !Looks {
                    ceiling: Some(true),
                    style: Style::Plain,
                    ..natural
                }
                .has_ceiling(Some(inside))
            );
        }
        assert!(!natural.has_ceiling(None) && !natural.has_ceiling(Some(&Layout::default())));
        assert_eq!(natural.ground(false).surface, Surface::Noise);
        assert_eq!(natural.ground(true).surface, Surface::Tile);
        assert_eq!(Looks::default().walls().surface, Surface::Plain);
    }
}
