//! The learner's features: the share of each colour in each part of a small image.

use std::sync::LazyLock;

use crate::render::{CpuRenderer, Target};
use crate::sim::Environment;

/// Height and width of the image in pixels.
const SIDE: usize = 42;
/// Columns into which the image is divided.
const COLUMNS: usize = 7;
/// The first row of each band, and the end of the last: above the horizon, just below it, near the feet.
const BANDS: [usize; 4] = [0, 21, 27, SIDE];
/// Six hues, then dark and bright without hue.
const COLORS: usize = 8;

/// Number of features: a share for each colour in each cell, then a constant 1.
pub(super) const FEATURES: usize = COLUMNS * (BANDS.len() - 1) * COLORS + 1;

/// Renders a small image of the agent's view and counts colours.
#[derive(Default)]
pub(super) struct Eye {
    renderer: CpuRenderer,
    rgb: Vec<u8>,
}

impl Eye {
    /// Square roots of the shares of each cell that each colour covers, 0 to 1. The root gives small patches more weight.
    pub(super) fn look(&mut self, environment: &Environment) -> [f32; FEATURES] {
        self.rgb.resize(SIDE * SIDE * 3, 0);
        let mut target = Target::of_colors([SIDE as u32, SIDE as u32], &mut self.rgb);
        let rendered = self
            .renderer
            .draw(environment.scene(), &environment.camera(), &mut target);
        rendered.expect("the image size is valid");
        shares(&self.rgb)
    }
}

/// Features of an image of `SIDE` × `SIDE` pixels.
fn shares(rgb: &[u8]) -> [f32; FEATURES] {
    let mut features = [0.0; FEATURES];
    for (band, rows) in BANDS.windows(2).enumerate() {
        let mut counts = [0_u16; COLUMNS * COLORS];
        let lines = &rgb[rows[0] * SIDE * 3..rows[1] * SIDE * 3];
        for line in lines.chunks_exact(SIDE * 3) {
            for (column, pixels) in line.chunks_exact(SIDE / COLUMNS * 3).enumerate() {
                for pixel in pixels.chunks_exact(3) {
                    counts[column * COLORS + color([pixel[0], pixel[1], pixel[2]])] += 1;
                }
            }
        }
        let pixels = ((rows[1] - rows[0]) * SIDE / COLUMNS) as f32;
        let own = &mut features[band * counts.len()..(band + 1) * counts.len()];
        for (feature, count) in own.iter_mut().zip(counts) {
            *feature = (f32::from(count) / pixels).sqrt();
        }
    }
    features[FEATURES - 1] = 1.0;
    features
}

/// The index of a colour, from a table over the five highest bits of each channel.
fn color([r, g, b]: [u8; 3]) -> usize {
    static TABLE: LazyLock<Box<[u8]>> = LazyLock::new(|| {
        let level = |bits: usize| (bits & 31) as i32 * 8 + 4;
        (0..1 << 15)
            .map(|k: usize| color_class([level(k >> 10), level(k >> 5), level(k)]))
            .collect()
    });
    let five = |byte: u8| usize::from(byte >> 3);
    usize::from(TABLE[five(r) << 10 | five(g) << 5 | five(b)])
}

/// Hue in sixths of the circle, 0 to 5 around red, yellow, green, cyan, blue and magenta; colours with little hue are 6 if dark
/// and 7 if bright.
fn color_class([r, g, b]: [i32; 3]) -> u8 {
    let (max, min) = (r.max(g).max(b), r.min(g).min(b));
    let chroma = max - min;
    if chroma * 5 < max * 2 || max < 16 {
        return if max < 128 { 6 } else { 7 };
    }
    let degrees = if max == r {
        60 * (g - b) / chroma
    } else if max == g {
        60 * (b - r) / chroma + 120
    } else {
        60 * (r - g) / chroma + 240
    };
    ((degrees + 390).rem_euclid(360) / 60) as u8
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn colours_are_classified_by_hue_and_greys_by_brightness() {
        let pure = [
            [255, 0, 0],
            [255, 255, 0],
            [0, 255, 0],
            [0, 255, 255],
            [0, 0, 255],
            [255, 0, 255],
            [60, 60, 60],
            [230, 230, 230],
        ];
        assert_eq!(pure.map(color), [0, 1, 2, 3, 4, 5, 6, 7]);
        // In dim light the hue stays the same, down to the darkest.
        assert_eq!([[60, 0, 0], [0, 60, 0], [0, 0, 60]].map(color), [0, 2, 4]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// The colours' shares of a cell sum to 1, and so do the squares of its features.
        #[test]
        fn squares_of_a_cells_features_sum_to_one(rgb in proptest::collection::vec(0_u8..=255, SIDE * SIDE * 3)) {
            let features = shares(&rgb);
            for cell in features[..FEATURES - 1].chunks(COLORS) {
                let whole: f32 = cell.iter().map(|x| x * x).sum();
                prop_assert!((whole - 1.0).abs() < 1e-5, "{}", whole);
            }
        }

        /// A pixel affects only the cell that contains it.
        #[test]
        fn pixel_changes_only_its_own_cell(row in 0..SIDE, x in 0..SIDE) {
            let grey = vec![200_u8; SIDE * SIDE * 3];
            let mut one_pixel_changed = grey.clone();
            one_pixel_changed[(row * SIDE + x) * 3 + 1] = 0;
            one_pixel_changed[(row * SIDE + x) * 3 + 2] = 0;
            let (without, with) = (shares(&grey), shares(&one_pixel_changed));
            let band = [21, 27].iter().filter(|first| row >= **first).count();
            let cell = band * COLUMNS + x / 6;
            for k in 0..FEATURES {
                let changes = k / COLORS == cell && [0, 7].contains(&(k % COLORS));
                prop_assert_eq!(without[k] != with[k], changes, "number {}", k);
            }
        }
    }
}
