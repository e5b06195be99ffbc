//! Patterns of the natural style as repeating tiles. A tile holds factors, brighter and darker, on the colour that it covers,
//! at several levels. Each tile is computed once, on first use. Its finest level has 256 × 256 texels, and each coarser one
//! half as many per side, down to a single neutral texel: where a pixel covers a whole tile, no pattern is visible.

use std::sync::LazyLock;

use driftworld_spec::Surface;

use crate::looks::Finish;

/// Texels per side of a tile's finest level.
pub(super) const SIDE: usize = 256;

/// The factor 1 in each byte of a texel.
pub(super) const NEUTRAL: u32 = 0x8080_8080;

/// A pattern.
#[derive(Debug)]
pub(super) struct Tile {
    /// Texels: a factor per channel, with 128 for 1; the highest byte is 128, or 0 in clouds. The level with side s begins at s².
    pub(super) texels: Vec<u32>,
    /// Metres per side.
    pub(super) period: f32,
    /// Whether the pattern looks similar at a finer scale, so that it can serve as its own detail.
    pub(super) is_grain: bool,
    /// Texels per pixel; below 1 for patterns with long hard edges, so that these do not flicker.
    pub(super) sharpness: f32,
}

macro_rules! new_tile {
    ($period:literal, $is_grain:literal, $sharpness:expr, $texel:expr) => {{
        static TILE: LazyLock<Tile> = LazyLock::new(|| Tile::new_tile($period, $is_grain, $sharpness, $texel));
        &*TILE
    }};
}

/// The tile of a surface; `None` for a plain one.
pub(super) fn tile(surface: Surface) -> Option<&'static Tile> {
    Some(match surface {
        Surface::Plain => return None,
        Surface::Noise => new_tile!(8.0, true, 1.0, noise),
        Surface::Brick => new_tile!(2.0, false, 1.0, brick),
        Surface::Plank => new_tile!(2.0, false, 1.0, plank),
        Surface::Tile => new_tile!(2.0, false, 1.0, floor_tile),
        Surface::Stripes => new_tile!(2.0, false, 0.5, stripes),
        Surface::Checker => new_tile!(2.0, false, 0.5, checker),
        Surface::Stone => new_tile!(2.0, false, 1.0, stone),
        Surface::Plaster => new_tile!(4.0, true, 1.0, plaster),
        Surface::Cobbles => new_tile!(2.0, false, 1.0, cobbles),
    })
}

impl Finish {
    /// The finish's tile, in metres of a model at scale 1; its origin is the model's middle.
    pub(super) fn tile(self) -> &'static Tile {
        match self {
            Self::Door => new_tile!(2.0, false, 1.0, door),
            Self::Crate => new_tile!(0.9, false, 1.0, wooden_box),
            Self::Metal => new_tile!(1.0, false, 1.0, metal),
        }
    }
}

/// Cloud cover, 0 to 255, in each of the three lower bytes.
pub(super) fn clouds() -> &'static Tile {
    static TILE: LazyLock<Tile> = LazyLock::new(|| {
        let cover = |x: f32, y: f32| smooth((fractal(x, y, 3, 6, 0.55, 71) + 0.02) / 0.34);
        let levels = levels(|x, y| [cover(x, y); 3]);
        Tile {
            texels: words(&levels, |share| (share * 255.0 + 0.5) as u32, 0),
            period: 1.0,
            is_grain: false,
            sharpness: 1.0,
        }
    });
    &TILE
}

impl Tile {
    fn new_tile(period: f32, is_grain: bool, sharpness: f32, texel: fn(f32, f32) -> [f32; 3]) -> Self {
        let mut levels = levels(texel);
        // Normalises each channel to a mean of 1, so that the mean is the covered colour.
        let mean = levels.last().map_or([1.0; 3], |coarsest| coarsest[0]);
        for texel in levels.iter_mut().flatten() {
            (0..3).for_each(|channel| texel[channel] /= mean[channel]);
        }
        Self {
            texels: words(&levels, |factor| (factor * 128.0 + 0.5).clamp(0.0, 255.0) as u32, 0x80),
            period,
            is_grain,
            sharpness,
        }
    }
}

