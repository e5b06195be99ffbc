//! Options for importing a glTF file.

use super::refusal::refuse;
use crate::EnvError;
use crate::assets::ColliderKind;
use crate::assets::library::MAX_MODEL_REACH;

/// How to import a glTF file.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportOptions {
    /// The class by which worlds refer to it.
    pub class: String,
    /// The model's name within its class, such as "1".
    pub name: String,
    /// The model's size.
    pub size: ImportSize,
    /// The model's collider.
    pub collider: ColliderKind,
    /// Name of the material that an object's `color` replaces. By default the material named `main`, if any.
    pub main: Option<String>,
}

/// The size of a model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImportSize {
    /// Metres per unit of the file: 1 for files in metres, as glTF requires.
    Scale(f32),
    /// Height in metres.
    Height(f32),
}

impl ImportSize {
    /// Metres per unit, for a file whose model is `height` units high.
    pub(super) fn factor(self, height: f64) -> Result<f64, EnvError> {
        let (place, requested) = match self {
            Self::Scale(scale) => ("scale", f64::from(scale)),
            Self::Height(metres) => ("height", f64::from(metres)),
        };
        if !(requested > 0.0 && requested.is_finite()) {
            return Err(refuse(place, requested.to_string(), "a number above 0"));
        }
        match self {
            Self::Scale(_) => Ok(requested),
            Self::Height(_) if requested > f64::from(MAX_MODEL_REACH) => Err(refuse(
                place,
                format!("{requested} m"),
                format!("at most {MAX_MODEL_REACH} m"),
            )),
            Self::Height(_) if height > 0.0 => Ok(requested / height),
            Self::Height(_) => Err(refuse(place, "a flat model without height", "a scale instead")),
        }
    }
}
