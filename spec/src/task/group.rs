//! A group of similar objects with random positions, as declared in a task spec.

use driftworld_text::NAME_PATTERN;
use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;

use super::template::Source;
use crate::distribution::{Distribution, Number};
use crate::serde_defaults::is_default;

/// A group of objects: their number, their template, and their positions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("examples" = [
    { "name": "trees", "count": 8, "object": { "class": "tree" }, "placement": { "box": { "low": [-28, -28], "high": [28, 28] } }, "separation": 3 },
    { "name": "fences", "count": { "poisson": { "mean": 3 } }, "around": "houses", "facing": "middle",
        "object": { "class": "fence" }, "placement": { "annulus": { "center": [0, 0], "inner": 6, "outer": 9 } } },
]))]
pub struct Group {
    /// The group's name; its objects get it as their `tag` unless the template sets another.
    #[schemars(length(min = 1, max = 100), regex(pattern = NAME_PATTERN))]
    pub name: String,
    /// Number of objects, or of objects around each object of another group: a whole number, a parameter, or a distribution.
    #[schemars(schema_with = "super::template::count_schema")]
    pub count: Json,
    /// The template of each object; any leaf may be a value, a parameter, or a distribution, from which each object draws.
    #[schemars(schema_with = "super::template::object_schema")]
    pub object: Json,
    /// The positions of the objects: a distribution of points, or a parameter of that type; if absent, the cells with letters
    /// that the legend of the world's layout assigns to the group.
    #[serde(default = "at_letters", skip_serializing_if = "is_at_letters")]
    pub placement: Source,
    /// Name of an earlier group. This group is placed around each object of that group (co-occurrence): `count` and `placement`
    /// apply once per such object, with the origin at its position. If absent, the origin is the world's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(length(min = 1, max = 100))]
    pub around: Option<String>,
    /// With `around`: whether the placement is rotated by the heading of the object in its middle.
    #[serde(default, skip_serializing_if = "is_default")]
    pub turned: bool,
    /// The direction the objects face, overriding their template's `heading`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub facing: Option<Facing>,
    /// Minimum distance in metres to the centre of any object placed earlier.
    #[serde(default = "zero")]
    #[schemars(extend("minimum" = 0, "maximum" = 300))]
    pub separation: Number,
    /// Minimum clearances of the objects.
    #[serde(default)]
    pub keep_out: KeepOut,
}

/// Minimum clearances of a group's objects, in metres, from the object's centre to the border of a wall or region, or to the
/// centre of another object.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
#[schemars(extend("examples" = [{ "walls": 1, "agent": 4, "groups": { "houses": 8 } }]))]
pub struct KeepOut {
    /// Minimum distance to the arena's walls and to regions that cannot be entered.
    #[schemars(extend("minimum" = 0, "maximum" = 300))]
    pub walls: Number,
    /// Minimum distance to the agent's start.
    #[schemars(extend("minimum" = 0, "maximum" = 300))]
    pub agent: Number,
    /// Minimum distances to the objects of earlier groups, by the group's name.
    #[serde(skip_serializing_if = "IndexMap::is_empty")]
    #[schemars(transform = distances)]
    pub groups: IndexMap<String, Number>,
}

impl Default for KeepOut {
    fn default() -> Self {
        Self {
            walls: Number::Literal(1.0),
            agent: Number::Literal(2.0),
            groups: IndexMap::new(),
        }
    }
}

/// The direction an object faces.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(extend("examples" = [
    "random",
    { "point": [0, 0] },
    { "group": "houses" },
]))]
pub enum Facing {
    /// In a uniformly random direction.
    Random,
    /// Towards the agent's start.
    Agent,
    /// Towards the object that it is placed around.
    Middle,
    /// Towards a point in metres.
    Point([Number; 2]),
    /// Towards the nearest object of an earlier group; if that group is empty, as the template says.
    Group(#[schemars(length(min = 1, max = 100))] String),
}

fn distances(schema: &mut schemars::Schema) {
    for (key, limit) in [("minimum", 0), ("maximum", 300)] {
        if let Some(distance) = schema.get_mut("additionalProperties").and_then(Json::as_object_mut) {
            distance.insert(key.to_owned(), limit.into());
        }
    }
}

fn at_letters() -> Source {
    Source::Distribution(Box::new(Distribution::cells_of_group()))
}

fn is_at_letters(placement: &Source) -> bool {
    *placement == at_letters()
}

fn zero() -> Number {
    Number::Literal(0.0)
}
