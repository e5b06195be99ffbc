//! [`Region`]: a polygon on the ground, and the points inside it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::fields::{Field, FieldPlace, Place};
use crate::value::{ParameterType, Value};

/// A polygon on the ground: corners in metres, in order; the last corner connects to the first. It may touch itself.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Region(
    #[schemars(length(min = 3, max = 1000), inner(inner(range(min = -1e4, max = 1e4))))] pub Vec<[f64; 2]>,
);

impl Place for Region {
    fn find_inside(words: &[&str], steps: &mut Vec<usize>) -> Option<ParameterType> {
        Vec::<[f64; 2]>::find_inside(words, steps)
    }

    fn set_inside(&mut self, steps: &[usize], value: &Value) -> Option<()> {
        self.0.set_inside(steps, value)
    }

    fn list_inside(pointer: &str, field: &Field, found: &mut Vec<FieldPlace>) {
        Vec::<[f64; 2]>::list_inside(pointer, field, found);
    }
}

/// Whether a point is inside a polygon, by the even-odd rule.
pub(super) fn encloses(corners: &[[f64; 2]], [x, y]: [f64; 2]) -> bool {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let crossed = edges.filter(|(a, b)| {
        let is_across = (a[1] > y) != (b[1] > y);
        is_across && x < (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]) + a[0]
    });
    crossed.count() % 2 == 1
}
