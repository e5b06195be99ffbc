//! The canvas into which triangles are rasterised: the depth and the packed pixel of each position.

use super::lanes::{Lanes, MAX_LANES};

/// Buffers of one image, reused between images. Rows are padded to whole vectors.
#[derive(Clone, Debug, Default)]
pub(super) struct Canvas {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Offset from one row to the next, in pixels.
    pub(super) stride: usize,
    /// 1 / depth; 0 means infinitely far.
    pub(super) inverse_depth: Aligned<f32>,
    /// Colour in the lower three bytes, red lowest; a label in the highest. Valid only where something was drawn.
    pub(super) pixels: Aligned<u32>,
    /// Index of the item plus 1, if requested.
    pub(super) items: Aligned<u32>,
}

/// A screen-space triangle, ready to be filled. Pixel centres have integer coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Triangle {
    /// For each edge, c, a and b of `c + a·x + b·y`, which is not negative inside.
    pub(super) edges: [[f32; 3]; 3],
    /// c, a and b of 1 / depth as `c + a·x + b·y`.
    pub(super) inverse_depth: [f32; 3],
    /// First and last column.
    pub(super) columns: [usize; 2],
    /// First and last row.
    pub(super) rows: [usize; 2],
    /// Its colour and label, as in [`Canvas::pixels`].
    pub(super) pixel: u32,
    pub(super) item: u32,
}

/// A pattern that modifies a triangle's pixels.
pub(super) trait Texture: Copy {
    /// The packed pixels with the pattern applied, at these columns of a row, for 1 / depth.
    fn apply<L: Lanes>(self, l: L, mask: L::Mask, packed: L::Word, at: (usize, L::Float), inverse: L::Float)
    -> L::Word;
}

/// No pattern.
impl Texture for () {
    #[inline(always)]
    fn apply<L: Lanes>(self, _: L, _: L::Mask, packed: L::Word, _: (usize, L::Float), _: L::Float) -> L::Word {
        packed
    }
}

impl Canvas {
    /// Clears the canvas and sets its size.
    pub(super) fn clear(&mut self, width: usize, height: usize, with_items: bool) {
        let stride = width.next_multiple_of(MAX_LANES);
        let pixels = stride * height;
        (self.width, self.height, self.stride) = (width, height, stride);
        self.inverse_depth.resize(pixels);
        self.inverse_depth.fill(0.0);
        // The old contents are never read: depth marks where something was drawn.
        self.pixels.resize(pixels);
        self.items.resize(if with_items { pixels } else { 0 });
    }

    /// Draws a triangle, with a depth test.
    ///
    /// A pixel's values depend only on its position and on the triangle's first row, not on the number of lanes.
    #[inline(always)]
    pub(super) fn fill<L: Lanes, const ITEMS: bool>(&mut self, lanes: L, triangle: &Triangle, texture: impl Texture) {
        let Triangle { columns, rows, .. } = *triangle;
        let zero = lanes.splat(0.0);
        let packed = lanes.splat_word(triangle.pixel);
        let item = lanes.splat_word(triangle.item);
        let top = rows[0] as f32;
        let stride = self.stride;
        let (depths, pixels, items) = (&mut *self.inverse_depth, &mut *self.pixels, &mut *self.items);
        let last_start = stride - L::N;
        let reach = (rows[1] - rows[0] >= MIN_TALL_ROWS).then(|| Reach::of(triangle));
        let mut start = columns[0].min(last_start);
        loop {
            let [first, last] = match &reach {
                Some(reach) => reach.rows(start as f32, (start + L::N - 1) as f32, rows),
                None => rows,
            };
            let x = lanes.add(lanes.count_up(), lanes.splat(start as f32));
            let mut e0 = lanes.add(
                at_top(lanes, triangle.edges[0], x, top),
                column_mask(lanes, start, columns),
            );
            let mut e1 = at_top(lanes, triangle.edges[1], x, top);
            let mut e2 = at_top(lanes, triangle.edges[2], x, top);
            let mut inverse = at_top(lanes, triangle.inverse_depth, x, top);
            let d0 = lanes.splat(triangle.edges[0][2]);
            let d1 = lanes.splat(triangle.edges[1][2]);
            let d2 = lanes.splat(triangle.edges[2][2]);
            let down = lanes.splat(triangle.inverse_depth[2]);
            for _ in rows[0]..first {
                (e0, e1, e2) = (lanes.add(e0, d0), lanes.add(e1, d1), lanes.add(e2, d2));
                inverse = lanes.add(inverse, down);
            }
            let mut pixel = first * stride + start;
            for row in first..=last {
                let depths = &mut depths[pixel..pixel + L::N];
                let inside = lanes.at_least(lanes.min(e0, lanes.min(e1, e2)), zero);
                let mask = lanes.both(inside, lanes.above(inverse, lanes.load(depths)));
                lanes.store_where(mask, inverse, depths);
                let word = texture.apply(lanes, mask, packed, (row, x), inverse);
                lanes.store_words_where(mask, word, &mut pixels[pixel..pixel + L::N]);
                if ITEMS {
                    lanes.store_words_where(mask, item, &mut items[pixel..pixel + L::N]);
                }
                (e0, e1, e2) = (lanes.add(e0, d0), lanes.add(e1, d1), lanes.add(e2, d2));
                inverse = lanes.add(inverse, down);
                pixel += stride;
            }
            start += L::N;
            if start > columns[1] {
                return;
            }
            start = start.min(last_start);
        }
    }
}

