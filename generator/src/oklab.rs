//! Colours between two colours, in Oklab, through `libm`. Distances between colours are `similarity`'s.
//!
//! Written here beside the palette crate's conversion because what a drift draws must have the same bits on every platform.

use driftworld_spec::Color;

/// The colour at fraction `t` of the straight line between two colours in Oklab; where that leaves what a screen can show,
/// each channel is cut off. Source: Ottosson 2020.
pub(crate) fn between(from: Color, to: Color, t: f64) -> Color {
    let (a, b) = (from.to_oklab(), to.to_oklab());
    to_srgb(std::array::from_fn(|k| a[k] + (b[k] - a[k]) * t))
}

type Matrix = [[f64; 3]; 3];

fn times(matrix: &Matrix, v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

const ROOTS_FROM_LAB: Matrix = [
    [1.0, 0.396_337_777_4, 0.215_803_757_3],
    [1.0, -0.105_561_345_8, -0.063_854_172_8],
    [1.0, -0.089_484_177_5, -1.291_485_548_0],
];

const LINEAR_FROM_LMS: Matrix = [
    [4.076_741_662_1, -3.307_711_591_3, 0.230_969_929_2],
    [-1.268_438_004_6, 2.609_757_401_1, -0.341_319_396_5],
    [-0.004_196_086_3, -0.703_418_614_7, 1.707_614_701_0],
];

fn to_srgb(lab: [f64; 3]) -> Color {
    let linear = times(
        &LINEAR_FROM_LMS,
        times(&ROOTS_FROM_LAB, lab).map(|root| root * root * root),
    );
    let encode = |c: f64| {
        if c <= 0.003_130_8 {
            12.92 * c
        } else {
            1.055 * libm::pow(c, 1.0 / 2.4) - 0.055
        }
    };
    Color(linear.map(|c| encode(c).clamp(0.0, 1.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_come_back_and_the_middle_of_black_and_white_is_middle_grey() {
        let colors = ["red", "green", "blue", "white", "black", "gold", "rebeccapurple"];
        for color in colors.map(|name| Color::from_name(name).unwrap()) {
            let back = between(color, color, 0.3);
            assert!(
                color.0.iter().zip(back.0).all(|(a, b)| (a - b).abs() < 1e-6),
                "{color:?}: {back:?}"
            );
        }
        let grey = between(Color([0.0; 3]), Color([1.0; 3]), 0.5);
        assert!(
            grey.0.iter().all(|channel| (channel - 0.388_57).abs() < 1e-4),
            "{grey:?}"
        );
    }

    #[test]
    fn lightness_changes_evenly_between_blue_and_yellow() {
        let (blue, yellow) = (Color([0.0, 0.0, 1.0]), Color([1.0, 1.0, 0.0]));
        let steps: Vec<f64> = (0..=4)
            .map(|k| between(blue, yellow, f64::from(k) / 4.0).to_oklab()[0])
            .collect();
        for pair in steps.windows(2) {
            assert!(
                (pair[1] - pair[0] - (steps[4] - steps[0]) / 4.0).abs() < 0.01,
                "{steps:?}"
            );
        }
    }
}
