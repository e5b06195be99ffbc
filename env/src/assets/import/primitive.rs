//! Reads one primitive of a mesh from the file's accessors: corners, triangles and their colours.

use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;
use gltf_json::{Root, material, texture};

use super::accessor::Use;
use super::buffers::Buffers;
use super::coloring::Coloring;
use super::refusal::{named, refuse};
use super::texture::Textures;
use super::warning::{ImportWarning, Warnings};
use crate::EnvError;
use crate::assets::library::{MAX_MODEL_TRIANGLES, MAX_MODEL_VERTICES};

/// State of an import: the file's buffers and textures, and the warnings so far.
pub(super) struct Reading<'a, 'b> {
    pub(super) buffers: &'a Buffers<'a>,
    pub(super) textures: Textures<'a, 'b>,
    pub(super) warnings: Warnings,
}

/// Contents of a primitive, in its mesh's own frame.
pub(super) struct ReadPrimitive {
    pub(super) corners: Vec<[f32; 3]>,
    /// Three corners and a linear colour each.
    pub(super) triangles: Vec<([u32; 3], [f32; 3])>,
    pub(super) material: Option<usize>,
    pub(super) two_sided: bool,
}

impl Reading<'_, '_> {
    /// Reads a primitive; `None` for points or lines. `used` holds the numbers of vertices and triangles in the scene so far.
    pub(super) fn primitive(
        &mut self,
        primitive: &Primitive,
        place: &str,
        used: [usize; 2],
    ) -> Result<Option<ReadPrimitive>, EnvError> {
        let mode = match primitive.mode {
            Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => mode,
            Checked::Valid(_) => {
                self.warnings.insert(ImportWarning::PointsOrLines);
                return Ok(None);
            }
            Checked::Invalid => return Err(refuse(format!("{place}/mode"), "an unknown mode", "0 to 6")),
        };
        if primitive.targets.is_some() {
            self.warnings.insert(ImportWarning::MorphTargets);
        }
        let (corners, indices) = self.shape(primitive, mode, place, used)?;
        let material = material_of(self.buffers.root, primitive, place)?;
        let opaque = Checked::Valid(material::AlphaMode::Opaque);
        if material.is_some_and(|material| material.alpha_mode != opaque) {
            self.warnings.insert(ImportWarning::Transparency);
        }
        let coloring = self.coloring(primitive, material, corners.len(), place)?;
        let triangles = triangles(mode, &indices).into_iter();
        Ok(Some(ReadPrimitive {
            triangles: triangles.map(|triangle| (triangle, coloring.of(triangle))).collect(),
            corners,
            material: primitive.material.map(|material| material.value()),
            two_sided: material.is_some_and(|material| material.double_sided),
        }))
    }

    /// Positions and indices; their counts are checked before either is read.
    fn shape(
        &self,
        primitive: &Primitive,
        mode: Mode,
        place: &str,
        [vertices, triangles]: [usize; 2],
    ) -> Result<(Vec<[f32; 3]>, Vec<u32>), EnvError> {
        let here = format!("{place}/attributes/POSITION");
        let Some(&positions) = primitive.attributes.get(&Checked::Valid(Semantic::Positions)) else {
            return Err(refuse(here, "no positions", "an accessor"));
        };
        let within = |what: &str, found: usize, most: usize| {
            if found <= most {
                return Ok(());
            }
            let expected = format!("at most {most} in the whole scene");
            Err(refuse(place, format!("{found} {what} up to here"), expected))
        };
        let count = self.buffers.count(positions, Use::Positions, &here)?;
        within("vertices", vertices + count, MAX_MODEL_VERTICES)?;
        let indices_place = format!("{place}/indices");
        let num_indices = match primitive.indices {
            Some(indices) => self.buffers.count(indices, Use::Indices, &indices_place)?,
            None => count,
        };
        let more = match mode {
            Mode::Triangles => num_indices / 3,
            _ => num_indices.saturating_sub(2),
        };
        within("triangles", triangles + more, MAX_MODEL_TRIANGLES)?;
        let corners = self.buffers.vectors(positions, Use::Positions, &here)?;
        let indices = match primitive.indices {
            Some(indices) => self.buffers.indices(indices, count, &indices_place)?,
            None => (0..count as u32).collect(),
        };
        Ok((corners, indices))
    }

