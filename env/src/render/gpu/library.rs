//! Caches the triangles of all assets on the GPU.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use super::device::Device;
use super::instances::{Shape, corners, normal, triangles};
use crate::assets::{Asset, Material, Paint};

/// Numbers per vertex: position, normal, colour, and whether the object's colour replaces it.
pub(super) const VERTEX_LENGTH: usize = 10;

/// Number of vertices, 160 MiB, above which the cache is cleared, so that an endless series of new assets cannot fill the
/// memory.
const MAX_VERTICES: usize = 1 << 22;

/// Range of an asset's triangles among all vertices.
pub(super) type Mesh = Range<u32>;

/// All meshes, starting with the triangle of [`Shape::Triangle`].
#[derive(Debug, Default)]
pub(super) struct Library {
    pub(super) meshes: Vec<Mesh>,
    /// Indices of meshes, by the address of their materials.
    mesh_of_materials: HashMap<usize, u32>,
    /// Keeps the assets alive, so that addresses are not reused.
    assets: Vec<Arc<Asset>>,
    vertices: Vec<f32>,
    buffer: Option<wgpu::Buffer>,
    /// Number of vertices already in the buffer.
    uploaded: usize,
}

impl Library {
    pub(super) fn new() -> Self {
        let mut library = Self::default();
        for corner in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]] {
            library.vertices.extend(corner);
            // A vertical face with its instance's colour.
            library.vertices.extend([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        }
        library.meshes.push(0..3);
        library
    }

    /// Clears the cache if it is too large, which invalidates all mesh indices.
    pub(super) fn make_room(&mut self) {
        if self.vertices.len() / VERTEX_LENGTH > MAX_VERTICES {
            *self = Self::new();
        }
    }

    /// The index of a shape's mesh; adds the mesh if it is new.
    pub(super) fn number(&mut self, shape: &Shape) -> u32 {
        let Shape::Asset(asset, address) = shape else { return 0 };
        if let Some(&number) = self.mesh_of_materials.get(address) {
            return number;
        }
        let number = self.meshes.len() as u32;
        let first = self.num_vertices();
        let level = asset
            .materials_of_levels()
            .find(|materials| materials.as_ptr().addr() == *address);
        for material in level.unwrap_or_default() {
            self.add(material);
        }
        self.meshes.push(first..self.num_vertices());
        self.mesh_of_materials.insert(*address, number);
        self.assets.push(Arc::clone(asset));
        number
    }

    fn num_vertices(&self) -> u32 {
        (self.vertices.len() / VERTEX_LENGTH) as u32
    }

    fn add(&mut self, material: &Material) {
        let ([r, g, b], is_main) = match material.paint {
            Paint::Main(own) => (own, 1.0),
            Paint::Fixed(color) => (color, 0.0),
        };
        for (block, lane) in material.blocks.iter().flat_map(triangles) {
            for corner in corners(block, lane) {
                self.vertices.extend(corner);
                self.vertices.extend(normal(block, lane));
                self.vertices.extend([r, g, b, is_main]);
            }
        }
    }

    /// The vertex buffer, after uploading new vertices.
    pub(super) fn upload(&mut self, device: &Device) -> &wgpu::Buffer {
        let length = self.vertices.len();
        let bytes = bytemuck::cast_slice(&self.vertices);
        if self.uploaded < length
            && let Some(buffer) = &self.buffer
            && buffer.size() >= bytes.len() as u64
        {
            let from = self.uploaded * size_of::<f32>();
            device.queue.write_buffer(buffer, from as u64, &bytes[from..]);
            self.uploaded = length;
        }
        if self.uploaded < length {
            self.buffer = None;
        }
        self.uploaded = length;
        self.buffer.get_or_insert_with(|| {
            let usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST;
            // Twice the size needed, so that the next few assets fit as well.
            let needed = bytes.len() as u64;
            let size = (2 * needed).min(device.limits.max_buffer_size).max(needed);
            let buffer = device.buffer("vertices", size, usage);
            device.queue.write_buffer(&buffer, 0, bytes);
            buffer
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assets::asset;
    use driftworld_spec::Model;

    #[test]
    fn asset_is_cached_once_with_all_its_triangles() {
        let mut library = Library::new();
        let asset = asset("tree", &Model::default());
        let materials = asset.level(0.0);
        let shape = Shape::Asset(Arc::clone(&asset), materials.as_ptr().addr());
        let number = library.number(&shape);
        assert_eq!((number, library.number(&shape), library.meshes.len()), (1, 1, 2));
        let triangles: usize = asset.parts.iter().map(|part| part.mesh.triangles.len()).sum();
        assert_eq!(library.meshes[number as usize], 3..3 + 3 * triangles as u32);
        assert_eq!(library.number(&Shape::Triangle), 0);
    }
}
