//! What triangles are filled into: depth and packed pixel of each place. Where triangles come from is in `raster.rs`,
//! what becomes of them in `compose.rs`.

use super::lanes::{Lanes, MOST_LANES};

/// Buffers of one picture, kept from picture to picture. Rows are padded to whole vectors.
#[derive(Clone, Debug, Default)]
pub(super) struct Canvas {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Pixels from one row to the next.
    pub(super) stride: usize,
    /// 1 / depth; 0 is infinitely far.
    pub(super) inverse_depth: Vec<f32>,
    /// Colour in the lower three bytes, red lowest; a label in the highest. Counts where something was drawn.
    pub(super) pixels: Vec<u32>,
    /// Number of the item plus 1, where that is asked for.
    pub(super) items: Vec<u32>,
}

/// A triangle on the screen, ready to be filled. Pixel centres have whole coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    /// For each edge `c + a·x + b·y`, which is not negative inside: c, a, b.
    pub(super) edges: [[f32; 3]; 3],
    /// 1 / depth as `c + a·x + b·y`: c, a, b.
    pub(super) inverse_depth: [f32; 3],
    /// First and last column.
    pub(super) columns: [usize; 2],
    /// First and last row.
    pub(super) rows: [usize; 2],
    /// Its colour and label, as in [`Canvas::pixels`].
    pub(super) pixel: u32,
    pub(super) item: u32,
}

impl Canvas {
    /// Empties the canvas, at this size.
    pub(super) fn clear(&mut self, width: usize, height: usize, with_items: bool) {
        let stride = width.next_multiple_of(MOST_LANES);
        let pixels = stride * height;
        (self.width, self.height, self.stride) = (width, height, stride);
        self.inverse_depth.clear();
        self.inverse_depth.resize(pixels, 0.0);
        // What lies in these from before is never read: depth says where something was drawn.
        self.pixels.resize(pixels, 0);
        self.items.resize(if with_items { pixels } else { 0 }, 0);
    }

    /// Draws a triangle where nothing nearer is.
    ///
    /// All numbers of a pixel depend on its place and the triangle's first row alone, whatever the number of lanes.
    #[inline(always)]
    pub(super) fn fill<L: Lanes, const ITEMS: bool>(&mut self, lanes: L, triangle: &Triangle) {
        let Triangle { columns, rows, .. } = *triangle;
        let zero = lanes.splat(0.0);
        let packed = lanes.splat_word(triangle.pixel);
        let item = lanes.splat_word(triangle.item);
        let top = rows[0] as f32;
        let last_start = self.stride - L::N;
        let mut start = columns[0].min(last_start);
        loop {
            let x = lanes.add(lanes.count_up(), lanes.splat(start as f32));
            let mut e0 = at_top(lanes, triangle.edges[0], x, top);
            let mut e1 = at_top(lanes, triangle.edges[1], x, top);
            let mut e2 = at_top(lanes, triangle.edges[2], x, top);
            let mut inverse = at_top(lanes, triangle.inverse_depth, x, top);
            let d0 = lanes.splat(triangle.edges[0][2]);
            let d1 = lanes.splat(triangle.edges[1][2]);
            let d2 = lanes.splat(triangle.edges[2][2]);
            let down = lanes.splat(triangle.inverse_depth[2]);
            let mut pixel = rows[0] * self.stride + start;
            for _ in rows[0]..=rows[1] {
                let depths = &mut self.inverse_depth[pixel..pixel + L::N];
                let inside = lanes.at_least(lanes.min(e0, lanes.min(e1, e2)), zero);
                let taken = lanes.both(inside, lanes.above(inverse, lanes.load(depths)));
                lanes.store_where(taken, inverse, depths);
                lanes.store_words_where(taken, packed, &mut self.pixels[pixel..pixel + L::N]);
                if ITEMS {
                    lanes.store_words_where(taken, item, &mut self.items[pixel..pixel + L::N]);
                }
                (e0, e1, e2) = (lanes.add(e0, d0), lanes.add(e1, d1), lanes.add(e2, d2));
                inverse = lanes.add(inverse, down);
                pixel += self.stride;
            }
            start += L::N;
            if start > columns[1] {
                return;
            }
            start = start.min(last_start);
        }
    }
}

/// `c + a·x + b·y` in one row.
#[inline(always)]
fn at_top<L: Lanes>(lanes: L, [c, a, b]: [f32; 3], x: L::Float, y: f32) -> L::Float {
    lanes.mul_add(lanes.splat(a), x, lanes.splat(c + b * y))
}
