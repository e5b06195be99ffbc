//! Composes images from packed pixels: lays the canvas over ground, sky and the arena's walls, and writes each modality.

use std::ops::Range;

use super::backdrop::{Backdrop, SQUARE};
use super::canvas::Canvas;
use super::frame::{CATEGORY_MAP, FAR_DEPTH};
use super::lanes::{Lanes, MAX_LANES};
use super::shade::Shader;
use super::target::Target;
use super::view::View;
use crate::scene::{ARENA_WALLS, Scene};

/// Bits of a label for the reward category; the rest hold the class.
pub(super) const CATEGORY_BITS: u32 = 3;

/// Ground farther than this many squares from the origin is drawn without squares, because their indices would overflow.
pub(super) const MAX_SQUARES: f32 = 8000.0;

/// Added to indices of squares to make them positive; a multiple of 16, which preserves the pattern.
pub(super) const SHIFT: f32 = 8192.0;

/// The arena's four walls around the camera as linear functions. For each wall, 1 / its distance along the view axis is `base +
/// right · x + up · y` for a pixel that is x to the right and y up at 1 m.
pub(super) struct Walls {
    pub(super) base: [f32; 4],
    pub(super) right: [f32; 4],
    pub(super) up: [f32; 4],
    pub(super) pixels: [u32; 4],
    /// Height of the walls' upper edge above the camera, in metres.
    pub(super) above: f32,
}

/// One row's part of [`Walls`], and the row's background.
struct Row {
    walls: [[f32; 2]; 4],
    /// 1 / distance at which a wall's upper edge is in this row; walls farther away end below it.
    edge: f32,
    ground: f32,
    pixels: [u32; 4],
    /// Squares along x and y: the position at the row's middle, and its change to the right.
    squares: [[f32; 2]; 2],
    has_squares: bool,
    has_walls: bool,
    /// Depth of the ground or the sky.
    metres: f32,
}

impl Walls {
    /// The arena's walls seen from inside; `None` if the camera is elsewhere, because then they are drawn as panels.
    pub(super) fn around(scene: &Scene, view: &View, shader: &Shader) -> Option<Self> {
        let [half_x, half_y] = scene.arena_size().map(|side| side / 2.0);
        let height = scene.walls.first()?.height;
        let [x, y, z] = view.position;
        // A camera whose near plane intersects a wall would see through it.
        let inside = half_x - x.abs() > 0.1 && half_y - y.abs() > 0.1 && z > 0.0 && z < height;
        if !inside {
            return None;
        }
        // West, north, east, south, as in the scene.
        let inward = [[1.0, 0.0], [0.0, -1.0], [-1.0, 0.0], [0.0, 1.0]];
        let mut walls = Self {
            base: [0.0; 4],
            right: [0.0; 4],
            up: [0.0; 4],
            pixels: [0; 4],
            above: height - z,
        };
        for (k, normal) in inward.into_iter().enumerate() {
            let distance = [half_x, half_y, half_x, half_y][k] + normal[0] * x + normal[1] * y;
            let towards = |axis: [f32; 3]| -(axis[0] * normal[0] + axis[1] * normal[1]) / distance;
            walls.base[k] = towards(view.axes.forward);
            walls.right[k] = towards(view.axes.right);
            walls.up[k] = towards(view.axes.up);
            let color = scene.walls[..ARENA_WALLS][k].color;
            walls.pixels[k] = shader.packed_pixel(color, [normal[0], normal[1], 0.0]) | u32::from(CATEGORY_MAP) << 24;
        }
        Some(walls)
    }
}

/// One row's packed pixels and items, reused between images.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    words: Vec<u32>,
    items: Vec<u32>,
    /// The nearest arena wall in each column: 1 / distance, and its packed pixel.
    walls: Vec<f32>,
    wall_pixels: Vec<u32>,
}

/// Everything that an image is composed of.
pub(super) struct Composition<'a> {
    pub(super) canvas: &'a Canvas,
    pub(super) backdrop: &'a Backdrop,
    pub(super) walls: Option<Walls>,
    pub(super) view: View,
    /// Offset of each column from the image's middle, to the right, at 1 m.
    pub(super) offsets: &'a [f32],
    /// Distance in metres at which fog has half its effect.
    pub(super) fog_distance: Option<f32>,
    /// Class of each item; empty if labels contain the class.
    pub(super) classes: &'a [u16],
}