/// Minimum height in rows of triangles for which finding the rows that they reach in a few columns saves time.
const MIN_TALL_ROWS: usize = 12;

/// Computes the rows that a triangle reaches in some columns. Despite rounding, it never leaves any out.
struct Reach {
    edges: [[f32; 3]; 3],
    /// 1 / the change of each edge function per row.
    per_row: [f32; 3],
    /// Maximum rounding error of each edge function.
    max_error: [f32; 3],
}

impl Reach {
    fn of(triangle: &Triangle) -> Self {
        let Triangle {
            edges, columns, rows, ..
        } = *triangle;
        let count = (rows[1] - rows[0] + 8) as f32;
        Self {
            edges,
            per_row: edges.map(|edge| 1.0 / edge[2]),
            max_error: edges.map(|[c, a, b]| {
                let largest = c.abs() + a.abs() * (columns[1] + MAX_LANES) as f32 + b.abs() * rows[1] as f32;
                largest * count * f32::EPSILON
            }),
        }
    }

    fn rows(&self, left: f32, right: f32, rows: [usize; 2]) -> [usize; 2] {
        let [mut first, mut last] = rows.map(|row| row as f32);
        for k in 0..3 {
            let [c, a, b] = self.edges[k];
            let max = c + (a * left).max(a * right) + self.max_error[k];
            let zero = -max * self.per_row[k];
            if b > 0.0 {
                first = first.max(zero - 1.0);
            } else if b < 0.0 {
                last = last.min(zero + 1.0);
            }
        }
        // Always visits at least one row, which costs little.
        let first = (first as usize).min(rows[1]);
        [first, (last.max(0.0) as usize).clamp(first, rows[1])]
    }
}

/// A buffer whose first element is aligned to a cache line, so that no vector crosses a line. A clone is aligned only after it
/// is resized.
#[derive(Clone, Debug, Default)]
pub(super) struct Aligned<T> {
    numbers: Vec<T>,
    start: usize,
    length: usize,
}

/// Bytes of a cache line.
const LINE: usize = 64;

impl<T: Copy + Default> Aligned<T> {
    /// Sets the length. The contents are unspecified afterwards.
    fn resize(&mut self, length: usize) {
        let slack = LINE / size_of::<T>();
        self.numbers.resize(length + slack, T::default());
        self.start = self.numbers.as_ptr().align_offset(LINE).min(slack);
        self.length = length;
    }
}

impl<T> std::ops::Deref for Aligned<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.numbers[self.start..self.start + self.length]
    }
}

impl<T> std::ops::DerefMut for Aligned<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.numbers[self.start..self.start + self.length]
    }
}

/// A term that, added to an edge function, excludes the lanes beside a triangle's columns. The number of these lanes depends on
/// the instruction set, and the edge functions of a sliver may be non-negative there.
#[inline(always)]
fn column_mask<L: Lanes>(lanes: L, start: usize, [first, last]: [usize; 2]) -> L::Float {
    let masks = COLUMN_MASKS.as_flattened();
    let right = lanes.load(&masks[2 * MAX_LANES - (last + 1 - start).min(L::N)..]);
    if start >= first {
        return right;
    }
    lanes.min(right, lanes.load(&masks[MAX_LANES + start - first..]))
}

