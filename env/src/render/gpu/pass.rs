//! One pass: tiles of one size drawn into an atlas and brought back. Which tiles go together is decided in `mod.rs`;
//! what their bytes become, in `unpack.rs`.

use std::ops::Range;
use std::sync::{Arc, OnceLock};

use super::super::natural::MATERIALS;
use super::atlas::{Atlas, Atlases, Grid, Layout, Planes, attachment};
use super::device::Device;
use super::instances::{InstanceWords, Instances, TileContents, WORDS};
use super::library::{Library, Mesh};
use super::natural::{PATCH, ROW};
use super::pipelines::{Kind, Pipelines};
use super::texels::Texels;
use super::tile::{QUADS, Quad};
use crate::EnvError;

/// Everything that passes need, kept from one to the next.
#[derive(Debug)]
pub(super) struct Stage {
    pipelines: Pipelines,
    library: Library,
    atlases: Atlases,
    tiles: Growing,
    instances: Growing,
    sizes: wgpu::Buffer,
    /// What only the natural style needs.
    rows: Growing,
    patches: Growing,
    texels: Texels,
    /// Instances of all tiles, those of one mesh together.
    sorted: Vec<InstanceWords>,
    tile_words: Vec<Quad>,
    row_words: Vec<[u32; ROW]>,
    patch_words: Vec<[u32; PATCH]>,
    draws: Draws,
    numbers: Vec<u32>,
    counts: Vec<u32>,
}

/// Instances of one mesh, drawn together; all inside one tile if triangles cannot be cut at tiles' edges.
#[derive(Clone, Debug)]
struct Draw {
    mesh: Mesh,
    instances: Range<u32>,
    tile: usize,
}

/// What is drawn: objects, and what casts shadows.
#[derive(Debug, Default)]
struct Draws {
    objects: Vec<Draw>,
    shadows: Vec<Draw>,
}

/// A buffer that is replaced by a larger one when it must hold more.
#[derive(Debug)]
struct Growing {
    label: &'static str,
    usage: wgpu::BufferUsages,
    buffer: Option<wgpu::Buffer>,
}

impl Growing {
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
            let roomy = needed.next_power_of_two();
            let most = device.limits.max_buffer_size;
            let most = if usage.contains(wgpu::BufferUsages::STORAGE) {
                most.min(device.limits.max_storage_buffer_binding_size)
            } else {
                most
            };
            device.buffer(label, roomy.min(most).max(needed), usage)
        });
        if !bytes.is_empty() {
            device.queue.write_buffer(buffer, 0, bytes);
        }
        buffer
    }
}

/// Tiles that go together.
pub(super) struct Pass<'a> {
    pub(super) grid: Grid,
    pub(super) planes: Planes,
    pub(super) natural: bool,
    pub(super) fog: bool,
    pub(super) contents: &'a mut [TileContents],
}

impl Stage {
    pub(super) fn new(device: &Device) -> Self {
        Self {
            pipelines: Pipelines::new(device),
            library: Library::new(),
            atlases: Atlases::default(),
            tiles: Growing::new("tiles", wgpu::BufferUsages::STORAGE),
            instances: Growing::new("instances", wgpu::BufferUsages::VERTEX),
            sizes: device.buffer("atlas", 16, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST),
            rows: Growing::new("rows", wgpu::BufferUsages::STORAGE),
            patches: Growing::new("patches", wgpu::BufferUsages::STORAGE),
            texels: Texels::default(),
            sorted: Vec::new(),
            tile_words: Vec::new(),
            row_words: Vec::new(),
            patch_words: Vec::new(),
            draws: Draws::default(),
            numbers: Vec::new(),
            counts: Vec::new(),
        }
    }