impl Composition<'_> {
    /// Writes all images that the target requests.
    #[inline(always)]
    pub(super) fn write<L: Lanes, const ITEMS: bool>(&self, l: L, scratch: &mut Scratch, target: &mut Target<'_>) {
        let width = self.canvas.width;
        scratch.words.resize(self.canvas.stride, 0);
        scratch.items.resize(self.canvas.stride, 0);
        scratch.walls.resize(self.canvas.stride, 0.0);
        scratch.wall_pixels.resize(self.canvas.stride, 0);
        let labelled = target.has_labels();
        let canvas = self.canvas;
        let (inverse_depth, pixels, items) = (&*canvas.inverse_depth, &*canvas.pixels, &*canvas.items);
        let all = (1 << L::N) - 1;
        let nowhere = l.above(l.splat(0.0), l.splat(0.0));
        let mut walls_are_known = false;
        for y in 0..self.canvas.height {
            let row = self.row(y);
            if row.has_walls && !walls_are_known {
                self.measure_walls(l, &row, scratch);
                // For a camera that looks straight ahead, walls have the same depth in each row.
                walls_are_known = self.walls.as_ref().is_some_and(|walls| walls.up == [0.0; 4]);
            }
            let ground = l.splat(row.ground);
            let out = y * width;
            let mut x = 0;
            while x < width {
                // The last vector of a row overlaps pixels that are already done, if the row is long enough.
                let start = if x + L::N > width {
                    width.saturating_sub(L::N)
                } else {
                    x
                };
                let pixel = y * self.canvas.stride + start;
                let drawn = l.load(&inverse_depth[pixel..]);
                let mut behind = ground;
                let mut is_wall = nowhere;
                if row.has_walls {
                    let wall = l.load(&scratch.walls[start..]);
                    is_wall = l.both(l.at_least(wall, l.splat(row.edge)), l.above(wall, ground));
                    behind = l.select(is_wall, wall, ground);
                }
                let in_front = l.above(drawn, behind);
                let covered = l.bits(in_front);
                let mut word = l.load_words(&pixels[pixel..]);
                if covered != all {
                    let mut other = self.ground(l, &row, start);
                    if row.has_walls {
                        other = l.select_words(is_wall, l.load_words(&scratch.wall_pixels[start..]), other);
                    }
                    word = l.select_words(in_front, word, other);
                }
                let inverse = l.max(drawn, behind);
                if let Some(distance) = self.fog_distance {
                    word = self.add_fog(l, word, inverse, distance);
                }
                if width < L::N {
                    write_narrow_row(l, word, inverse, target, out..out + width);
                } else {
                    if let Some(rgb) = &mut target.rgb {
                        l.store_rgb(word, &mut rgb[3 * (out + start)..]);
                    }
                    if let Some(depth) = &mut target.depth {
                        // Division is slow, so values shared by the whole row are divided once.
                        let metres = if covered == 0 && !row.has_walls {
                            l.splat(row.metres)
                        } else {
                            metres(l, inverse)
                        };
                        l.store(metres, &mut depth[out + start..]);
                    }
                }
                if labelled {
                    l.store_words(word, &mut scratch.words[start..]);
                    if ITEMS {
                        let item = l.load_words(&items[pixel..]);
                        l.store_words(
                            l.select_words(in_front, item, l.splat_word(0)),
                            &mut scratch.items[start..],
                        );
                    }
                }
                x = start + L::N;
            }
            if labelled {
                self.label::<ITEMS>(scratch, out..out + width, target);
            }
        }
    }

    /// Writes a row's categories, classes and instances.
    #[inline(always)]
    fn label<const ITEMS: bool>(&self, scratch: &Scratch, row: Range<usize>, target: &mut Target<'_>) {
        if let Some(category) = &mut target.category {
            for (out, word) in category[row.clone()].iter_mut().zip(&scratch.words) {
                *out = (word >> 24) as u8 & ((1 << CATEGORY_BITS) - 1);
            }
        }
        if let Some(class) = &mut target.class {
            let class = &mut class[row.clone()];
            if ITEMS {
                for (out, item) in class.iter_mut().zip(&scratch.items) {
                    *out = if *item == 0 {
                        0
                    } else {
                        self.classes[*item as usize - 1]
                    };
                }
            } else {
                for (out, word) in class.iter_mut().zip(&scratch.words) {
                    *out = (word >> (24 + CATEGORY_BITS)) as u16;
                }
            }
        }
        if let Some(instance) = &mut target.instance {
            let count = row.len();
            instance[row].copy_from_slice(&scratch.items[..count]);
        }
    }

    #[inline(always)]
    fn row(&self, y: usize) -> Row {
        let backdrop = self.backdrop;
        let ground = backdrop.ground[y];
        let pixels = [0, 1, 2, 3].map(|k| backdrop.pixels[k][y]);
        let offset = -self.view.offset(1, y as f32);
        let mut row = Row {
            walls: [[0.0; 2]; 4],
            edge: 0.0,
            ground,
            pixels,
            squares: [[0.0; 2]; 2],
            has_squares: false,
            has_walls: false,
            metres: if ground > 1.0 / FAR_DEPTH {
                1.0 / ground
            } else {
                FAR_DEPTH
            },
        };
        if ground > 0.0 && pixels != [pixels[0]; 4] {
            let metres = 1.0 / ground;
            let axes = &self.view.axes;
            let mut furthest = 0.0_f32;
            let half_width = self.offsets[0].abs();
            for axis in 0..2 {
                let ahead = axes.forward[axis] + offset * axes.up[axis];
                let position = (self.view.position[axis] + ahead * metres) / SQUARE;
                let across = axes.right[axis] * metres / SQUARE;
                furthest = furthest.max(position.abs() + across.abs() * half_width);
                row.squares[axis] = [position + SHIFT, across];
            }
            row.has_squares = furthest < MAX_SQUARES;
        }
        if let Some(walls) = &self.walls {
            let rise = backdrop.rise[y];
            row.edge = rise.max(0.0) / walls.above;
            let (first, last) = (self.offsets[0], self.offsets[self.canvas.width - 1]);
            let mut nearest = 0.0_f32;
            for k in 0..4 {
                let base = walls.base[k] + offset * walls.up[k];
                row.walls[k] = [base, walls.right[k]];
                nearest = nearest
                    .max(base + walls.right[k] * first)
                    .max(base + walls.right[k] * last);
            }
            row.has_walls = nearest >= row.edge && nearest > ground;
        }
        row
    }

    /// Packed pixels of ground and sky, starting at a column.
    #[inline(always)]
    fn ground<L: Lanes>(&self, l: L, row: &Row, start: usize) -> L::Word {
        let pixel = l.splat_word(row.pixels[0]);
        if !row.has_squares {
            return pixel;
        }
        let offset = l.load(&self.offsets[start..]);
        let both = l.xor(square(l, row.squares[0], offset), square(l, row.squares[1], offset));
        let fine = l.has_bit(both, 0);
        let light = l.select_words(fine, l.splat_word(row.pixels[1]), pixel);
        let dark = l.select_words(fine, l.splat_word(row.pixels[3]), l.splat_word(row.pixels[2]));
        l.select_words(l.has_bit(both, 3), dark, light)
    }

    /// Finds the nearest arena wall in each column of a row.
    #[inline(always)]
    fn measure_walls<L: Lanes>(&self, l: L, row: &Row, scratch: &mut Scratch) {
        let Some(walls) = &self.walls else { return };
        for start in (0..self.canvas.stride).step_by(L::N) {
            let offset = l.load(&self.offsets[start..]);
            let (mut inverse, mut pixel) = (along(l, row.walls[0], offset), l.splat_word(walls.pixels[0]));
            for k in 1..4 {
                let other = along(l, row.walls[k], offset);
                pixel = l.select_words(l.above(other, inverse), l.splat_word(walls.pixels[k]), pixel);
                inverse = l.max(other, inverse);
            }
            l.store(inverse, &mut scratch.walls[start..]);
            l.store_words(pixel, &mut scratch.wall_pixels[start..]);
        }
    }

    /// Blends colours into the fog with distance; the sky stays unchanged.
    #[inline(always)]
    fn add_fog<L: Lanes>(&self, l: L, word: L::Word, inverse: L::Float, distance: f32) -> L::Word {
        let one = l.splat(1.0);
        let reach = l.mul(inverse, l.splat(distance));
        let fog = l.div(one, l.mul_add(reach, reach, one));
        let is_sky = l.at_least(l.splat(0.0), inverse);
        let mut words = [0; MAX_LANES];
        let mut shares = [0.0; MAX_LANES];
        l.store_words(word, &mut words);
        l.store(l.select(is_sky, l.splat(0.0), fog), &mut shares);
        for (word, share) in words.iter_mut().zip(shares).take(L::N) {
            let mut bytes = word.to_le_bytes();
            for (byte, full) in bytes.iter_mut().zip(self.backdrop.fog_color) {
                let level = f32::from(*byte);
                *byte = (level + (full - level) * share + 0.5) as u8;
            }
            *word = u32::from_le_bytes(bytes);
        }
        l.load_words(&words)
    }
}

