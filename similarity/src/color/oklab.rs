//! [`Oklab`] and the distance in it. Pictures are compared with it in `picture/`.

use driftworld_spec::Color;

use crate::color::euclidean;
use crate::color::lab::linear;

/// Linear sRGB to the answers of the eye's three kinds of cones.
const CONES_FROM_RGB: [[f64; 3]; 3] = [
    [0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9],
    [0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6],
    [0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5],
];

/// The cube roots of those to lightness, green to red, blue to yellow.
const OKLAB_FROM_ROOTS: [[f64; 3]; 3] = [
    [0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8],
    [1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9],
    [0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0],
];

/// A colour in Oklab: lightness 0 to 1, a from green to red, b from blue to yellow, both about ±0.3 for sRGB.
///
/// Made once per colour, so that matrices of distances do not convert again.
///
/// Source: Ottosson 2020, "A perceptual color space for image processing", with the matrices of 2021.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Oklab(pub [f64; 3]);

impl From<Color> for Oklab {
    fn from(color: Color) -> Self {
        Self::from_linear(color.0.map(linear))
    }
}

impl Oklab {
    /// From amounts of light, each in 0..=1.
    pub(crate) fn from_linear(rgb: [f64; 3]) -> Self {
        Self(times(&OKLAB_FROM_ROOTS, times(&CONES_FROM_RGB, rgb).map(libm::cbrt)))
    }

    /// Euclidean distance to another colour.
    pub fn distance(self, other: Self) -> f64 {
        euclidean(self.0, other.0)
    }
}

fn times(matrix: &[[f64; 3]; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * x + row[1] * y + row[2] * z)
}

/// Euclidean distance in Oklab: √(ΔL² + Δa² + Δb²). About 0.02 is just noticeable.
///
/// A metric; 1 between black and white, which no two sRGB colours exceed; no unit. Mostly the cost of six cube roots and six powers;
/// none between colours that are [`Oklab`] already.
///
/// Source: Ottosson 2020; within 1e-4 of colour-science's `XYZ_to_Oklab`, which rounds its matrices elsewhere, see
/// `tests/oracle/color.json`.
///
/// # Example
/// ```
/// use driftworld_similarity::oklab_distance;
/// use driftworld_spec::Color;
/// let (black, white) = (Color([0.0; 3]), Color([1.0; 3]));
/// assert!((oklab_distance(black, white) - 1.0).abs() < 1e-6);
/// ```
pub fn oklab_distance(a: Color, b: Color) -> f64 {
    Oklab::from(a).distance(Oklab::from(b))
}
