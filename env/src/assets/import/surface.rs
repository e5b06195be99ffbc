//! Triangles with colours from a file's meshes, and the way they are stood up. Which colours are kept is decided in
//! `palette.rs`.

use gltf_json::mesh::{Mode, Primitive, Semantic};
use gltf_json::validation::Checked;
use gltf_json::{Index, Mesh, Root, material, texture};

use super::accessor::{self, Use};
use super::buffers::{Buffers, one_of};
use super::nodes::Pose;
use super::texture::{Pixels, Textures};
use super::warning::{ImportWarning, Warnings};
use super::{ImportSize, refuse};
use crate::EnvError;
use crate::assets::library::{MAX_MODEL_REACH, MAX_MODEL_TRIANGLES, MAX_MODEL_VERTICES};

/// The most primitives of all meshes, each as often as it stands in the scene.
const MAX_PRIMITIVES: usize = 100_000;

/// How a triangle is cut into places at which its texture is looked at: along each side.
const SAMPLES: usize = 5;

/// All triangles of a file.
#[derive(Default)]
pub(super) struct Surface {
    pub(super) corners: Vec<[f32; 3]>,
    pub(super) faces: Vec<Face>,
    primitives: usize,
}

/// One triangle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Face {
    pub(super) corners: [u32; 3],
    /// Number of its material, if it has one.
    pub(super) material: Option<usize>,
    pub(super) two_sided: bool,
    /// Its colour as light.
    pub(super) color: [f32; 3],
}

/// What colours the triangles of a primitive.
struct Coloring<'a> {
    factor: [f32; 4],
    pixels: Option<&'a Pixels>,
    places: Vec<[f32; 3]>,
    colors: Vec<[f32; 3]>,
}

impl Surface {
    /// Adds a mesh that stands somewhere.
    pub(super) fn add(
        &mut self,
        root: &Root,
        buffers: &Buffers,
        textures: &mut Textures,
        mesh: Index<Mesh>,
        pose: &Pose,
        warnings: &mut Warnings,
    ) -> Result<(), EnvError> {
        let index = mesh.value();
        let Some(mesh) = root.meshes.get(index) else {
            return Err(refuse("/nodes", format!("mesh {index}"), one_of(root.meshes.len())));
        };
        for (k, primitive) in mesh.primitives.iter().enumerate() {
            self.primitives += 1;
            if self.primitives > MAX_PRIMITIVES {
                let expected = format!("at most {MAX_PRIMITIVES} in the scene");
                return Err(refuse("/meshes", format!("{} primitives", self.primitives), expected));
            }
            let place = format!("/meshes/{index}/primitives/{k}");
            self.add_primitive(root, buffers, textures, primitive, pose, warnings, &place)?;
        }
        Ok(())
    }

