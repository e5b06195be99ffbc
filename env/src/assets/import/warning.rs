//! What of a glTF file a model cannot keep.

use std::collections::BTreeSet;
use std::fmt;

use gltf_json::Root;

/// Something in a glTF file that is left out of the model.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum ImportWarning {
    /// Animations: models do not move.
    Animations,
    /// Skins: what has bones is drawn as it was modelled, without them.
    Skins,
    /// Morph targets: the undeformed shape is drawn.
    MorphTargets,
    /// Points and lines.
    PointsOrLines,
    /// Surfaces that light comes through: they are drawn as if it did not.
    Transparency,
    /// A texture in a format other than PNG: the material's plain colour is taken.
    TextureFormat {
        /// Number of the image in the file.
        image: usize,
        /// What it is.
        found: String,
    },
}

impl fmt::Display for ImportWarning {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Animations => f.write_str("/animations: left out; models do not move"),
            Self::Skins => f.write_str("/skins: left out; the model stands as it does without bones"),
            Self::MorphTargets => f.write_str("/meshes: morph targets are left out"),
            Self::PointsOrLines => f.write_str("/meshes: points and lines are left out"),
            Self::Transparency => f.write_str("/materials: transparent surfaces are drawn solid"),
            Self::TextureFormat { image, found } => {
                write!(
                    f,
                    "/images/{image}: {found} is not read; its materials keep their plain colour, or convert it to PNG"
                )
            }
        }
    }
}

/// Warnings on their way out, each once.
#[derive(Default)]
pub(super) struct Warnings(BTreeSet<ImportWarning>);

impl Warnings {
    pub(super) fn note(&mut self, warning: ImportWarning) {
        self.0.insert(warning);
    }

    /// Notes what is never read.
    pub(super) fn note_left_out(&mut self, root: &Root) {
        if !root.animations.is_empty() {
            self.note(ImportWarning::Animations);
        }
        if !root.skins.is_empty() {
            self.note(ImportWarning::Skins);
        }
    }

    pub(super) fn into_list(self) -> Vec<ImportWarning> {
        self.0.into_iter().collect()
    }
}
