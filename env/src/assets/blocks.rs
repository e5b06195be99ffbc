//! Meshes for the CPU renderer: blocks of triangles, with one array per coordinate.

use super::asset::{Paint, Part};
use super::mesh::Mesh;

/// Triangles in a block: the number of lanes of the renderer's widest vectors.
pub(crate) const BLOCK: usize = 16;

/// Up to [`BLOCK`] triangles of one colour that face about the same way. Unused lanes never face the camera.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(crate) struct Block {
    /// x, y, z of the first corner, then of the second and the third, in metres in the object's frame.
    pub(crate) corners: [[f32; BLOCK]; 9],
    /// x, y, z of the normals of length 1.
    pub(crate) normal: [[f32; BLOCK]; 3],
    /// Distance of the triangles' planes from the origin along their normals.
    pub(crate) offset: [f32; BLOCK],
}

/// Blocks of one colour.
#[derive(Clone, Debug)]
pub(crate) struct Material {
    pub(crate) paint: Paint,
    pub(crate) blocks: Vec<Block>,
}

impl Material {
    /// Groups a part's triangles by direction, so that whole blocks can be skipped when they face away.
    pub(crate) fn new(part: &Part) -> Self {
        let mut order: Vec<usize> = (0..part.mesh.triangles.len()).collect();
        order.sort_by_cached_key(|&triangle| facing(part.normals[triangle]));
        let blocks = order
            .chunks(BLOCK)
            .map(|triangles| block(&part.mesh, &part.normals, triangles))
            .collect();
        Self {
            paint: part.paint,
            blocks,
        }
    }
}

/// A number for the direction of a normal: 0 for down, 1 to 25 around the horizon, 100 for up.
fn facing([x, y, z]: [f32; 3]) -> u32 {
    if z.abs() > 0.7 {
        return if z < 0.0 { 0 } else { 100 };
    }
    let around = (libm::atan2f(y, x) / std::f32::consts::TAU + 0.5) * 24.0;
    1 + around as u32
}

fn block(mesh: &Mesh, normals: &[[f32; 3]], triangles: &[usize]) -> Block {
    let mut block = Block {
        corners: [[0.0; BLOCK]; 9],
        normal: [[0.0; BLOCK]; 3],
        // Unused lanes have a zero normal and a plane that always faces away.
        offset: [1.0; BLOCK],
    };
    for (lane, &triangle) in triangles.iter().enumerate() {
        let corners = mesh.triangles[triangle].map(|corner| mesh.corners[corner as usize]);
        let normal = normals[triangle];
        for (k, row) in block.corners.iter_mut().enumerate() {
            row[lane] = corners[k / 3][k % 3];
        }
        for (row, part) in block.normal.iter_mut().zip(normal) {
            row[lane] = part;
        }
        block.offset[lane] = (0..3).map(|axis| normal[axis] * corners[0][axis]).sum();
    }
    block
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_triangle_is_in_one_block_and_unused_lanes_face_away() {
        let part = Part::new(Mesh::ball(1.0, 1.0, 9, 5), Paint::Fixed([1.0; 3]));
        let material = Material::new(&part);
        assert_eq!(material.blocks.len(), part.mesh.triangles.len().div_ceil(BLOCK));
        let lanes = |block: &Block| -> Vec<[f32; 3]> {
            (0..BLOCK)
                .map(|lane| [0, 1, 2].map(|axis| block.normal[axis][lane]))
                .collect()
        };
        let used = material
            .blocks
            .iter()
            .flat_map(lanes)
            .filter(|normal| *normal != [0.0; 3])
            .count();
        assert_eq!(used, part.mesh.triangles.len());
        let last = &material.blocks[material.blocks.len() - 1];
        assert!(last.offset[BLOCK - 1] > 0.0 || last.normal.map(|row| row[BLOCK - 1]) != [0.0; 3]);
    }
}
