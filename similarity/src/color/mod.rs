//! Distances between colours. How colours of many objects combine is in `world.rs`.

use driftworld_spec::Color;
use palette::color_difference::Ciede2000;
use palette::{FromColor, Lab, Oklab, Srgb};

/// Euclidean distance of the sRGB triples, as the L2Explorer paper takes it. A metric in `0..=√3`; blind to what people see.
pub fn srgb_distance(a: Color, b: Color) -> f64 {
    euclidean(a.0, b.0)
}

/// Euclidean distance in Oklab. A metric; 0 to 1 between black and white, below 1 for all pairs of sRGB colours.
///
/// Source: Ottosson 2020, "A perceptual color space for image processing".
///
/// # Example
/// ```
/// use driftworld_similarity::oklab_distance;
/// use driftworld_spec::Color;
/// let (black, white) = (Color([0.0; 3]), Color([1.0; 3]));
/// assert!((oklab_distance(black, white) - 1.0).abs() < 1e-6);
/// ```
pub fn oklab_distance(a: Color, b: Color) -> f64 {
    euclidean(oklab(a), oklab(b))
}

/// Lightness, green to red, blue to yellow.
pub(crate) fn oklab(color: Color) -> [f64; 3] {
    let oklab = Oklab::from_color(srgb(color).into_linear());
    [oklab.l, oklab.a, oklab.b]
}

/// CIEDE2000, the industry's formula for small differences: 1 is just noticeable, black to white is 100.
///
/// Not a metric: the triangle inequality fails for some triples.
pub fn ciede2000(a: Color, b: Color) -> f64 {
    let lab = |color: Color| Lab::<palette::white_point::D65, f64>::from_color(srgb(color));
    lab(a).difference(lab(b))
}

fn srgb(color: Color) -> Srgb<f64> {
    Srgb::new(color.0[0], color.0[1], color.0[2])
}

fn euclidean(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn color() -> impl Strategy<Value = Color> {
        prop::array::uniform3(0.0..=1.0).prop_map(Color)
    }

    #[test]
    fn known_pairs_have_their_known_distances() {
        let (black, white) = (Color([0.0; 3]), Color([1.0; 3]));
        assert!((ciede2000(black, white) - 100.0).abs() < 1e-3);
        assert!((srgb_distance(black, white) - 3.0_f64.sqrt()).abs() < 1e-12);
        // By scikit-image 0.25: deltaE_ciede2000(rgb2lab(red), rgb2lab(blue)).
        let (red, blue) = (Color([1.0, 0.0, 0.0]), Color([0.0, 0.0, 1.0]));
        assert!((ciede2000(red, blue) - 52.881).abs() < 0.02, "{}", ciede2000(red, blue));
    }

    proptest! {
        #[test]
        fn the_metrics_are_metrics(a in color(), b in color(), c in color()) {
            for distance in [srgb_distance, oklab_distance] {
                prop_assert_eq!(distance(a, a), 0.0);
                prop_assert_eq!(distance(a, b), distance(b, a));
                prop_assert!(distance(a, c) <= distance(a, b) + distance(b, c) + 1e-12);
                prop_assert!(distance(a, b) >= 0.0);
            }
            prop_assert!(oklab_distance(a, b) <= 1.0 + 1e-6);
        }

        #[test]
        fn ciede2000_is_symmetric_and_zero_on_itself(a in color(), b in color()) {
            prop_assert!(ciede2000(a, a).abs() < 1e-9);
            prop_assert!((ciede2000(a, b) - ciede2000(b, a)).abs() < 1e-9);
        }
    }
}