/// All levels of a pattern, the finest first. Levels are stored column by column, in the order in which images are composed.
/// `texel` gives the pattern at a position in the tile, 0..1 along each side.
fn levels(texel: impl Fn(f32, f32) -> [f32; 3]) -> Vec<Vec<[f32; 3]>> {
    let at = |k: usize| (k as f32 + 0.5) / SIDE as f32;
    let finest = (0..SIDE * SIDE).map(|k| texel(at(k / SIDE), at(k % SIDE))).collect();
    let mut levels: Vec<Vec<[f32; 3]>> = vec![finest];
    let mut side = SIDE / 2;
    while side > 0 {
        let finer = &levels[levels.len() - 1];
        let mean = |k: usize| {
            let first = 2 * (k % side) + 4 * side * (k / side);
            let four = [0, 1, 2 * side, 2 * side + 1].map(|step| finer[first + step]);
            [0, 1, 2].map(|channel| four.iter().map(|texel| texel[channel]).sum::<f32>() / 4.0)
        };
        levels.push((0..side * side).map(mean).collect());
        side /= 2;
    }
    levels
}

/// Packs levels into the words of a tile.
fn words(levels: &[Vec<[f32; 3]>], byte: impl Fn(f32) -> u32, highest: u32) -> Vec<u32> {
    let mut words = vec![0; 2 * SIDE * SIDE];
    for level in levels {
        for (word, texel) in words[level.len()..].iter_mut().zip(level) {
            let [red, green, blue] = texel.map(&byte);
            *word = highest << 24 | blue << 16 | green << 8 | red;
        }
    }
    words
}

/// A number in 0..1 that depends only on its arguments.
fn hash(x: u32, y: u32, seed: u32) -> f32 {
    let mut bits = x.wrapping_mul(0x9E37_79B9) ^ y.wrapping_mul(0x85EB_CA6B) ^ seed.wrapping_mul(0xC2B2_AE35);
    bits ^= bits >> 15;
    bits = bits.wrapping_mul(0x2C1B_3C6D);
    bits ^= bits >> 12;
    bits = bits.wrapping_mul(0x297A_2D39);
    bits ^= bits >> 15;
    (bits >> 8) as f32 / (1 << 24) as f32
}