    /// One vector per corner, if the primitive has the attribute.
    fn attribute(
        &self,
        primitive: &Primitive,
        semantic: Semantic,
        for_use: Use,
        num_corners: usize,
        here: &str,
    ) -> Result<Vec<[f32; 3]>, EnvError> {
        let Some(&index) = primitive.attributes.get(&Checked::Valid(semantic)) else {
            return Ok(Vec::new());
        };
        let list = self.buffers.vectors(index, for_use, here)?;
        if list.len() == num_corners {
            return Ok(list);
        }
        let found = format!("{} elements", list.len());
        Err(refuse(here, found, format!("{num_corners}, as many as positions")))
    }

    fn coloring(
        &mut self,
        primitive: &Primitive,
        material: Option<&material::Material>,
        num_corners: usize,
        place: &str,
    ) -> Result<Coloring<'_>, EnvError> {
        let here = |name: &str| format!("{place}/attributes/{name}");
        let colors = self.attribute(
            primitive,
            Semantic::Colors(0),
            Use::Colors,
            num_corners,
            &here("COLOR_0"),
        )?;
        let metal = material.map(|material| &material.pbr_metallic_roughness);
        let (uvs, texture) = match metal.and_then(|metal| metal.base_color_texture.as_ref()) {
            Some(texture::Info { index, tex_coord, .. }) => {
                let (semantic, name) = (Semantic::TexCoords(*tex_coord), here(&format!("TEXCOORD_{tex_coord}")));
                let uvs = self.attribute(primitive, semantic, Use::TextureCoordinates, num_corners, &name)?;
                let number = primitive.material.map_or(0, |material| material.value());
                let from = format!("/materials/{number}/pbrMetallicRoughness/baseColorTexture/index");
                let texture = self.textures.texture(*index, &from, &mut self.warnings)?;
                if uvs.is_empty() && texture.is_some() {
                    self.warnings.insert(ImportWarning::NoTexturePlaces);
                }
                (uvs, texture)
            }
            None => (Vec::new(), None),
        };
        Ok(Coloring {
            factor: metal.map_or([1.0; 4], |metal| metal.base_color_factor.0),
            texture: texture.filter(|_| !uvs.is_empty()),
            uvs,
            colors,
        })
    }
}

/// The material of a primitive, if it has one.
fn material_of<'a>(
    root: &'a Root,
    primitive: &Primitive,
    place: &str,
) -> Result<Option<&'a material::Material>, EnvError> {
    let Some(index) = primitive.material else {
        return Ok(None);
    };
    let place = format!("{place}/material");
    let material = named(&root.materials, index.value(), "material", &place)?;
    let factor = material.pbr_metallic_roughness.base_color_factor.0;
    if !factor.iter().all(|channel| (0.0..=1.0).contains(channel)) {
        let place = format!("/materials/{}/pbrMetallicRoughness/baseColorFactor", index.value());
        return Err(refuse(place, format!("{factor:?}"), "numbers in 0..1"));
    }
    Ok(Some(material))
}

/// Triangles of a list, strip or fan, all with the same winding.
fn triangles(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => {
            let windows = indices.windows(3).enumerate();
            let oriented = |(k, window): (usize, &[u32])| match k % 2 {
                0 => [window[0], window[1], window[2]],
                _ => [window[1], window[0], window[2]],
            };
            windows.map(oriented).collect()
        }
        Mode::TriangleFan => {
            let Some((&hub, rim)) = indices.split_first() else {
                return Vec::new();
            };
            rim.windows(2).map(|pair| [hub, pair[0], pair[1]]).collect()
        }
        _ => indices
            .chunks_exact(3)
            .map(|three| [three[0], three[1], three[2]])
            .collect(),
    }
}