    /// Draws the tiles, and hands their bytes to `take`.
    ///
    /// # Errors
    /// [`EnvError::Gpu`] for whatever the device complains about; what was kept for the next pass is dropped then.
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
            self.rows.buffer = None;
            self.patches.buffer = None;
            self.texels = Texels::default();
            self.library = Library::new();
        }
        outcome
    }

    fn try_run(&mut self, device: &Device, pass: Pass<'_>, take: impl FnOnce(&[u8], Layout)) -> Result<(), EnvError> {
        let Pass {
            grid,
            planes,
            natural,
            fog,
            contents,
        } = pass;
        self.library.make_room();
        self.tile_words.clear();
        for (number, content) in contents.iter_mut().enumerate() {
            content.place(number as u32, grid.corner(number));
            self.tile_words.extend(&content.tile);
        }
        self.sort(contents, device.has_clip_distances);
        let most_patches = self.gather_natural(contents, natural);
        let atlas = self.atlases.take(device, grid, planes, natural);
        let scale = atlas.size().map(|pixels| 2.0 / pixels as f32);
        let sizes = [scale[0].to_bits(), scale[1].to_bits(), most_patches, 0];
        device.queue.write_buffer(&self.sizes, 0, bytemuck::cast_slice(&sizes));
        let tiles = self
            .tiles
            .write(device, bytemuck::cast_slice(self.tile_words.as_flattened()));
        let instances = self
            .instances
            .write(device, bytemuck::cast_slice(self.sorted.as_flattened()));
        let vertices = self.library.upload(device);
        let items = planes.items;
        let (program, pair) = self.pipelines.program(device, Kind { items, fog, natural });
        let mut buffers = vec![tiles.as_entire_binding(), self.sizes.as_entire_binding()];
        if natural {
            let needed = contents
                .iter()
                .fold(0, |needed, content| needed | content.natural.needed);
            let rows = self
                .rows
                .write(device, bytemuck::cast_slice(self.row_words.as_flattened()));
            let patches = self
                .patches
                .write(device, bytemuck::cast_slice(self.patch_words.as_flattened()));
            let texels = self.texels.upload(device, needed);
            buffers.extend([rows, patches, texels].map(wgpu::Buffer::as_entire_binding));
        }
        let main_group = bind_group(device, &program.bindings, buffers);
        let mut encoder = device
            .card
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        // Where triangles cannot be cut at tiles' edges, draws are.
        let scissors = (!device.has_clip_distances).then_some(grid);
        let shadows = program.of_shadows.as_ref().zip(atlas.shadows());
        if let Some((of_shadows, view)) = &shadows {
            let mut render = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("shadows"),
                color_attachments: &[Some(attachment(view))],
                ..Default::default()
            });
            render.set_bind_group(0, &main_group, &[]);
            render.set_pipeline(&of_shadows.pipeline);
            render.set_vertex_buffer(0, vertices.slice(..));
            render.set_vertex_buffer(1, instances.slice(..));
            draw_all(&mut render, &self.draws.shadows, scissors);
        }
        let shadows = shadows.map(|(of_shadows, view)| {
            let view = wgpu::BindingResource::TextureView(&view);
            bind_group(device, &of_shadows.bindings, vec![view])
        });
        {
            let mut render = atlas.begin(&mut encoder, planes);
            render.set_bind_group(0, &main_group, &[]);
            if let Some(shadows) = &shadows {
                render.set_bind_group(1, shadows, &[]);
            }
            render.set_pipeline(&pair.backdrop);
            render.draw(0..6, 0..contents.len() as u32);
            render.set_pipeline(&pair.objects);
            render.set_vertex_buffer(0, vertices.slice(..));
            render.set_vertex_buffer(1, instances.slice(..));
            draw_all(&mut render, &self.draws.objects, scissors);
        }
        let layout = atlas.copy_back(&mut encoder, grid, planes);
        device.queue.submit([encoder.finish()]);
        device.check()?;
        read(device, &atlas, layout, take)?;
        device.check()?;
        self.atlases.put_back(atlas);
        Ok(())
    }

    /// Puts rows and patches of all tiles together: as many patches for each as the one with the most has. Returns how many.
    fn gather_natural(&mut self, contents: &[TileContents], natural: bool) -> u32 {
        self.row_words.clear();
        self.patch_words.clear();
        if !natural {
            return 0;
        }
        let most = contents.iter().map(|content| content.natural.patches.len()).max();
        let most = most.unwrap_or(0);
        for content in contents {
            self.row_words.extend(&content.natural.rows);
            self.patch_words.extend(&content.natural.patches);
            let filled = self.patch_words.len().next_multiple_of(most.max(1));
            self.patch_words.resize(filled, [0; PATCH]);
        }
        most as u32
    }

    /// Puts instances of one mesh together: of all tiles, or of each tile where each is drawn by itself.
    fn sort(&mut self, contents: &[TileContents], all_together: bool) {
        self.sorted.clear();
        let mut draws = std::mem::take(&mut self.draws);
        draws.objects.clear();
        draws.shadows.clear();
        let length = if all_together { contents.len().max(1) } else { 1 };
        for (number, part) in contents.chunks(length).enumerate() {
            self.sort_part(part, |content| &content.objects, number, &mut draws.objects);
            self.sort_part(part, |content| &content.shadows, number, &mut draws.shadows);
        }
        self.draws = draws;
    }

    /// A counting sort: numbers of meshes are small.
    fn sort_part(
        &mut self,
        contents: &[TileContents],
        which: impl Fn(&TileContents) -> &Instances,
        first_tile: usize,
        draws: &mut Vec<Draw>,
    ) {
        self.numbers.clear();
        for shape in contents.iter().flat_map(|content| &which(content).shapes) {
            self.numbers.push(self.library.number(shape));
        }
        self.counts.clear();
        self.counts.resize(self.library.num_meshes(), 0);
        for number in &self.numbers {
            self.counts[*number as usize] += 1;
        }
        let mut start = self.sorted.len() as u32;
        for (number, count) in (0..).zip(&mut self.counts) {
            let instances = start..start + *count;
            // From here on it counts where the next instance goes.
            *count = start;
            start = instances.end;
            if !instances.is_empty() {
                draws.push(Draw {
                    mesh: self.library.mesh(number),
                    instances,
                    tile: first_tile,
                });
            }
        }
        self.sorted.resize(start as usize, [0; WORDS]);
        let instances = contents.iter().flat_map(|content| &which(content).words);
        for (instance, number) in instances.zip(&self.numbers) {
            let place = &mut self.counts[*number as usize];
            self.sorted[*place as usize] = *instance;
            *place += 1;
        }
    }
}