    #[expect(clippy::too_many_arguments, reason = "a primitive refers to all parts of its file")]
    fn add_primitive(
        &mut self,
        root: &Root,
        buffers: &Buffers,
        textures: &mut Textures,
        primitive: &Primitive,
        pose: &Pose,
        warnings: &mut Warnings,
        place: &str,
    ) -> Result<(), EnvError> {
        let mode = match primitive.mode {
            Checked::Valid(mode @ (Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan)) => mode,
            Checked::Valid(_) => {
                warnings.note(ImportWarning::PointsOrLines);
                return Ok(());
            }
            Checked::Invalid => return Err(refuse(format!("{place}/mode"), "an unknown mode", "0 to 6")),
        };
        if primitive.targets.is_some() {
            warnings.note(ImportWarning::MorphTargets);
        }
        let attribute = |semantic: Semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let here = |name: &str| format!("{place}/attributes/{name}");
        let Some(positions) = attribute(Semantic::Positions) else {
            return Err(refuse(here("POSITION"), "no positions", "an accessor"));
        };
        let count = accessor::count(root, positions, Use::Positions, &here("POSITION"))?;
        let within = |what: &str, found: usize, most: usize| {
            let expected = format!("at most {most} in the whole scene");
            let found = format!("{found} {what} up to here");
            (found, expected)
        };
        if self.corners.len() + count > MAX_MODEL_VERTICES {
            let (found, expected) = within("vertices", self.corners.len() + count, MAX_MODEL_VERTICES);
            return Err(refuse(place, found, expected));
        }
        let num_indices = match primitive.indices {
            Some(indices) => accessor::count(root, indices, Use::Indices, &format!("{place}/indices"))?,
            None => count,
        };
        let num_triangles = match mode {
            Mode::Triangles => num_indices / 3,
            _ => num_indices.saturating_sub(2),
        };
        if self.faces.len() + num_triangles > MAX_MODEL_TRIANGLES {
            let (found, expected) = within("triangles", self.faces.len() + num_triangles, MAX_MODEL_TRIANGLES);
            return Err(refuse(place, found, expected));
        }
        let corners = accessor::vectors(root, buffers, positions, Use::Positions, &here("POSITION"))?;
        let indices = match primitive.indices {
            Some(indices) => accessor::indices(root, buffers, indices, count, &format!("{place}/indices"))?,
            None => (0..count as u32).collect(),
        };
        let material = material_of(root, primitive, place)?;
        note_transparency(material, warnings);
        let read_if_whole = |semantic: Semantic, name: &str, for_use: Use| match attribute(semantic) {
            Some(index) => {
                let list = accessor::vectors(root, buffers, index, for_use, &here(name))?;
                if list.len() == count {
                    return Ok(list);
                }
                let found = format!("{} elements", list.len());
                Err(refuse(here(name), found, format!("{count}, as many as positions")))
            }
            None => Ok(Vec::new()),
        };
        let colors = read_if_whole(Semantic::Colors(0), "COLOR_0", Use::Colors)?;
        let info = material.and_then(|material| material.pbr_metallic_roughness.base_color_texture.as_ref());
        let (places, pixels) = match info {
            Some(texture::Info { index, tex_coord, .. }) => {
                let name = format!("TEXCOORD_{tex_coord}");
                let places = read_if_whole(Semantic::TexCoords(*tex_coord), &name, Use::TexturePlaces)?;
                (places, textures.pixels(*index, "/materials", warnings)?)
            }
            None => (Vec::new(), None),
        };
        let coloring = Coloring {
            factor: material.map_or([1.0; 4], |material| material.pbr_metallic_roughness.base_color_factor.0),
            pixels: pixels.filter(|_| !places.is_empty()),
            places,
            colors,
        };
        let first = self.corners.len() as u32;
        for corner in corners {
            let [x, y, z] = pose.apply(corner);
            // glTF's up is ours, its front is our north: its x points west.
            let corner = [-x, z, y].map(|metres| metres as f32);
            if !corner.iter().all(|metres| metres.abs() < 1e9) {
                return Err(refuse(place, format!("a corner at {corner:?}"), "numbers below 1e9"));
            }
            self.corners.push(corner);
        }
        for mut triangle in triangles(mode, &indices) {
            let color = coloring.of(triangle);
            if pose.mirrors() {
                triangle.swap(1, 2);
            }
            let corners = triangle.map(|corner| corner + first);
            if self.area(corners) > 0.0 {
                self.faces.push(Face {
                    corners,
                    material: primitive.material.map(|material| material.value()),
                    two_sided: material.is_some_and(|material| material.double_sided),
                    color,
                });
            }
        }
        Ok(())
    }

    /// A triangle's area.
    pub(super) fn area(&self, corners: [u32; 3]) -> f64 {
        let [a, b, c] = corners.map(|corner| self.corners[corner as usize].map(f64::from));
        let (u, v) = ([0, 1, 2].map(|k| b[k] - a[k]), [0, 1, 2].map(|k| c[k] - a[k]));
        let cross = [
            u[1] * v[2] - u[2] * v[1],
            u[2] * v[0] - u[0] * v[2],
            u[0] * v[1] - u[1] * v[0],
        ];
        cross.iter().map(|part| part * part).sum::<f64>().sqrt() / 2.0
    }

