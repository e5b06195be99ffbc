//! Collects the coloured triangles of a file's scene, and scales and places them.

use gltf_json::{Index, Mesh};

use super::nodes::Pose;
use super::options::ImportSize;
use super::primitive::{ReadPrimitive, Reading};
use super::refusal::{named, refuse};
use crate::EnvError;
use crate::assets::library::MAX_MODEL_REACH;
use crate::vector::cross;

/// Maximum number of primitives in the scene, counting each instance of a mesh.
const MAX_PRIMITIVES: usize = 100_000;

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
    /// Index of its material, if it has one.
    pub(super) material: Option<usize>,
    pub(super) two_sided: bool,
    /// Its linear colour.
    pub(super) color: [f32; 3],
}

impl Surface {
    /// Adds an instance of a mesh; `node` is the path of its node.
    pub(super) fn add(
        &mut self,
        reading: &mut Reading,
        mesh: Index<Mesh>,
        pose: &Pose,
        node: &str,
    ) -> Result<(), EnvError> {
        let index = mesh.value();
        let mesh = named(&reading.buffers.root.meshes, index, "mesh", &format!("{node}/mesh"))?;
        for (k, primitive) in mesh.primitives.iter().enumerate() {
            self.primitives += 1;
            if self.primitives > MAX_PRIMITIVES {
                let expected = format!("at most {MAX_PRIMITIVES} in the scene");
                return Err(refuse("/meshes", format!("{} primitives", self.primitives), expected));
            }
            let place = format!("/meshes/{index}/primitives/{k}");
            let used = [self.corners.len(), self.faces.len()];
            if let Some(part) = reading.primitive(primitive, &place, used)? {
                self.add_primitive(&part, pose, &place)?;
            }
        }
        Ok(())
    }

    fn add_primitive(&mut self, part: &ReadPrimitive, pose: &Pose, place: &str) -> Result<(), EnvError> {
        let first = self.corners.len() as u32;
        for corner in &part.corners {
            let [x, y, z] = pose.apply(*corner);
            // Converts axes: glTF's up (+y) is our +z, its front (+z) our +y (north), and its +x our −x (west).
            let corner = [-x, z, y].map(|metres| metres as f32);
            if !corner.iter().all(|metres| metres.abs() < 1e9) {
                return Err(refuse(place, format!("a corner at {corner:?}"), "numbers below 1e9"));
            }
            self.corners.push(corner);
        }
        let mirrors = pose.mirrors();
        for &([a, b, c], color) in &part.triangles {
            let oriented = if mirrors { [a, c, b] } else { [a, b, c] };
            let corners = oriented.map(|corner| corner + first);
            if self.area(corners) > 0.0 {
                self.faces.push(Face {
                    corners,
                    material: part.material,
                    two_sided: part.two_sided,
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
        cross(u, v).iter().map(|part| part * part).sum::<f64>().sqrt() / 2.0
    }

    /// Scales everything to the given size and centres it above the origin, with its lowest corner on the ground.
    pub(super) fn place_on_ground(&mut self, size: ImportSize) -> Result<(), EnvError> {
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