fn draw_all(render: &mut wgpu::RenderPass<'_>, draws: &[Draw], scissors: Option<Grid>) {
    for draw in draws {
        if let Some(grid) = scissors {
            let [x, y] = grid.corner(draw.tile);
            render.set_scissor_rect(x, y, grid.tile[0], grid.tile[1]);
        }
        render.draw(draw.mesh.clone(), draw.instances.clone());
    }
}

/// What shaders read, each at the number of its place.
fn bind_group(
    device: &Device,
    layout: &wgpu::BindGroupLayout,
    resources: Vec<wgpu::BindingResource<'_>>,
) -> wgpu::BindGroup {
    let entries: Vec<_> = (0..)
        .zip(resources)
        .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
        .collect();
    device.card.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("what shaders read"),
        layout,
        entries: &entries,
    })
}

/// The most tiles of this height, and the most instances, that this device takes in one pass.
pub(super) fn most_in_a_pass(limits: &wgpu::Limits, height: u32) -> [usize; 2] {
    let storage = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    // Of the buffers with something for each tile, that of rows is the largest, or that of patches.
    let rows = u64::from(height) * (ROW * size_of::<u32>()) as u64;
    let tile = rows
        .max((QUADS * 16) as u64)
        .max(u64::from(MATERIALS) * (PATCH * size_of::<u32>()) as u64);
    let instance = (WORDS * size_of::<u32>()) as u64;
    [storage / tile, limits.max_buffer_size / instance].map(|most| usize::try_from(most).unwrap_or(usize::MAX))
}

/// Waits for the images and hands them over.
fn read(device: &Device, atlas: &Atlas, layout: Layout, take: impl FnOnce(&[u8], Layout)) -> Result<(), EnvError> {
    let failed = |reason: &dyn std::fmt::Display| {
        let known = device.check();
        known
            .err()
            .unwrap_or_else(|| device.failed(format!("the images did not come back: {reason}")))
    };
    let done = Arc::new(OnceLock::new());
    let noted = Arc::clone(&done);
    atlas
        .back()
        .map_async(wgpu::MapMode::Read, ..layout.end, move |outcome| {
            // Called once.
            let _ = noted.set(outcome);
        });
    let waited = device.card.poll(wgpu::PollType::wait_indefinitely());
    waited.map_err(|error| failed(&error))?;
    match done.get() {
        Some(Ok(())) => {}
        Some(Err(error)) => return Err(failed(error)),
        None => return Err(failed(&"the device does not answer")),
    }
    {
        let bytes = atlas.back().get_mapped_range(..layout.end);
        let bytes = bytes.map_err(|error| failed(&error))?;
        take(&bytes, layout);
    }
    atlas.back().unmap();
    Ok(())
}