/// `base + slope · offset`.
#[inline(always)]
fn along<L: Lanes>(l: L, [base, slope]: [f32; 2], offset: L::Float) -> L::Float {
    l.mul_add(l.splat(slope), offset, l.splat(base))
}

/// Indices of the squares in a row's pixels, along one axis.
#[inline(always)]
fn square<L: Lanes>(l: L, row: [f32; 2], offset: L::Float) -> L::Word {
    l.truncate(along(l, row, offset))
}

/// Converts 1 / depth to metres.
#[inline(always)]
pub(super) fn metres<L: Lanes>(l: L, inverse: L::Float) -> L::Float {
    // Lanes with a division by 0 are not selected.
    let near = l.above(inverse, l.splat(1.0 / FAR_DEPTH));
    l.select(near, l.div(l.splat(1.0), inverse), l.splat(FAR_DEPTH))
}

/// Writes colour and depth of a row that is shorter than a vector.
#[inline(never)]
fn write_narrow_row<L: Lanes>(l: L, word: L::Word, inverse: L::Float, target: &mut Target<'_>, row: Range<usize>) {
    let count = row.len();
    if let Some(rgb) = &mut target.rgb {
        let mut bytes = [0; 3 * MAX_LANES];
        l.store_rgb(word, &mut bytes);
        rgb[3 * row.start..3 * row.end].copy_from_slice(&bytes[..3 * count]);
    }
    if let Some(depth) = &mut target.depth {
        let mut all = [0.0; MAX_LANES];
        l.store(metres(l, inverse), &mut all);
        depth[row].copy_from_slice(&all[..count]);
    }
}
