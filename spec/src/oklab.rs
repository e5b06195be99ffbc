//! [`Oklab`]: a colour space whose Euclidean distance follows perception. Uses `libm`, so that results are
//! identical on every platform.

use crate::Color;

type Matrix = [[f64; 3]; 3];

/// From linear sRGB to the responses of the eye's three kinds of cones.
const CONES_FROM_LINEAR: Matrix = [
    [0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9],
    [0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6],
    [0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5],
];

/// From the cube roots of the cone responses to lightness, green–red and blue–yellow.
const LAB_FROM_ROOTS: Matrix = [
    [0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8],
    [1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9],
    [0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0],
];

const ROOTS_FROM_LAB: Matrix = [
    [1.0, 0.396_337_777_4, 0.215_803_757_3],
    [1.0, -0.105_561_345_8, -0.063_854_172_8],
    [1.0, -0.089_484_177_5, -1.291_485_548_0],
];

const LINEAR_FROM_CONES: Matrix = [
    [4.076_741_662_1, -3.307_711_591_3, 0.230_969_929_2],
    [-1.268_438_004_6, 2.609_757_401_1, -0.341_319_396_5],
    [-0.004_196_086_3, -0.703_418_614_7, 1.707_614_701_0],
];

/// A colour in Oklab: lightness 0 to 1, a from green to red, b from blue to yellow, both about ±0.3 for sRGB.
///
/// Convert each colour once, to avoid repeated conversions in distance matrices.
///
/// Source: Ottosson 2020, "A perceptual color space for image processing", with the matrices of 2021.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Oklab(pub [f64; 3]);

impl From<Color> for Oklab {
    #[inline]
    fn from(color: Color) -> Self {
        Self::from_linear(color.0.map(linear_from_srgb))
    }
}

impl Oklab {
    /// From linear sRGB: amounts of light, each in 0..=1.
    #[inline]
    pub fn from_linear(rgb: [f64; 3]) -> Self {
        Self(times(&LAB_FROM_ROOTS, times(&CONES_FROM_LINEAR, rgb).map(libm::cbrt)))
    }

    /// Euclidean distance to another colour: 0 if equal, about 0.02 just noticeable.
    #[inline]
    pub fn distance(self, other: Self) -> f64 {
        let [x, y, z] = std::array::from_fn(|k| self.0[k] - other.0[k]);
        (x * x + y * y + z * z).sqrt()
    }

    /// The colour in sRGB, with each channel clipped to what a screen can show.
    fn to_srgb(self) -> Color {
        let cones = times(&ROOTS_FROM_LAB, self.0).map(|root| root * root * root);
        Color(times(&LINEAR_FROM_CONES, cones).map(|light| srgb_from_linear(light).clamp(0.0, 1.0)))
    }
}

impl Color {
    /// Euclidean distance in [`Oklab`]: 0 for equal colours, about 0.02 just noticeable, 1 between black and white, the
    /// maximum.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::Color;
    /// let named = |name| Color::from_name(name).unwrap();
    /// assert!((named("black").distance(named("white")) - 1.0).abs() < 1e-6);
    /// assert!(named("gold").distance(named("orange")) < 0.15);
    /// ```
    pub fn distance(self, other: Self) -> f64 {
        Oklab::from(self).distance(Oklab::from(other))
    }

    /// The colour at fraction `t` of the straight line to another in [`Oklab`]; each channel is clipped to what a
    /// screen can show.
    #[must_use]
    pub fn mix(self, other: Self, t: f64) -> Self {
        let (from, to) = (Oklab::from(self).0, Oklab::from(other).0);
        Oklab(std::array::from_fn(|k| from[k] + (to[k] - from[k]) * t)).to_srgb()
    }
}

/// The amount of light of an sRGB channel: inverts its transfer curve (IEC 61966-2-1). Both are in 0..=1.
#[inline]
pub fn linear_from_srgb(channel: f64) -> f64 {
    if channel <= 0.040_45 {
        channel / 12.92
    } else {
        libm::pow((channel + 0.055) / 1.055, 2.4)
    }
}

/// The sRGB channel of an amount of light.
#[inline]
pub fn srgb_from_linear(light: f64) -> f64 {
    if light <= 0.003_130_8 {
        12.92 * light
    } else {
        1.055 * libm::pow(light, 1.0 / 2.4) - 0.055
    }
}

#[inline]
fn times(matrix: &Matrix, v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mix_of_a_colour_with_itself_is_unchanged_and_of_black_and_white_is_grey() {
        let colors = ["red", "green", "blue", "white", "black", "gold", "rebeccapurple"];
        for color in colors.map(|name| Color::from_name(name).unwrap()) {
            let back = color.mix(color, 0.3);
            assert!(
                color.0.iter().zip(back.0).all(|(a, b)| (a - b).abs() < 1e-6),
                "{color:?}: {back:?}"
            );
        }
        let grey = Color([0.0; 3]).mix(Color([1.0; 3]), 0.5);
        assert!(
            grey.0.iter().all(|channel| (channel - 0.388_57).abs() < 1e-4),
            "{grey:?}"
        );
    }

    #[test]
    fn lightness_changes_evenly_between_blue_and_yellow() {
        let (blue, yellow) = (Color([0.0, 0.0, 1.0]), Color([1.0, 1.0, 0.0]));
        let steps: Vec<f64> = (0..=4)
            .map(|k| blue.mix(yellow, f64::from(k) / 4.0))
            .map(|color| Oklab::from(color).0[0])
            .collect();
        for pair in steps.windows(2) {
            assert!(
                (pair[1] - pair[0] - (steps[4] - steps[0]) / 4.0).abs() < 0.01,
                "{steps:?}"
            );
        }
    }
}
