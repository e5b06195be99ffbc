//! Atlases: textures with many tiles side by side, and buffers for reading them back.

use super::device::Device;
use super::pipelines::{DEPTH_FORMAT, WORD_FORMAT};

/// Bytes per pixel in each texture.
const BYTES: u32 = 4;

/// Alignment in pixels of rows that are copied from a texture.
const ROW_ALIGNMENT: u32 = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT / BYTES;

/// Maximum number of pixels in a pass, unless a single tile has more.
const MAX_PASS_PIXELS: u32 = 1 << 24;

/// The images that a pass reads back.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Planes {
    /// Colour, with labels.
    pub(super) words: bool,
    pub(super) depth: bool,
    pub(super) items: bool,
}

/// Arrangement of tiles of one size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Grid {
    /// Width and height of a tile in pixels.
    pub(super) tile: [u32; 2],
    pub(super) columns: u32,
    pub(super) rows: u32,
}

impl Grid {
    /// A nearly square grid for up to `count` tiles, on a device with textures of at most `max_side` pixels per side; `None` if
    /// not even one tile fits.
    pub(super) fn new(tile: [u32; 2], count: usize, max_side: u32) -> Option<Self> {
        let [width, height] = tile;
        // Textures are padded to aligned rows.
        let max_columns = max_side / ROW_ALIGNMENT * ROW_ALIGNMENT / width.max(1);
        let max_rows = max_side / height.max(1);
        if max_columns == 0 || max_rows == 0 {
            return None;
        }
        let count = u32::try_from(rounded(count))
            .unwrap_or(u32::MAX)
            .min((MAX_PASS_PIXELS / (width * height)).max(1))
            .min(max_columns.saturating_mul(max_rows));
        let square = (f64::from(count) * f64::from(height) / f64::from(width)).sqrt().ceil() as u32;
        let columns = square.max(count.div_ceil(max_rows)).clamp(1, max_columns).min(count);
        let rows = count.div_ceil(columns);
        Some(Self { tile, columns, rows })
    }

    /// Maximum number of tiles.
    pub(super) fn capacity(self) -> usize {
        self.columns as usize * self.rows as usize
    }

    /// The upper left corner of a tile in pixels.
    pub(super) fn corner(self, number: usize) -> [u32; 2] {
        let number = number as u32;
        [
            number % self.columns * self.tile[0],
            number / self.columns * self.tile[1],
        ]
    }

    /// Width and height in pixels; the width is padded to aligned rows.
    fn size(self) -> [u32; 2] {
        let width = (self.columns * self.tile[0]).next_multiple_of(ROW_ALIGNMENT);
        [width, self.rows * self.tile[1]]
    }
}

/// Rounds up the number of tiles, so that passes with similar counts share textures.
fn rounded(count: usize) -> usize {
    count.next_multiple_of((count.next_power_of_two() / 8).max(1))
}

/// Maximum number of cached atlases, and of pixels in all of them together.
const MAX_CACHED: (usize, u64) = (16, 1 << 25);

/// Cached atlases of several sizes. Depths can only be copied from whole textures, so each grid needs its own atlas.
#[derive(Debug, Default)]
pub(super) struct Atlases(pub(super) Vec<Atlas>);

impl Atlases {
    /// Takes an atlas for this grid, or creates one.
    pub(super) fn take(&mut self, device: &Device, grid: Grid, planes: Planes) -> Atlas {
        let fits = |atlas: &Atlas| {
            let room = atlas.back.size() >= bytes_back(grid, planes);
            atlas.size == grid.size() && room && (atlas.items.is_some() || !planes.items)
        };
        if let Some(index) = self.0.iter().position(fits) {
            return self.0.remove(index);
        }
        let pixels = |size: [u32; 2]| u64::from(size[0]) * u64::from(size[1]);
        let (max_atlases, max_pixels) = MAX_CACHED;
        let mut total = pixels(grid.size());
        // Evicts the oldest first.
        let kept = self.0.iter().rev().take(max_atlases - 1).take_while(|atlas| {
            total += pixels(atlas.size);
            total <= max_pixels
        });
        let count = kept.count();
        self.0.drain(..self.0.len() - count);
        Atlas::new(device, grid, planes)
    }
}

/// Textures, and the buffer to which they are copied.
#[derive(Debug)]
pub(super) struct Atlas {
    /// Width and height in pixels.
    pub(super) size: [u32; 2],
    words: wgpu::Texture,
    depth: wgpu::Texture,
    items: Option<wgpu::Texture>,
    pub(super) back: wgpu::Buffer,
}

impl Atlas {
    fn new(device: &Device, grid: Grid, planes: Planes) -> Self {
        let [width, height] = grid.size();
        let texture = |label, format| {
            device.card.create_texture(&wgpu::TextureDescriptor {
                label: Some(label),
                size: extent(width, height),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
                view_formats: &[],
            })
        };
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        Self {
            size: [width, height],
            words: texture("words", WORD_FORMAT),
            depth: texture("depth", DEPTH_FORMAT),
            items: planes.items.then(|| texture("items", WORD_FORMAT)),
            back: device.buffer("images", bytes_back(grid, planes), usage),
        }
    }

