//! [`Lab`]: a colour in CIE L*a*b*, where distances are closer to perception than in sRGB.

use driftworld_spec::{Color, linear_from_srgb};

/// Linear sRGB to CIE XYZ (ITU-R BT.709 primaries, D65), rounded as in scikit-image.
const XYZ_FROM_RGB: [[f64; 3]; 3] = [
    [0.412_453, 0.357_580, 0.180_423],
    [0.212_671, 0.715_160, 0.072_169],
    [0.019_334, 0.119_193, 0.950_227],
];

/// XYZ of the D65 white point, for the 2° observer.
const WHITE: [f64; 3] = [0.950_47, 1.0, 1.088_83];

/// A colour in CIE L*a*b* under D65: lightness 0 to 100, a* from green to red, b* from blue to yellow, both about ±110 for sRGB.
///
/// Convert each colour once to avoid repeated conversions in matrices of distances. Numbers must be finite and at most 1e6 in
/// magnitude; beyond that, distances lose their meaning.
///
/// Source: CIE 15, with the matrix and the white of scikit-image: the same numbers as `skimage.color.rgb2lab` within 1e-9. (Other tools
/// round these constants differently and differ by up to 0.02.)
///
/// # Example
/// ```
/// use driftworld_similarity::Lab;
/// use driftworld_spec::Color;
/// let Lab([lightness, a, b]) = Lab::from(Color([1.0, 0.0, 0.0]));
/// assert!((lightness - 53.2406).abs() < 1e-4 && (a - 80.0923).abs() < 1e-4 && (b - 67.2028).abs() < 1e-4);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lab(pub [f64; 3]);

impl From<Color> for Lab {
    fn from(color: Color) -> Self {
        let rgb = color.0.map(linear_from_srgb);
        let row = |k: usize| XYZ_FROM_RGB[k][0] * rgb[0] + XYZ_FROM_RGB[k][1] * rgb[1] + XYZ_FROM_RGB[k][2] * rgb[2];
        let [x, y, z] = [0, 1, 2].map(|k| compressed(row(k) / WHITE[k]));
        Self([116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)])
    }
}

impl Lab {
    /// Distance from the grey of the same lightness.
    pub fn chroma(self) -> f64 {
        (self.0[1] * self.0[1] + self.0[2] * self.0[2]).sqrt()
    }
}

/// The cube root, but linear near black.
fn compressed(share: f64) -> f64 {
    if share > 0.008_856 {
        libm::cbrt(share)
    } else {
        7.787 * share + 16.0 / 116.0
    }
}
