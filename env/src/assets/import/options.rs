//! What may be asked for when a glTF file becomes a model.

use super::fit::ColliderKind;
use super::size::ImportSize;

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