    /// Brings everything to its size, centred above the origin, with its lowest corner on the ground.
    pub(super) fn stand(&mut self, size: ImportSize) -> Result<(), EnvError> {
        if self.faces.is_empty() {
            let expected = "at least one triangle with an area";
            return Err(refuse("scene", "nothing to draw", expected));
        }
        let used = || self.faces.iter().flat_map(|face| face.corners);
        let mut low = [f64::INFINITY; 3];
        let mut high = [f64::NEG_INFINITY; 3];
        for corner in used() {
            for axis in 0..3 {
                let metres = f64::from(self.corners[corner as usize][axis]);
                (low[axis], high[axis]) = (low[axis].min(metres), high[axis].max(metres));
            }
        }
        let factor = size.factor(high[2] - low[2])?;
        let reach = (0..3).map(|axis| (high[axis] - low[axis]) * factor).fold(0.0, f64::max);
        if !(0.001..=f64::from(MAX_MODEL_REACH)).contains(&reach) {
            let expected = format!("0.001 to {MAX_MODEL_REACH} m; give another scale or height");
            return Err(refuse("model", format!("a size of {reach:.6} m"), expected));
        }
        let middle = [f64::midpoint(low[0], high[0]), f64::midpoint(low[1], high[1]), low[2]];
        for corner in &mut self.corners {
            for axis in 0..3 {
                corner[axis] = ((f64::from(corner[axis]) - middle[axis]) * factor) as f32;
            }
        }
        Ok(())
    }
}

fn material_of<'a>(
    root: &'a Root,
    primitive: &Primitive,
    place: &str,
) -> Result<Option<&'a material::Material>, EnvError> {
    let Some(index) = primitive.material else {
        return Ok(None);
    };
    let Some(material) = root.materials.get(index.value()) else {
        let found = format!("material {}", index.value());
        return Err(refuse(format!("{place}/material"), found, one_of(root.materials.len())));
    };
    let factor = material.pbr_metallic_roughness.base_color_factor.0;
    if !factor.iter().all(|channel| (0.0..=1.0).contains(channel)) {
        let place = format!("/materials/{}/pbrMetallicRoughness/baseColorFactor", index.value());
        return Err(refuse(place, format!("{factor:?}"), "numbers in 0..1"));
    }
    Ok(Some(material))
}

fn note_transparency(material: Option<&material::Material>, warnings: &mut Warnings) {
    let opaque = Checked::Valid(material::AlphaMode::Opaque);
    if material.is_some_and(|material| material.alpha_mode != opaque) {
        warnings.note(ImportWarning::Transparency);
    }
}

/// Triangles from a list, a strip or a fan of corners, all wound the same way.
fn triangles(mode: Mode, indices: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        Mode::TriangleStrip => {
            let windows = indices.windows(3).enumerate();
            let turned = |(k, window): (usize, &[u32])| match k % 2 {
                0 => [window[0], window[1], window[2]],
                _ => [window[1], window[0], window[2]],
            };
            windows.map(turned).collect()
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

impl Coloring<'_> {
    /// The mean light of a triangle: its material's, its texture's and its corners' multiplied.
    fn of(&self, triangle: [u32; 3]) -> [f32; 3] {
        let [r, g, b, _] = self.factor;
        let factor = [r, g, b];
        if self.pixels.is_none() && self.colors.is_empty() {
            return factor;
        }
        let (mut sum, mut weights) = ([0.0; 3], 0.0);
        for (i, j) in (0..SAMPLES).flat_map(|i| (0..SAMPLES - i).map(move |j| (i, j))) {
            // The middles of places along both sides, so that no sample lies on an edge.
            let share = |k: usize| (k as f32 + 1.0 / 3.0) / SAMPLES as f32;
            let at = [1.0 - share(i) - share(j), share(i), share(j)];
            let mean = |list: &[[f32; 3]]| {
                let mut mean = [0.0; 3];
                for (corner, share) in triangle.iter().zip(at) {
                    let value = list.get(*corner as usize).copied().unwrap_or([1.0; 3]);
                    (0..3).for_each(|k| mean[k] += share * value[k]);
                }
                mean
            };
            let [r, g, b, weight] = self.pixels.map_or([1.0; 4], |pixels| {
                let [u, v, _] = mean(&self.places);
                pixels.at([u, v])
            });
            let corner = if self.colors.is_empty() {
                [1.0; 3]
            } else {
                mean(&self.colors)
            };
            weights += weight;
            for (sum, (light, own)) in sum.iter_mut().zip([r, g, b].into_iter().zip(corner)) {
                *sum += weight * light * own.clamp(0.0, 1.0);
            }
        }
        if weights <= 0.0 {
            return factor;
        }
        [0, 1, 2].map(|k| factor[k] * sum[k] / weights)
    }
}