/// Zeros between equally many negative infinities.
const COLUMN_MASKS: [[f32; MAX_LANES]; 3] = [
    [f32::NEG_INFINITY; MAX_LANES],
    [0.0; MAX_LANES],
    [f32::NEG_INFINITY; MAX_LANES],
];

/// `c + a·x + b·y` in one row.
#[inline(always)]
pub(super) fn at_top<L: Lanes>(lanes: L, [c, a, b]: [f32; 3], x: L::Float, y: f32) -> L::Float {
    lanes.mul_add(lanes.splat(a), x, lanes.splat(c + b * y))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::super::lanes::Portable;
    use super::*;

    /// A triangle with these corners, clockwise on the screen, and 1 / depth of each.
    fn triangle(corners: [[f32; 2]; 3], inverse: [f32; 3], size: [usize; 2]) -> Option<Triangle> {
        let edge = |k: usize| {
            let ([px, py], [qx, qy]) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
            [qx * py - px * qy, qy - py, px - qx]
        };
        let edges = [edge(0), edge(1), edge(2)];
        let area = edges[0][0] + edges[1][0] + edges[2][0];
        let ends = |axis: usize| {
            let values = corners.map(|corner| corner[axis]);
            let low = values.into_iter().fold(f32::INFINITY, f32::min).max(0.0).ceil();
            let high = values
                .into_iter()
                .fold(f32::NEG_INFINITY, f32::max)
                .min(size[axis] as f32 - 1.0);
            (low <= high).then_some([low as usize, high as usize])
        };
        let plane = |k: usize| (0..3).map(|corner| edges[corner][k] * inverse[corner]).sum::<f32>() / area;
        (area > 0.0).then_some(())?;
        Some(Triangle {
            edges,
            inverse_depth: [plane(0), plane(1), plane(2)],
            columns: ends(0)?,
            rows: ends(1)?,
            pixel: 7,
            item: 3,
        })
    }

    /// Reference result of `fill`, pixel by pixel, visiting every row.
    fn reference_depths(triangle: &Triangle, canvas: &Canvas) -> Vec<f32> {
        let mut depths = vec![0.0; canvas.stride * canvas.height];
        let first = triangle.rows[0] as f32;
        for x in triangle.columns[0]..=triangle.columns[1] {
            let at = |[c, a, b]: [f32; 3]| a * x as f32 + (c + b * first);
            let mut edges = triangle.edges.map(at);
            let mut inverse = at(triangle.inverse_depth);
            for y in triangle.rows[0]..=triangle.rows[1] {
                if edges.iter().all(|edge| *edge >= 0.0) && inverse > 0.0 {
                    depths[y * canvas.stride + x] = inverse;
                }
                for (edge, [_, _, down]) in edges.iter_mut().zip(triangle.edges) {
                    *edge += down;
                }
                inverse += triangle.inverse_depth[2];
            }
        }
        depths
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn skipped_rows_contain_no_pixel_of_the_triangle(
            corners in prop::array::uniform3(prop::array::uniform2(prop_oneof![-300.0..400.0_f32, -9.0..99.0_f32, Just(30.0)])),
            inverse in prop::array::uniform3(0.01..9.0_f32),
        ) {
            let size = [84, 90];
            let found = [corners, [corners[0], corners[2], corners[1]]].into_iter().find_map(|corners| triangle(corners, inverse, size));
            let mut canvas = Canvas::default();
            canvas.clear(size[0], size[1], true);
            if let Some(triangle) = found {
                canvas.fill::<_, true>(Portable, &triangle, ());
                let drawn: Vec<u32> = canvas.inverse_depth.iter().map(|depth| depth.to_bits()).collect();
                let plain = reference_depths(&triangle, &canvas);
                for (index, (drawn, plain)) in drawn.into_iter().zip(plain).enumerate() {
                    prop_assert_eq!(drawn, plain.to_bits(), "row {}, column {}", index / canvas.stride, index % canvas.stride);
                    prop_assert_eq!(canvas.items[index] == 3, plain > 0.0);
                }
            }
        }
    }
}
