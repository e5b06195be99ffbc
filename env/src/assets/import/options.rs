//! What may be asked for when a glTF file becomes a model.

use super::fit::ColliderKind;
use super::refusal::refuse;
use crate::EnvError;
use crate::assets::library::MAX_MODEL_REACH;

/// How a glTF file becomes a model.
#[derive(Clone, Debug, PartialEq)]
pub struct ImportOptions {
    /// The class that worlds refer to it by.
    pub class: String,
    /// The model's name within its class, such as "1".
    pub name: String,
    /// How large it becomes.
    pub size: ImportSize,
    /// What the agent bumps into.
    pub collider: ColliderKind,
    /// Name of the material whose colour gives way to an object's `color`. Without it, the material named `main`, if
    /// any.
    pub main: Option<String>,
}

/// How large a model becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ImportSize {
    /// So many metres for each unit of the file: 1 where the file is in metres, as glTF asks for.
    Scale(f32),
    /// So high in metres.
    Height(f32),
}

impl ImportSize {
    /// Metres for each unit of a file in which the model is `height` units high.
    pub(super) fn factor(self, height: f64) -> Result<f64, EnvError> {
        let (place, asked) = match self {
            Self::Scale(scale) => ("scale", f64::from(scale)),
            Self::Height(metres) => ("height", f64::from(metres)),
        };
        if !(asked > 0.0 && asked.is_finite()) {
            return Err(refuse(place, asked.to_string(), "a number above 0"));
        }
        match self {
            Self::Scale(_) => Ok(asked),
            Self::Height(_) if asked > f64::from(MAX_MODEL_REACH) => Err(refuse(
                place,
                format!("{asked} m"),
                format!("at most {MAX_MODEL_REACH} m"),
            )),
            Self::Height(_) if height > 0.0 => Ok(asked / height),
            Self::Height(_) => Err(refuse(place, "a flat model, of no height", "a scale in its place")),
        }
    }
}