/// Smooth step from 0 to 1.
fn smooth(share: f32) -> f32 {
    let share = share.clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Value noise, −1..1, on a repeating lattice of `cells` along x and y.
fn lattice(x: f32, y: f32, cells: [u32; 2], seed: u32) -> f32 {
    let position = [x * cells[0] as f32, y * cells[1] as f32];
    let cell = position.map(|at| at as u32);
    let share = [0, 1].map(|axis| smooth(position[axis] - cell[axis] as f32));
    let corner = |dx: u32, dy: u32| hash((cell[0] + dx) % cells[0], (cell[1] + dy) % cells[1], seed);
    let row = |dy: u32| corner(0, dy) + (corner(1, dy) - corner(0, dy)) * share[0];
    2.0 * (row(0) + (row(1) - row(0)) * share[1]) - 1.0
}

/// Sum of lattices, each twice as fine as the one before and `gain` times as strong.
fn fractal(x: f32, y: f32, cells: u32, octaves: u32, gain: f32, seed: u32) -> f32 {
    let mut sum = 0.0;
    let mut strength = 1.0;
    for octave in 0..octaves {
        let count = cells << octave;
        sum += strength * lattice(x, y, [count; 2], seed + octave);
        strength *= gain;
    }
    sum * (1.0 - gain)
}

/// A grey factor, made warmer or colder by `warmth`.
fn tinted(factor: f32, warmth: f32) -> [f32; 3] {
    [factor * (1.0 + warmth), factor, factor * (1.0 - warmth)]
}

fn noise(x: f32, y: f32) -> [f32; 3] {
    let coarse = fractal(x, y, 4, 3, 0.7, 1);
    let fine = fractal(x, y, 32, 3, 0.9, 5);
    tinted(1.0 + 0.4 * coarse + 0.7 * fine, 0.14 * fractal(x, y, 5, 3, 0.6, 9))
}

/// Index of the piece along an axis of `count` pieces, and the position in it, 0..1.
fn piece(at: f32, count: u32) -> (u32, f32) {
    let scaled = at * count as f32;
    (scaled as u32 % count, scaled - scaled as u32 as f32)
}

/// 1 within a piece, 0 in the joint around it; `joint` is the joint's width as a fraction of the piece.
fn within(at: f32, joint: f32) -> f32 {
    smooth((at.min(1.0 - at) - joint / 2.0) / (joint / 2.0) + 0.5)
}

fn brick(x: f32, y: f32) -> [f32; 3] {
    let (course, up) = piece(y, 8);
    let shifted = x + if course.is_multiple_of(2) { 0.0 } else { 0.125 };
    let (number, along) = piece(shifted - shifted as u32 as f32, 4);
    let body = within(along, 0.05) * within(up, 0.1);
    let rough = fractal(x, y, 32, 3, 0.8, 17);
    let own = 1.0 + 0.42 * (hash(number, course, 3) - 0.5) + 0.25 * rough;
    let joint = 0.62 + 0.1 * rough;
    tinted(
        joint + (own - joint) * body,
        0.14 * (hash(number, course, 4) - 0.4) * body,
    )
}

fn plank(x: f32, y: f32) -> [f32; 3] {
    let (board, across) = piece(y, 8);
    let shifted = x + hash(board, 0, 21);
    let along = shifted - shifted as u32 as f32;
    let grain = lattice(x, y, [6, 64], 23) + 0.7 * lattice(x, y, [12, 128], 24) + 0.4 * fractal(x, y, 16, 2, 0.7, 25);
    let body = within(across, 0.06) * within(along, 0.008);
    let own = 1.0 + 0.34 * (hash(board, 1, 22) - 0.5) + 0.11 * grain;
    tinted(0.5 + (own - 0.5) * body, 0.1 * (hash(board, 2, 22) - 0.5))
}

fn floor_tile(x: f32, y: f32) -> [f32; 3] {
    let ((column, along), (row, up)) = (piece(x, 4), piece(y, 4));
    let body = within(along, 0.045) * within(up, 0.045);
    let own = 1.0 + 0.14 * (hash(column, row, 31) - 0.5) + 0.1 * fractal(x, y, 8, 5, 0.7, 33);
    tinted(0.66 + (own - 0.66) * body, 0.05 * (hash(column, row, 32) - 0.5))
}

fn stripes(x: f32, y: f32) -> [f32; 3] {
    let (number, _) = piece(x, 8);
    let side = if number.is_multiple_of(2) { 0.22 } else { -0.22 };
    [1.0 + side + 0.05 * fractal(x, y, 16, 4, 0.7, 41); 3]
}

fn checker(x: f32, y: f32) -> [f32; 3] {
    let side = if (piece(x, 4).0 + piece(y, 4).0).is_multiple_of(2) {
        0.24
    } else {
        -0.24
    };
    [1.0 + side + 0.05 * fractal(x, y, 16, 4, 0.7, 43); 3]
}

fn stone(x: f32, y: f32) -> [f32; 3] {
    let (course, up) = piece(y, 6);
    let shifted = 4.0 * (1.0 + x + hash(course, 7, 51));
    // Index of one of four stones, with joints shifted by up to a quarter.
    let joint = |k: u32| k as f32 + 0.5 * (hash(k % 4, course, 52) - 0.5);
    let near = (shifted + 0.5) as u32;
    let number = if shifted < joint(near) { near - 1 } else { near };
    let length = joint(number + 1) - joint(number);
    let along = (shifted - joint(number)) / length;
    let body = within(along, 0.08 / length) * within(up, 0.11);
    let rough = fractal(x, y, 16, 4, 0.8, 53);
    let own = 1.0 + 0.3 * (hash(number % 4, course, 54) - 0.5) + 0.45 * rough + 0.12 * (up - 0.5);
    tinted(
        0.55 + (own - 0.55) * body,
        0.06 * (hash(number % 4, course, 55) - 0.5) * body,
    )
}

fn plaster(x: f32, y: f32) -> [f32; 3] {
    let patches = smooth(fractal(x, y, 3, 4, 0.6, 61) * 2.5 - 0.1);
    let grain = fractal(x, y, 32, 3, 0.9, 63);
    tinted(1.0 - 0.07 * patches + 0.3 * grain, 0.02 * patches)
}

fn cobbles(x: f32, y: f32) -> [f32; 3] {
    const CELLS: i32 = 10;
    let [x, y] = [x, y].map(|at| at * CELLS as f32);
    let (mut nearest, mut next, mut own) = (f32::INFINITY, f32::INFINITY, [0; 2]);
    for k in 0..9 {
        let cell = [x as i32 + k % 3 - 1, y as i32 + k / 3 - 1];
        let of = cell.map(|at| at.rem_euclid(CELLS) as u32);
        let middle =
            [0, 1].map(|axis: usize| cell[axis] as f32 + 0.5 + 0.7 * (hash(of[0], of[1], 81 + axis as u32) - 0.5));
        let away = ((x - middle[0]) * (x - middle[0]) + (y - middle[1]) * (y - middle[1])).sqrt();
        if away < nearest {
            (next, nearest, own) = (nearest, away, of);
        } else {
            next = next.min(away);
        }
    }
    let body = smooth((next - nearest) / 0.22);
    let tone = 1.15 + 0.36 * (hash(own[0], own[1], 83) - 0.5) - 0.3 * nearest;
    tinted(0.5 + (tone - 0.5) * body, 0.1 * (hash(own[0], own[1], 84) - 0.5) * body)
}

/// Converts a position in a tile, 0..1, to one relative to its origin, −0.5..0.5.
fn centred(at: f32) -> f32 {
    if at < 0.5 { at } else { at - 1.0 }
}

/// A frame with four panels, 1 m wide and 2 m high.
fn door(x: f32, y: f32) -> [f32; 3] {
    let [across, up] = [x, y].map(|at| 2.0 * centred(at));
    let grain = lattice(x, y, [96, 6], 91) + 0.7 * lattice(x, y, [48, 3], 92);
    let [low, high] = if up < 0.0 { [-0.82, -0.12] } else { [0.08, 0.86] };
    let sides = [across.abs() - 0.06, 0.38 - across.abs(), up - low, high - up];
    let inside = sides.into_iter().fold(f32::INFINITY, f32::min);
    // With light from above, the lower part of a panel's rim is bright and the upper part dark.
    let rim = if inside == sides[2] {
        1.3
    } else if inside == sides[3] {
        0.5
    } else {
        0.68
    };
    let edge = across.abs().max(up.abs() - 0.5);
    let own = match inside {
        // Texels beside the door, which are never visible.
        _ if across.abs() > 0.5 => 0.97,
        _ if edge > 0.482 => 0.62,
        0.0..0.04 => rim,
        0.04.. => 0.94,
        _ => 1.04,
    };
    tinted(own + 0.09 * grain, 0.04 * grain)
}

/// A frame around boards with a brace, 0.9 m on each side.
fn wooden_box(x: f32, y: f32) -> [f32; 3] {
    let [across, up] = [x, y].map(centred);
    let out = across.abs().max(up.abs());
    let (board, along) = piece(x + 0.5 - (x + 0.5) as u32 as f32, 6);
    let brace = (across - up).abs();
    let grain = lattice(x, y, [64, 6], 95) + 0.6 * lattice(x, y, [24, 3], 96);
    let own = match out {
        0.487.. => 1.25,
        0.385..0.487 => 1.08,
        0.365..0.385 => 0.55,
        _ if brace < 0.085 => 1.05,
        _ if brace < 0.11 => 0.6,
        _ => 0.66 + (0.24 + 0.16 * (hash(board, 0, 97) - 0.5)) * within(along, 0.14),
    };
    tinted(own + 0.08 * grain, 0.04 * grain)
}

/// Brushed metal with bands of reflections.
fn metal(x: f32, y: f32) -> [f32; 3] {
    let brushed = lattice(x, y, [4, 128], 98) + 0.6 * lattice(x, y, [8, 64], 99);
    let wave = lattice(x, y, [2, 8], 100) + 0.5 * lattice(x, y, [3, 16], 101);
    let own = 1.0 + 0.9 * wave + 0.1 * brushed;
    [own; 3]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> [Surface; 9] {
        let names = r#"["stone", "plaster", "cobbles", "noise", "brick", "plank", "tile", "stripes", "checker"]"#;
        serde_json::from_str(names).expect("every name is a surface")
    }

    /// The mean at every level is 1, and the coarsest level has no pattern, so that from a distance a surface has its plain
    /// colour.
    #[test]
    fn mean_of_every_surface_level_is_neutral() {
        for surface in all() {
            let tile = tile(surface).expect("the surface has a tile");
            let mut side = 1;
            while side <= SIDE {
                let level = &tile.texels[side * side..2 * side * side];
                for channel in 0..3 {
                    let sum: u32 = level.iter().map(|texel| texel >> (8 * channel) & 255).sum();
                    let mean = f64::from(sum) / level.len() as f64;
                    assert!((mean - 128.0).abs() < 0.6, "{surface:?} at side {side}: {mean}");
                }
                assert!(level.iter().all(|texel| texel >> 24 == 128));
                side *= 2;
            }
            assert_eq!(tile.texels[1], NEUTRAL, "{surface:?}");
            let differs = tile.texels[SIDE * SIDE..]
                .iter()
                .any(|texel| texel.abs_diff(NEUTRAL) & 255 > 20);
            assert!(differs, "{surface:?} is visible from nearby");
        }
        assert!(tile(Surface::Plain).is_none());
    }

    /// Texels match across the edges of a tile, so that no seam is visible.
    #[test]
    fn grain_repeats_without_a_seam() {
        let tile = tile(Surface::Noise).expect("the surface has a tile");
        let side = 32;
        let at = |x: usize, y: usize| i64::from(tile.texels[side * side + x * side + y] >> 8 & 255);
        let inside = (0..side).map(|y| (at(15, y) - at(16, y)).abs()).sum::<i64>();
        let across = (0..side).map(|y| (at(side - 1, y) - at(0, y)).abs()).sum::<i64>();
        assert!(across < 2 * inside + 64, "{across} beside {inside}");
    }
}
