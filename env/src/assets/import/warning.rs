//! Warnings about features of glTF files that models do not support.

use std::collections::BTreeSet;

use gltf_json::Root;

/// A feature of a glTF file that was left out of the model.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, strum::Display)]
#[non_exhaustive]
pub enum ImportWarning {
    /// Animations: models do not move.
    #[strum(to_string = "/animations: left out; models do not move")]
    Animations,
    /// Skins: models with bones keep their rest shape.
    #[strum(to_string = "/skins: left out; the model keeps its rest shape")]
    Skins,
    /// Morph targets: the undeformed shape is drawn.
    #[strum(to_string = "/meshes: morph targets are left out")]
    MorphTargets,
    /// Points and lines.
    #[strum(to_string = "/meshes: points and lines are left out")]
    PointsOrLines,
    /// Transparent surfaces: they are drawn opaque.
    #[strum(to_string = "/materials: transparent surfaces are drawn solid")]
    Transparency,
    /// A texture in a format other than PNG: the material keeps its plain colour.
    #[strum(
        to_string = "/images/{image}: {found} is not supported, so its materials keep their plain colour; convert it to PNG to see it"
    )]
    TextureFormat {
        /// Index of the image in the file.
        image: usize,
        /// Its format.
        found: String,
    },
    /// A texture without an image, or with one that only an extension refers to: the material keeps its plain colour.
    #[strum(
        to_string = "/textures/{texture}: it refers to no image, so its materials keep their plain colour; export it as PNG to see it"
    )]
    TextureWithoutImage {
        /// Index of the texture in the file.
        texture: usize,
    },
    /// Textured surfaces without texture coordinates: the material keeps its plain colour.
    #[strum(
        to_string = "/meshes: textured surfaces without the texture coordinates that their material requires keep its plain colour"
    )]
    NoTexturePlaces,
    /// Textures transformed by `KHR_texture_transform`: the transform is ignored.
    #[strum(
        to_string = "/extensionsUsed: KHR_texture_transform is left out; textures that it moves or scales will show different colours"
    )]
    TextureTransform,
}

/// Collected warnings, each once.
pub(super) type Warnings = BTreeSet<ImportWarning>;

/// Warnings about features that are never read.
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
    let present = kinds.into_iter().filter(|(_, is_present)| *is_present);
    present.map(|(kind, _)| kind).collect()
}
