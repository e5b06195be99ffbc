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
    /// A texture without an image, or with one that only an extension names: the material's plain colour is taken.
    TextureWithoutImage {
        /// Number of the texture in the file.
        texture: usize,
    },
    /// Textured surfaces that do not say where on the texture their corners are: the material's plain colour is taken.
    NoTexturePlaces,
    /// Textures that are moved, turned or scaled by `KHR_texture_transform`: they are taken as they are.
    TextureTransform,
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
            Self::TextureWithoutImage { texture } => write!(
                f,
                "/textures/{texture}: it names no image; its materials keep their plain colour, or export it as PNG"
            ),
            Self::NoTexturePlaces => f.write_str(
                "/meshes: textured surfaces without the texture coordinates that their material asks for keep its plain colour",
            ),
            Self::TextureTransform => f.write_str(
                "/extensionsUsed: KHR_texture_transform is left out; textures that it moves or scales give other colours",
            ),
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
        if root.extensions_used.iter().any(|name| name == "KHR_texture_transform") {
            self.note(ImportWarning::TextureTransform);
        }
    }

    pub(super) fn into_list(self) -> Vec<ImportWarning> {
        self.0.into_iter().collect()
    }
}