    /// Begins a pass over the whole atlas.
    pub(super) fn begin<'a>(&self, encoder: &'a mut wgpu::CommandEncoder, planes: Planes) -> wgpu::RenderPass<'a> {
        let view = |texture: &wgpu::Texture| texture.create_view(&wgpu::TextureViewDescriptor::default());
        let words = view(&self.words);
        let items = self.items.as_ref().filter(|_| planes.items).map(view);
        let depth = view(&self.depth);
        let mut colors = vec![Some(attachment(&words))];
        colors.extend(items.as_ref().map(|items| Some(attachment(items))));
        encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("tiles"),
            color_attachments: &colors,
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &depth,
                depth_ops: Some(wgpu::Operations {
                    load: wgpu::LoadOp::Clear(0.0),
                    store: if planes.depth {
                        wgpu::StoreOp::Store
                    } else {
                        wgpu::StoreOp::Discard
                    },
                }),
                stencil_ops: None,
            }),
            ..Default::default()
        })
    }

    /// Copies the images into the buffer; returns their offsets.
    pub(super) fn copy_back(&self, encoder: &mut wgpu::CommandEncoder, grid: Grid, planes: Planes) -> Layout {
        let [width, height] = grid.size();
        let mut layout = Layout {
            row: (width * BYTES) as usize,
            ..Layout::default()
        };
        let mut offset = 0;
        let mut copy = |texture: &wgpu::Texture, aspect| {
            let start = offset;
            encoder.copy_texture_to_buffer(
                wgpu::TexelCopyTextureInfo {
                    texture,
                    mip_level: 0,
                    origin: wgpu::Origin3d::ZERO,
                    aspect,
                },
                wgpu::TexelCopyBufferInfo {
                    buffer: &self.back,
                    layout: wgpu::TexelCopyBufferLayout {
                        offset,
                        bytes_per_row: Some(width * BYTES),
                        rows_per_image: None,
                    },
                },
                extent(width, height),
            );
            offset += plane_bytes(grid);
            Some(start as usize)
        };
        if planes.words {
            layout.words = copy(&self.words, wgpu::TextureAspect::All);
        }
        if planes.depth {
            layout.depth = copy(&self.depth, wgpu::TextureAspect::DepthOnly);
        }
        if let (true, Some(items)) = (planes.items, &self.items) {
            layout.items = copy(items, wgpu::TextureAspect::All);
        }
        layout.end = offset;
        layout
    }
}

/// Offsets of the images in the buffer, in bytes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Layout {
    /// Bytes per row.
    pub(super) row: usize,
    pub(super) words: Option<usize>,
    pub(super) depth: Option<usize>,
    pub(super) items: Option<usize>,
    pub(super) end: u64,
}

fn plane_bytes(grid: Grid) -> u64 {
    let [width, height] = grid.size();
    u64::from(width) * u64::from(height) * u64::from(BYTES)
}

/// Bytes that a pass reads back.
pub(super) fn bytes_back(grid: Grid, planes: Planes) -> u64 {
    let count = [planes.words, planes.depth, planes.items]
        .into_iter()
        .filter(|wanted| *wanted);
    plane_bytes(grid) * count.count() as u64
}

fn extent(width: u32, height: u32) -> wgpu::Extent3d {
    wgpu::Extent3d {
        width,
        height,
        depth_or_array_layers: 1,
    }
}

fn attachment(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            store: wgpu::StoreOp::Store,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(tile: [u32; 2], count: usize, max_side: u32, expected: Option<[u32; 2]>) {
        let found = Grid::new(tile, count, max_side).map(|grid| [grid.columns, grid.rows]);
        assert_eq!(found, expected, "{count} tiles of {tile:?} in at most {max_side}");
    }

    #[test]
    fn grid_is_square_as_far_as_textures_allow() {
        check([84, 84], 1, 8192, Some([1, 1]));
        check([84, 84], 64, 8192, Some([8, 8]));
        check([84, 84], 65, 8192, Some([9, 9]));
        check([160, 40], 64, 8192, Some([4, 16]));
        check([4096, 1], 8, 8192, Some([1, 8]));
        check([84, 84], 64, 200, Some([2, 2]));
        check([84, 1000], 9, 2048, Some([10, 1]));
        check([300, 2], 1000, 1100, Some([3, 342]));
        check([8192, 8192], 3, 8192, Some([1, 1]));
        check([8193, 1], 1, 8192, None);
        check([1, 8193], 1, 8192, None);
        check([84, 84], 1_000_000, 16_384, Some([49, 49]));
    }

    #[test]
    fn corners_follow_row_order() {
        let grid = Grid::new([10, 20], 8, 4096).expect("the tiles fit");
        assert_eq!([grid.columns, grid.rows], [4, 2]);
        assert_eq!(grid.corner(5), [10, 20]);
        assert_eq!(grid.size(), [64, 40]);
    }
}
