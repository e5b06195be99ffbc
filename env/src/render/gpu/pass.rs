//! Runs one pass: draws tiles of one size into an atlas and reads them back.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use super::atlas::{Atlas, Atlases, Grid, Layout, Planes};
use super::device::Device;
use super::instances::{InstanceWords, TileContents, WORDS};
use super::library::{Library, Mesh};
use super::pipelines::{Kind, Pipelines};
use super::tile::{QUADS, TileWords};
use crate::EnvError;

/// Buffers and pipelines shared by passes.
#[derive(Debug)]
pub(super) struct Stage {
    pipelines: Pipelines,
    library: Library,
    atlases: Atlases,
    tiles: GrowingBuffer,
    instances: GrowingBuffer,
    sizes: wgpu::Buffer,
    /// Instances of all tiles, grouped by mesh.
    sorted: Vec<InstanceWords>,
    tile_words: Vec<TileWords>,
    draws: Vec<Draw>,
    numbers: Vec<u32>,
    counts: Vec<u32>,
}

/// Instances of one mesh, drawn together; of a single tile if triangles cannot be clipped at tiles' edges.
#[derive(Clone, Debug)]
struct Draw {
    mesh: Mesh,
    instances: Range<u32>,
    tile: usize,
}

/// A buffer that is replaced by a larger one when necessary.
#[derive(Debug)]
struct GrowingBuffer {
    label: &'static str,
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
}

impl GrowingBuffer {
    fn new(label: &'static str, usage: wgpu::BufferUsages) -> Self {
        Self {
            label,
            usage: usage | wgpu::BufferUsages::COPY_DST,
            buffer: None,
        }
    }

    fn write(&mut self, device: &Device, bytes: &[u8]) -> &wgpu::Buffer {
        let needed = (bytes.len() as u64).max(256);
        let (label, usage) = (self.label, self.usage);
        self.buffer.take_if(|buffer| buffer.size() < needed);
        let buffer = self.buffer.get_or_insert_with(|| {
            let preferred = needed.next_power_of_two();
            let max = device.limits.max_buffer_size;
            let max = if usage.contains(wgpu::BufferUsages::STORAGE) {
                max.min(device.limits.max_storage_buffer_binding_size)
            } else {
                max
            };
            device.buffer(label, preferred.min(max).max(needed), usage)
        });
        if !bytes.is_empty() {
            device.queue.write_buffer(buffer, 0, bytes);
        }
        buffer
    }
}

/// Tiles to draw together.
pub(super) struct Pass<'a> {
    pub(super) grid: Grid,
    pub(super) planes: Planes,
    pub(super) fog: bool,
    pub(super) contents: &'a mut [TileContents],
}

impl Stage {
    pub(super) fn new(device: &Device) -> Self {
        Self {
            pipelines: Pipelines::new(device),
            library: Library::new(),
            atlases: Atlases::default(),
            tiles: GrowingBuffer::new("tiles", wgpu::BufferUsages::STORAGE),
            instances: GrowingBuffer::new("instances", wgpu::BufferUsages::VERTEX),
            sizes: device.buffer("atlas", 16, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST),
            sorted: Vec::new(),
            tile_words: Vec::new(),
            draws: Vec::new(),
            numbers: Vec::new(),
            counts: Vec::new(),
        }
    }

    /// Draws the tiles, and passes the bytes of their images to `take`.
    ///
    /// # Errors
    /// [`EnvError::Gpu`] for any error of the device; the cached buffers are dropped then.
    pub(super) fn run(
        &mut self,
        device: &Device,
        pass: Pass<'_>,
        take: impl FnOnce(&[u8], Layout),
    ) -> Result<(), EnvError> {
        let outcome = self.try_run(device, pass, take);
        if outcome.is_err() {
            self.atlases = Atlases::default();
            self.tiles.buffer = None;
            self.instances.buffer = None;
            self.library = Library::new();
        }
        outcome
    }

