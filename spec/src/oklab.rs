//! Colours in Oklab, and how far apart two are there, through `libm`: what a requirement says must be the same on every platform.
//! Other measures of colours are `similarity`'s.

use crate::Color;

type Matrix = [[f64; 3]; 3];

/// Linear sRGB to the answers of the eye's three kinds of cones.
const CONES_FROM_LINEAR: Matrix = [
    [0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9],
    [0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6],
    [0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5],
];

/// The cube roots of those to lightness, green to red, blue to yellow.
const LAB_FROM_ROOTS: Matrix = [
    [0.210_454_255_3, 0.793_617_785_0, -0.004_072_046_8],
    [1.977_998_495_1, -2.428_592_205_0, 0.450_593_709_9],
    [0.025_904_037_1, 0.782_771_766_2, -0.808_675_766_0],
];

impl Color {
    /// Lightness 0 to 1, a from green to red, b from blue to yellow, both about ±0.3. Source: Ottosson 2020.
    pub fn to_oklab(self) -> [f64; 3] {
        let linear = self.0.map(|c| {
            if c <= 0.040_45 {
                c / 12.92
            } else {
                libm::pow((c + 0.055) / 1.055, 2.4)
            }
        });
        times(&LAB_FROM_ROOTS, times(&CONES_FROM_LINEAR, linear).map(libm::cbrt))
    }

    /// Euclidean distance in Oklab: 0 for equal colours, about 0.02 just noticeable, 1 between black and white, which no two colours
    /// exceed.
    ///
    /// # Example
    /// ```
    /// use driftworld_spec::Color;
    /// let named = |name| Color::from_name(name).unwrap();
    /// assert!((named("black").distance(named("white")) - 1.0).abs() < 1e-6);
    /// assert!(named("gold").distance(named("orange")) < 0.15);
    /// ```
    pub fn distance(self, other: Self) -> f64 {
        let (a, b) = (self.to_oklab(), other.to_oklab());
        let squares: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
        squares.sqrt()
    }
}

fn times(matrix: &Matrix, v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}
