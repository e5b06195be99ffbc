//! What of a glTF file a model cannot keep.

use std::collections::BTreeSet;

use gltf_json::Root;

/// Something in a glTF file that is left out of the model.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, strum::Display)]
#[non_exhaustive]
pub enum ImportWarning {
    /// Animations: models do not move.
    #[strum(to_string = "/animations: left out; models do not move")]
    Animations,
    /// Skins: what has bones is drawn as it was modelled, without them.
    #[strum(to_string = "/skins: left out; the model stands as it does without bones")]
    Skins,
    /// Morph targets: the undeformed shape is drawn.
    #[strum(to_string = "/meshes: morph targets are left out")]
    MorphTargets,
    /// Points and lines.
    #[strum(to_string = "/meshes: points and lines are left out")]
    PointsOrLines,
    /// Surfaces that light comes through: they are drawn as if it did not.
    #[strum(to_string = "/materials: transparent surfaces are drawn solid")]
    Transparency,
    /// A texture in a format other than PNG: the material's plain colour is taken.
    #[strum(
        to_string = "/images/{image}: {found} is not read; its materials keep their plain colour, or convert it to PNG"
    )]
    TextureFormat {
        /// Number of the image in the file.
        image: usize,
        /// What it is.
        found: String,
    },
    /// A texture without an image, or with one that only an extension names: the material's plain colour is taken.
    #[strum(
        to_string = "/textures/{texture}: it names no image; its materials keep their plain colour, or export it as PNG"
    )]
    TextureWithoutImage {
        /// Number of the texture in the file.
        texture: usize,
    },
    /// Textured surfaces that do not say where on the texture their corners are: the material's plain colour is taken.
    #[strum(
        to_string = "/meshes: textured surfaces without the texture coordinates that their material asks for keep its plain colour"
    )]
    NoTexturePlaces,
    /// Textures that are moved, turned or scaled by `KHR_texture_transform`: they are taken as they are.
    #[strum(
        to_string = "/extensionsUsed: KHR_texture_transform is left out; textures that it moves or scales give other colours"
    )]
    TextureTransform,
}

/// Warnings on their way out, each once.
pub(super) type Warnings = BTreeSet<ImportWarning>;

/// What of a file is never read.
pub(super) fn left_out(root: &Root) -> Warnings {
    let transforms = |name: &String| name == "KHR_texture_transform";
    let kinds = [
        (ImportWarning::Animations, !root.animations.is_empty()),
        (ImportWarning::Skins, !root.skins.is_empty()),
        (
            ImportWarning::TextureTransform,
            root.extensions_used.iter().any(transforms),
        ),
    ];
    let there = kinds.into_iter().filter(|(_, is_there)| *is_there);
    there.map(|(kind, _)| kind).collect()
}
