//! Turns blocks of triangles into screen-space triangles: culls, lights, projects and clips them at the near plane.

use super::canvas::{Canvas, Triangle};
use super::lanes::Lanes;
use super::shade::{FULL_LEVEL, ROUNDING, SKY_SHARE};
use super::view::{NEAR, Placement};
use crate::assets::{BLOCK, Block};

/// Values shared by all triangles of a material.
#[derive(Clone, Copy, Debug)]
pub(super) struct ShadingParams {
    /// Colour in full light, as bytes: 0 to 255 and above.
    pub(super) color: [f32; 3],
    /// Share of ambient light.
    pub(super) ambient: f32,
    /// Label, in the highest byte.
    pub(super) label: u32,
    pub(super) item: u32,
    /// Whether parts of it may lie between the camera and the near plane.
    pub(super) may_need_clipping: bool,
}

/// Converts a material's triangles to pixels.
pub(super) trait Shading: Copy {
    /// Index of the item, and whether its triangles may need clipping at the near plane.
    fn item(&self) -> (u32, bool);

    /// Whether drawn triangles have the opposite winding on the screen, as if seen from behind.
    #[inline(always)]
    fn is_mirrored(&self) -> bool {
        false
    }

    /// Which of a block's faces are drawn; by default those that face the camera. `behind` is the distance of their planes
    /// behind the origin.
    #[inline(always)]
    fn facing<L: Lanes>(&self, l: L, normal: [L::Float; 3], behind: L::Float, at: &Placement) -> L::Mask {
        l.above(dot(l, normal, at.eye, behind), l.splat(0.0))
    }

    /// Packed pixels of a block's faces, with their labels.
    fn pixels<L: Lanes>(&self, l: L, normal: [L::Float; 3], at: &Placement) -> [u32; BLOCK];

    /// Draws a triangle.
    #[inline(always)]
    fn fill<L: Lanes, const ITEMS: bool>(&self, l: L, canvas: &mut Canvas, triangle: &Triangle) {
        canvas.fill::<L, ITEMS>(l, triangle, ());
    }
}

impl Shading for ShadingParams {
    #[inline(always)]
    fn item(&self) -> (u32, bool) {
        (self.item, self.may_need_clipping)
    }

    #[inline(always)]
    fn pixels<L: Lanes>(&self, l: L, normal: [L::Float; 3], at: &Placement) -> [u32; BLOCK] {
        packed_pixels(l, normal, at, self)
    }
}

/// One value per lane, for processing lanes one by one.
type PerLane = [f32; BLOCK];

/// Draws the triangles of a block that face the camera.
#[inline(always)]
pub(super) fn draw_block<L: Lanes, const ITEMS: bool, S: Shading>(
    lanes: L,
    canvas: &mut Canvas,
    block: &Block,
    at: &Placement,
    params: &S,
) {
    for first in (0..BLOCK).step_by(L::N) {
        draw_lanes::<L, ITEMS, S>(lanes, canvas, block, first, at, params);
    }
}

#[inline(always)]
fn draw_lanes<L: Lanes, const ITEMS: bool, S: Shading>(
    l: L,
    canvas: &mut Canvas,
    block: &Block,
    first: usize,
    at: &Placement,
    params: &S,
) {
    let normal = load3(l, &block.normal, 0, first);
    let behind = l.sub(l.splat(0.0), l.load(&block.offset[first..]));
    let facing = params.facing(l, normal, behind, at);
    if l.bits(facing) == 0 {
        return;
    }
    let corners = [
        load3(l, &block.corners, 0, first),
        load3(l, &block.corners, 3, first),
        load3(l, &block.corners, 6, first),
    ];
    let depth = project(l, corners, &at.depth);
    let pixels = params.pixels(l, normal, at);
    // The treatment of a triangle must not depend on its neighbours, whose number depends on the instruction set.
    let mut to_clip = 0;
    let (item, may_need_clipping) = params.item();
    if may_need_clipping {
        to_clip = l.bits(l.both(facing, l.above(l.splat(NEAR), min3(l, depth))));
        draw_clipped::<L, ITEMS, S>(l, canvas, block, (first, to_clip), at, (&pixels, params));
    }
    let one = l.splat(1.0);
    let inverse = [l.div(one, depth[0]), l.div(one, depth[1]), l.div(one, depth[2])];
    let x = product(l, project(l, corners, &at.column), inverse);
    let y = product(l, project(l, corners, &at.row), inverse);
    // Integer coordinates within the triangle's bounding box and the image.
    let (left, top) = (round_up(l, min3(l, x)), round_up(l, min3(l, y)));
    let right = l.min(max3(l, x), l.splat(canvas.width as f32 - 1.0));
    let bottom = l.min(max3(l, y), l.splat(canvas.height as f32 - 1.0));
    let seen = l.both(facing, l.both(l.at_least(right, left), l.at_least(bottom, top)));
    let mut seen = l.bits(seen) & !to_clip;
    if seen == 0 {
        return;
    }
    // Edge k is opposite corner k. The neighbouring triangle there has the same line, bit for bit.
    let edges = if params.is_mirrored() {
        [edge(l, x, y, 2, 1), edge(l, x, y, 0, 2), edge(l, x, y, 1, 0)]
    } else {
        [edge(l, x, y, 1, 2), edge(l, x, y, 2, 0), edge(l, x, y, 0, 1)]
    };
    let area = l.add(edges[0][0], l.add(edges[1][0], edges[2][0]));
    let share = l.div(one, area);
    let mut rows = [[0.0; BLOCK]; 16];
    for (k, edge) in edges.into_iter().enumerate() {
        l.store(edge[0], &mut rows[3 * k]);
        l.store(edge[1], &mut rows[3 * k + 1]);
        l.store(edge[2], &mut rows[3 * k + 2]);
    }
    for k in 0..3 {
        let last_two = l.mul_add(edges[1][k], inverse[1], l.mul(edges[2][k], inverse[2]));
        let sum = l.mul_add(edges[0][k], inverse[0], last_two);
        l.store(l.mul(sum, share), &mut rows[9 + k]);
    }
    l.store(left, &mut rows[12]);
    l.store(right, &mut rows[13]);
    l.store(top, &mut rows[14]);
    l.store(bottom, &mut rows[15]);
    while seen != 0 {
        let lane = seen.trailing_zeros() as usize;
        seen &= seen - 1;
        params.fill::<L, ITEMS>(l, canvas, &triangle(&rows, lane, pixels[lane], item));
    }
}

