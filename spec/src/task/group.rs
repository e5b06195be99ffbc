//! A group of objects that are made alike and placed by chance, as a spec declares it. Placing them is the generator's job.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::Value as Json;

use super::distribution::{Distribution, Number};

/// A group of objects: how many, what each is, and where they stand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Group {
    /// The group's name; its objects carry it as their `tag` unless the template gives another.
    #[schemars(length(min = 1, max = 100))]
    pub name: String,
    /// How many objects: a whole number, a parameter, or a distribution.
    #[schemars(schema_with = "super::template::count_schema")]
    pub count: Json,
    /// What each object is; any leaf may be a value, a parameter, or a distribution, which is drawn for each object.
    #[schemars(schema_with = "super::template::object_schema")]
    pub object: Json,
    /// Where they stand: box, disc, annulus, gaussian or points.
    pub placement: Distribution<Number>,
    /// Least distance in metres to the centre of any object placed before.
    #[serde(default = "zero")]
    pub separation: Number,
    /// Least distance in metres to the arena's walls and to regions that cannot be entered.
    #[serde(default = "one")]
    pub wall_margin: Number,
    /// Least distance in metres to the agent's start.
    #[serde(default = "two")]
    pub agent_margin: Number,
}

fn zero() -> Number {
    Number::Literal(0.0)
}

fn one() -> Number {
    Number::Literal(1.0)
}

fn two() -> Number {
    Number::Literal(2.0)
}
