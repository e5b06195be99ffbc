//! [`Spread`] and [`Order`]: how widely the points of a distribution are spread, and in which order objects take them.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The standard deviation of a normal distribution in the plane.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a number, or [x, y]")]
#[schemars(rename = "Spread")]
pub enum Spread<N = f64> {
    /// The same along both axes.
    Round(N),
    /// Along x and along y.
    Axes([N; 2]),
}

/// The order in which objects take the points of a list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Order {
    /// The first object takes the first point, and so on, starting over after the last; if a point is not free, the object
    /// takes the next free one.
    #[default]
    Turn,
    /// Each object takes a random point.
    Random,
}