/// The triangle of one lane.
#[inline(always)]
fn triangle(rows: &[PerLane; 16], lane: usize, pixel: u32, item: u32) -> Triangle {
    let three = |first: usize| [rows[first][lane], rows[first + 1][lane], rows[first + 2][lane]];
    Triangle {
        edges: [three(0), three(3), three(6)],
        inverse_depth: three(9),
        columns: [rows[12][lane] as usize, rows[13][lane] as usize],
        rows: [rows[14][lane] as usize, rows[15][lane] as usize],
        pixel,
        item,
    }
}

/// Three consecutive rows of a block, starting at a lane.
#[inline(always)]
fn load3<L: Lanes>(l: L, rows: &[PerLane], row: usize, first: usize) -> [L::Float; 3] {
    [
        l.load(&rows[row][first..]),
        l.load(&rows[row + 1][first..]),
        l.load(&rows[row + 2][first..]),
    ]
}

#[inline(always)]
fn project<L: Lanes>(l: L, corners: [[L::Float; 3]; 3], row: &[f32; 4]) -> [L::Float; 3] {
    let (by, plus) = ([row[0], row[1], row[2]], l.splat(row[3]));
    [
        dot(l, corners[0], by, plus),
        dot(l, corners[1], by, plus),
        dot(l, corners[2], by, plus),
    ]
}

#[inline(always)]
fn product<L: Lanes>(l: L, a: [L::Float; 3], b: [L::Float; 3]) -> [L::Float; 3] {
    [l.mul(a[0], b[0]), l.mul(a[1], b[1]), l.mul(a[2], b[2])]
}

#[inline(always)]
fn min3<L: Lanes>(l: L, a: [L::Float; 3]) -> L::Float {
    l.min(a[0], l.min(a[1], a[2]))
}

#[inline(always)]
fn max3<L: Lanes>(l: L, a: [L::Float; 3]) -> L::Float {
    l.max(a[0], l.max(a[1], a[2]))
}

/// Rounds up to an integer, at least 0.
#[inline(always)]
fn round_up<L: Lanes>(l: L, value: L::Float) -> L::Float {
    let value = l.min(l.max(value, l.splat(0.0)), l.splat(65536.0));
    let truncated = l.float(l.truncate(value));
    l.select(l.above(value, truncated), l.add(truncated, l.splat(1.0)), truncated)
}

/// The line from corner p to corner q: c, a, b of `c + a·x + b·y`.
#[inline(always)]
fn edge<L: Lanes>(l: L, x: [L::Float; 3], y: [L::Float; 3], p: usize, q: usize) -> [L::Float; 3] {
    [
        l.sub(l.mul(x[q], y[p]), l.mul(x[p], y[q])),
        l.sub(y[q], y[p]),
        l.sub(x[p], x[q]),
    ]
}

#[inline(always)]
pub(super) fn dot<L: Lanes>(l: L, point: [L::Float; 3], by: [f32; 3], plus: L::Float) -> L::Float {
    l.mul_add(
        point[0],
        l.splat(by[0]),
        l.mul_add(point[1], l.splat(by[1]), l.mul_add(point[2], l.splat(by[2]), plus)),
    )
}

