//! The agent's camera: kinds of image, their size, and the field of view. Its keys are in `agent.rs`.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Default vertical field of view in degrees.
pub(super) const DEFAULT_FIELD_OF_VIEW: f64 = 60.0;

/// One kind of image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Modality {
    /// Colour, `(size, size, 3)` bytes.
    Rgb,
    /// Distance along the view axis in metres, `(size, size)` floats.
    Depth,
    /// Reward category per pixel, `(size, size)` bytes.
    Segmentation,
    /// Object class per pixel, `(size, size)` numbers that are the same in every world: built-in classes have 1 to 29, unknown
    /// classes 31, and classes of libraries follow from 32 on in the order of their names; 0 where there is no object.
    Class,
    /// Object per pixel, `(size, size)` numbers: its index in the world plus 1; 0 where there is no object.
    Instance,
}
