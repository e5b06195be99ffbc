//! Computes sky and ground analytically: the distance of the ground and the colours of each row of an image.

use super::frame::{CATEGORY_MAP, CATEGORY_SKY};
use super::lanes::{Lanes, MAX_LANES};
use super::shade::{FULL_LEVEL, ROUNDING, Shader};
use super::view::View;
use crate::scene::Scene;

/// Side of the squares on the ground in metres.
pub(crate) const SQUARE: f32 = 2.0;

/// Contrast of the squares with the ground, and of the blocks of 8 × 8 squares.
pub(super) const CONTRAST: [f32; 2] = [0.045, 0.03];

/// How fast the contrast of squares and of blocks fades, per square that a pixel covers. It reaches 0 just before they are as
/// small as a pixel.
pub(super) const FADING: [f32; 2] = [1.3, 1.3 / 8.0];

/// The background of an image, row by row. Reused between images.
#[derive(Clone, Debug, Default)]
pub(super) struct Backdrop {
    /// Slope of the ray through each row: metres up per metre ahead.
    pub(super) rise: Vec<f32>,
    /// 1 / distance of the ground along the view axis; 0 in rows of sky.
    pub(super) ground: Vec<f32>,
    /// Packed pixels of each row: in rows of sky, the same in all four buffers; otherwise those of the ground's light and dark
    /// squares, first in light blocks, then in dark ones.
    pub(super) pixels: [Vec<u32>; 4],
    /// Colour of the fog, as levels 0 to 255.
    pub(super) fog_color: [f32; 3],
}

/// Values shared by all rows.
struct RowParams {
    height: f32,
    step: f32,
    ground: [f32; 3],
    zenith: [f32; 3],
    horizon: [f32; 3],
}

impl Backdrop {
    #[inline(always)]
    pub(super) fn prepare<L: Lanes>(&mut self, l: L, scene: &Scene, view: &View, shader: &Shader, rows: usize) {
        let padded = rows.next_multiple_of(MAX_LANES);
        for buffer in [&mut self.rise, &mut self.ground] {
            buffer.resize(padded, 0.0);
        }
        for pixels in &mut self.pixels {
            pixels.resize(padded, 0);
        }
        let [zenith, horizon] = shader.sky(scene.light.sky_color);
        let upward = shader.share([0.0, 0.0, 1.0]);
        let look = RowParams {
            height: view.position[2].max(0.01),
            step: view.step,
            ground: shader.in_light(scene.ground_color).map(|level| level * upward),
            zenith,
            horizon,
        };
        self.fog_color = horizon.map(|level| level.min(FULL_LEVEL));
        for first in (0..padded).step_by(L::N) {
            self.prepare_rows(l, view, &look, first);
        }
    }

    #[inline(always)]
    fn prepare_rows<L: Lanes>(&mut self, l: L, view: &View, look: &RowParams, first: usize) {
        let (zero, one) = (l.splat(0.0), l.splat(1.0));
        let row = l.add(l.count_up(), l.splat(first as f32));
        let middle = l.splat(view.size[1] / 2.0 - 0.5);
        let offset = l.mul(l.sub(middle, row), l.splat(look.step));
        let rise = l.mul_add(offset, l.splat(view.axes.up[2]), l.splat(view.axes.forward[2]));
        l.store(rise, &mut self.rise[first..]);
        let down = l.sub(zero, rise);
        let is_ground = l.above(down, zero);
        let ground = l.select(is_ground, l.div(down, l.splat(look.height)), zero);
        l.store(ground, &mut self.ground[first..]);

        let slope = l.max(rise, zero);
        let steepness = l.div(slope, l.root(l.mul_add(slope, slope, one)));
        let left = l.sub(one, steepness);
        let share = l.sub(one, l.mul(left, l.mul(left, left)));
        let sky = [
            lerp(l, share, look.horizon[0], look.zenith[0]),
            lerp(l, share, look.horizon[1], look.zenith[1]),
            lerp(l, share, look.horizon[2], look.zenith[2]),
        ];
        let sky = pack(l, sky, CATEGORY_SKY);

        // Number of squares that a pixel covers where its ray meets the ground.
        let metres = l.div(one, l.max(ground, l.splat(1e-6)));
        let blur = l.mul(l.mul(metres, metres), l.splat(look.step / (look.height * SQUARE)));
        let (fine, coarse) = (contrast(l, blur, 0), contrast(l, blur, 1));
        let (light, dark) = (l.add(one, fine), l.sub(one, fine));
        let shares = [
            l.add(light, coarse),
            l.add(dark, coarse),
            l.sub(light, coarse),
            l.sub(dark, coarse),
        ];
        for (pixels, share) in self.pixels.iter_mut().zip(shares) {
            let ground = [
                l.mul(share, l.splat(look.ground[0])),
                l.mul(share, l.splat(look.ground[1])),
                l.mul(share, l.splat(look.ground[2])),
            ];
            let ground = pack(l, ground, CATEGORY_MAP);
            l.store_words(l.select_words(is_ground, ground, sky), &mut pixels[first..]);
        }
    }
}

#[inline(always)]
fn lerp<L: Lanes>(l: L, share: L::Float, from: f32, to: f32) -> L::Float {
    l.mul_add(share, l.splat(to - from), l.splat(from))
}

/// Contrast of squares, or of blocks, where a pixel covers `blur` squares.
#[inline(always)]
fn contrast<L: Lanes>(l: L, blur: L::Float, which: usize) -> L::Float {
    let fade = l.sub(l.splat(1.0), l.mul(blur, l.splat(FADING[which])));
    l.mul(l.max(fade, l.splat(0.0)), l.splat(CONTRAST[which]))
}

/// Packs levels, capped at 255, into a word of bytes with a label.
#[inline(always)]
fn pack<L: Lanes>(l: L, levels: [L::Float; 3], label: u8) -> L::Word {
    let (red, green, blue) = (byte(l, levels[0]), byte(l, levels[1]), byte(l, levels[2]));
    let label = l.splat_word(u32::from(label) << 24);
    l.or(label, l.or(red, l.shift_byte(l.or(green, l.shift_byte(blue)))))
}

#[inline(always)]
fn byte<L: Lanes>(l: L, level: L::Float) -> L::Word {
    l.truncate(l.min(l.add(level, l.splat(ROUNDING)), l.splat(FULL_LEVEL)))
}