/// Packed pixels of a block's faces, with the label above the colour. This is the formula of `shade.rs` for all lanes at once.
#[inline(always)]
fn packed_pixels<L: Lanes>(l: L, normal: [L::Float; 3], at: &Placement, params: &ShadingParams) -> [u32; BLOCK] {
    let (zero, one) = (l.splat(0.0), l.splat(1.0));
    let sun = l.max(dot(l, normal, at.sun, zero), zero);
    let sky = l.mul(l.splat(SKY_SHARE), l.mul(l.add(normal[2], one), l.sub(one, sun)));
    let share = l.add(
        l.mul_add(sun, l.splat(1.0 - params.ambient), l.splat(params.ambient)),
        sky,
    );
    let (red, green, blue) = (
        byte(l, share, params.color[0]),
        byte(l, share, params.color[1]),
        byte(l, share, params.color[2]),
    );
    let rgb = l.or(red, l.shift_byte(l.or(green, l.shift_byte(blue))));
    let mut pixels = [0; BLOCK];
    l.store_words(l.or(rgb, l.splat_word(params.label)), &mut pixels);
    pixels
}

#[inline(always)]
fn byte<L: Lanes>(l: L, share: L::Float, full: f32) -> L::Word {
    let level = l.mul_add(share, l.splat(full), l.splat(ROUNDING));
    l.truncate(l.min(level, l.splat(FULL_LEVEL)))
}

/// Draws the parts of these lanes' triangles beyond the near plane. Processes triangles one by one, because few are that near.
#[inline(always)]
fn draw_clipped<L: Lanes, const ITEMS: bool, S: Shading>(
    lanes: L,
    canvas: &mut Canvas,
    block: &Block,
    (first, mut lanes_to_clip): (usize, u32),
    at: &Placement,
    (pixels, params): (&[u32; BLOCK], &S),
) {
    while lanes_to_clip != 0 {
        let lane = lanes_to_clip.trailing_zeros() as usize;
        lanes_to_clip &= lanes_to_clip - 1;
        let (polygon, count) = clip(block, first + lane, at);
        for k in 2..count {
            let mut corners = [polygon[0], polygon[k - 1], polygon[k]];
            if params.is_mirrored() {
                corners.swap(1, 2);
            }
            if let Some(triangle) =
                screen_triangle(corners, [canvas.width, canvas.height], pixels[lane], params.item().0)
            {
                params.fill::<L, ITEMS>(lanes, canvas, &triangle);
            }
        }
    }
}

/// Column, row and 1 / depth of the corners of a triangle clipped at the near plane, and their number.
fn clip(block: &Block, lane: usize, at: &Placement) -> ([[f32; 3]; 4], usize) {
    let corner = |k: usize| {
        let point = [0, 1, 2].map(|axis| block.corners[3 * k + axis][lane]);
        let apply = |row: &[f32; 4]| row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3];
        [apply(&at.column), apply(&at.row), apply(&at.depth)]
    };
    let corners = [corner(0), corner(1), corner(2)];
    let mut polygon = [[0.0; 3]; 4];
    let mut count = 0;
    for k in 0..3 {
        let (a, b) = (corners[k], corners[(k + 1) % 3]);
        if a[2] >= NEAR {
            polygon[count] = a;
            count += 1;
        }
        if (a[2] >= NEAR) != (b[2] >= NEAR) {
            let share = (NEAR - a[2]) / (b[2] - a[2]);
            polygon[count] = [a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share, NEAR];
            count += 1;
        }
    }
    for point in &mut polygon[..count] {
        let inverse = 1.0 / point[2];
        *point = [point[0] * inverse, point[1] * inverse, inverse];
    }
    (polygon, count)
}

/// A triangle from its corners' columns, rows and 1 / depth; `None` if it cannot contain a pixel's centre.
fn screen_triangle(corners: [[f32; 3]; 3], size: [usize; 2], pixel: u32, item: u32) -> Option<Triangle> {
    let range = |axis: usize| {
        let values = corners.map(|corner| corner[axis]);
        let low = values.iter().copied().fold(f32::INFINITY, f32::min).max(0.0).ceil();
        let high = values
            .iter()
            .copied()
            .fold(f32::NEG_INFINITY, f32::max)
            .min(size[axis] as f32 - 1.0);
        (high >= low).then_some([low as usize, high as usize])
    };
    let (columns, rows) = (range(0)?, range(1)?);
    let edge = |k: usize| {
        let ([px, py, _], [qx, qy, _]) = (corners[(k + 1) % 3], corners[(k + 2) % 3]);
        [qx * py - px * qy, qy - py, px - qx]
    };
    let edges = [edge(0), edge(1), edge(2)];
    let area = edges[0][0] + edges[1][0] + edges[2][0];
    if area.is_nan() || area <= 0.0 {
        return None;
    }
    let plane = |k: usize| (0..3).map(|corner| edges[corner][k] * corners[corner][2]).sum::<f32>() / area;
    Some(Triangle {
        edges,
        inverse_depth: [plane(0), plane(1), plane(2)],
        columns,
        rows,
        pixel,
        item,
    })
}