    fn try_run(&mut self, device: &Device, pass: Pass<'_>, take: impl FnOnce(&[u8], Layout)) -> Result<(), EnvError> {
        let Pass {
            grid,
            planes,
            fog,
            contents,
        } = pass;
        self.library.make_room();
        self.tile_words.clear();
        for (number, content) in contents.iter_mut().enumerate() {
            content.place(number as u32, grid.corner(number));
            self.tile_words.push(content.tile);
        }
        self.sort(contents, device.has_clip_distances);
        let atlas = self.atlases.take(device, grid, planes);
        let scale = atlas.size.map(|pixels| 2.0 / pixels as f32);
        device
            .queue
            .write_buffer(&self.sizes, 0, bytemuck::cast_slice(&[scale[0], scale[1], 0.0, 0.0]));
        let words: &[u32] = self.tile_words.as_flattened().as_flattened();
        let tiles = self.tiles.write(device, bytemuck::cast_slice(words));
        let instances = self
            .instances
            .write(device, bytemuck::cast_slice(self.sorted.as_flattened()));
        let vertices = self.library.upload(device);
        let bind_group = device.card.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("tiles and atlas"),
            layout: &self.pipelines.bindings,
            entries: &[
                wgpu::BindGroupEntry {
                    binding: 0,
                    resource: tiles.as_entire_binding(),
                },
                wgpu::BindGroupEntry {
                    binding: 1,
                    resource: self.sizes.as_entire_binding(),
                },
            ],
        });
        let items = planes.items;
        let pipelines = self.pipelines.pair(device, Kind { items, fog });
        let mut encoder = device
            .card
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut render = atlas.begin(&mut encoder, planes);
            render.set_bind_group(0, &bind_group, &[]);
            render.set_pipeline(&pipelines.backdrop);
            render.draw(0..6, 0..self.tile_words.len() as u32);
            render.set_pipeline(&pipelines.objects);
            render.set_vertex_buffer(0, vertices.slice(..));
            render.set_vertex_buffer(1, instances.slice(..));
            for draw in &self.draws {
                if !device.has_clip_distances {
                    let [x, y] = grid.corner(draw.tile);
                    render.set_scissor_rect(x, y, grid.tile[0], grid.tile[1]);
                }
                render.draw(draw.mesh.clone(), draw.instances.clone());
            }
        }
        let layout = atlas.copy_back(&mut encoder, grid, planes);
        device.queue.submit([encoder.finish()]);
        device.check()?;
        read(device, &atlas, layout, take)?;
        device.check()?;
        self.atlases.0.push(atlas);
        Ok(())
    }

    /// Groups instances by mesh: over all tiles, or within each tile if tiles are drawn separately.
    fn sort(&mut self, contents: &[TileContents], all_together: bool) {
        self.draws.clear();
        self.sorted.clear();
        if all_together {
            self.sort_part(contents, 0);
        } else {
            for (number, content) in contents.iter().enumerate() {
                self.sort_part(std::slice::from_ref(content), number);
            }
        }
    }

    /// Sorts by counting, since mesh indices are small.
    fn sort_part(&mut self, contents: &[TileContents], first_tile: usize) {
        self.numbers.clear();
        for shape in contents.iter().flat_map(|content| &content.shapes) {
            self.numbers.push(self.library.number(shape));
        }
        self.counts.clear();
        self.counts.resize(self.library.meshes.len(), 0);
        for number in &self.numbers {
            self.counts[*number as usize] += 1;
        }
        let mut start = self.sorted.len() as u32;
        for (number, count) in self.counts.iter_mut().enumerate() {
            let instances = start..start + *count;
            // From here on, holds the position of the next instance.
            *count = start;
            start = instances.end;
            if !instances.is_empty() {
                self.draws.push(Draw {
                    mesh: self.library.meshes[number].clone(),
                    instances,
                    tile: first_tile,
                });
            }
        }
        self.sorted.resize(start as usize, [0; WORDS]);
        let instances = contents.iter().flat_map(|content| &content.instances);
        for (instance, number) in instances.zip(&self.numbers) {
            let next = &mut self.counts[*number as usize];
            self.sorted[*next as usize] = *instance;
            *next += 1;
        }
    }
}

/// Maximum number of tiles and of instances per pass on this device.
pub(super) fn pass_limits(limits: &wgpu::Limits) -> [usize; 2] {
    let storage = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    let tile = (QUADS * 16) as u64;
    let instance = (WORDS * size_of::<u32>()) as u64;
    [storage / tile, limits.max_buffer_size / instance].map(|max| usize::try_from(max).unwrap_or(usize::MAX))
}

/// Waits for the images and passes them to `take`.
fn read(device: &Device, atlas: &Atlas, layout: Layout, take: impl FnOnce(&[u8], Layout)) -> Result<(), EnvError> {
    let failed = |reason: &dyn std::fmt::Display| {
        let known = device.check();
        known
            .err()
            .unwrap_or_else(|| device.failed(format!("the images did not come back: {reason}")))
    };
    let done = Arc::new(OnceLock::new());
    let result = Arc::clone(&done);
    atlas.back.map_async(wgpu::MapMode::Read, ..layout.end, move |outcome| {
        // The callback runs once, so the cell is still empty.
        let _ = result.set(outcome);
    });
    let waited = device.card.poll(wgpu::PollType::wait_indefinitely());
    waited.map_err(|error| failed(&error))?;
    match done.get() {
        Some(Ok(())) => {}
        Some(Err(error)) => return Err(failed(error)),
        None => return Err(failed(&"the device did not respond")),
    }
    {
        let bytes = atlas.back.get_mapped_range(..layout.end);
        let bytes = bytes.map_err(|error| failed(&error))?;
        take(&bytes, layout);
    }
    atlas.back.unmap();
    Ok(())
}
