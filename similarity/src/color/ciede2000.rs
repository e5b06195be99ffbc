//! CIEDE2000, the industry-standard formula for small colour differences.

use crate::color::lab::Lab;

/// The largest distance between two sRGB colours, rounded up: a dark blue (0, 0, 0.4303) and a yellowish green (0.5589, 1, 0).
pub(crate) const CIEDE2000_DIAMETER: f64 = 119.484_76;

/// 25 to the 7th.
const POW_25_7: f64 = 6_103_515_625.0;

/// If the product of two chromas is below this, their hue difference changes the result by at most 2e-15.
const GREY: f64 = 1e-30;

/// Cosine and sine of the formula's rotation angles: 30°, 6°, 63° and 275°.
const TURN_30: [f64; 2] = [0.866_025_403_784_438_6, 0.5];
const TURN_6: [f64; 2] = [0.994_521_895_368_273_3, 0.104_528_463_267_653_46];
const TURN_63: [f64; 2] = [0.453_990_499_739_546_8, 0.891_006_524_188_367_9];
const TURN_275: [f64; 2] = [0.087_155_742_747_658_18, -0.996_194_698_091_745_5];

/// The perceived difference between two colours, by CIEDE2000 with all weights 1: about 1 is just noticeable, black to white is
/// 100.
///
/// A distance, *not a metric*: about one triple of sRGB colours in 30 violates the triangle inequality, in the worst known case
/// by almost half. From 0 to 119.49 within sRGB, no unit. The formula is discontinuous where the hues of two colours are
/// exactly opposite; a grey takes the hue of the other colour.
///
/// Hues enter only through their cosines and sines, so no trigonometric function is needed.
///
/// Source: Sharma, Wu and Dalal 2005, "The CIEDE2000 color-difference formula: implementation notes, supplementary test data,
/// and mathematical observations"; agrees with their 34 pairs within 1e-4 and with `skimage.color.deltaE_ciede2000` within
/// 1e-9, see `tests/oracle/color.json`.
///
/// # Example
/// ```
/// use driftworld_similarity::{Lab, ciede2000};
/// let (a, b) = (Lab([50.0, 2.6772, -79.7751]), Lab([50.0, 0.0, -82.7485]));
/// assert!((ciede2000(a, b) - 2.0425).abs() < 1e-4);
/// ```
pub fn ciede2000(a: impl Into<Lab>, b: impl Into<Lab>) -> f64 {
    let (a, b) = (a.into(), b.into());
    between(a.0, a.chroma(), b.0, b.chroma())
}

fn between([l1, a1, b1]: [f64; 3], chroma1: f64, [l2, a2, b2]: [f64; 3], chroma2: f64) -> f64 {
    // Stretches greys along a*.
    let stretch = 1.5 - 0.5 * saturation((chroma1 + chroma2) * 0.5);
    let (a1, a2) = (a1 * stretch, a2 * stretch);
    let (c1, c2) = ((a1 * a1 + b1 * b1).sqrt(), (a2 * a2 + b2 * b2).sqrt());
    let mean_chroma = (c1 + c2) * 0.5;

    let (product, dot, cross) = (c1 * c2, a1 * a2 + b1 * b2, a1 * b2 - a2 * b1);
    // The shorter turn from the second hue to the first; for opposite hues, from the lesser angle to the greater.
    let ahead = if b1 > 0.0 || (b1 == 0.0 && a1 > 0.0) { 1.0 } else { -1.0 };
    let sign = if cross > 0.0 {
        1.0
    } else if cross < 0.0 {
        -1.0
    } else {
        ahead
    };
    // The half angle between the hues has the sine `root / (2 √product)` if they are more than a right angle apart, else that
    // is its cosine: each is used where it is exact.
    let root = (2.0 * (product + dot.abs())).sqrt();
    let near = dot >= 0.0;
    let grey = product < GREY;
    let scale = 1.0 / (if grey { 1.0 } else { product.sqrt() * root });
    let hue = if near {
        2.0 * cross * product.sqrt() * scale
    } else {
        sign * root
    };
    let hue = if grey { 0.0 } else { hue };
    // The direction midway between the two hues: their sum, or the perpendicular of their difference.
    let (across, along) = (a1 * c2 - a2 * c1, b1 * c2 - b2 * c1);
    let cos = if near { a1 * c2 + a2 * c1 } else { -sign * along } * scale;
    let sin = if near { b1 * c2 + b2 * c1 } else { sign * across } * scale;

    let from_middle = ((l1 + l2) * 0.5 - 50.0) * ((l1 + l2) * 0.5 - 50.0);
    let middle_root = (20.0 + from_middle).sqrt();
    // Combines all divisors into one.
    let (lightness_scale, chroma_scale) = (middle_root + 0.015 * from_middle, 1.0 + 0.045 * mean_chroma);
    let hue_scale = 1.0 + 0.015 * mean_chroma * hue_weight(cos, sin);
    let seventh = seventh_power(mean_chroma);
    let (first, second) = (chroma_scale * hue_scale, lightness_scale * (seventh + POW_25_7));
    let (by_first, by_second) = {
        let by_both = 1.0 / (first * second);
        (by_both * second, by_both * first)
    };
    let lightness = (l2 - l1) * middle_root * (seventh + POW_25_7) * by_second;
    let chroma = (c2 - c1) * hue_scale * by_first;
    let hue = hue * chroma_scale * by_first;
    let saturation = (seventh * lightness_scale * by_second).sqrt();
    let rotation = 2.0 * saturation * blue_rotation(cos, sin);
    let square = lightness * lightness + chroma * chroma + hue * hue - rotation * chroma * hue;
    square.max(0.0).sqrt()
}

/// √(C⁷ / (C⁷ + 25⁷)): from 0 for greys to 1 for strong colours.
fn saturation(chroma: f64) -> f64 {
    let seventh = seventh_power(chroma);
    (seventh / (seventh + POW_25_7)).sqrt()
}

fn seventh_power(x: f64) -> f64 {
    let square = x * x;
    square * square * square * x
}

/// T of the formula: the weight of a hue difference around this hue. Multiples of the angle are computed from its cosine and
/// sine.
fn hue_weight(cos: f64, sin: f64) -> f64 {
    let (cos_2, sin_2) = (2.0 * cos * cos - 1.0, 2.0 * sin * cos);
    let (cos_3, sin_3) = (cos_2 * cos - sin_2 * sin, sin_2 * cos + cos_2 * sin);
    let (cos_4, sin_4) = (2.0 * cos_2 * cos_2 - 1.0, 2.0 * sin_2 * cos_2);
    1.0 - 0.17 * (cos * TURN_30[0] + sin * TURN_30[1]) + 0.24 * cos_2 + 0.32 * (cos_3 * TURN_6[0] - sin_3 * TURN_6[1])
        - 0.20 * (cos_4 * TURN_63[0] + sin_4 * TURN_63[1])
}

/// sin(2 Δθ) of the formula: the interaction of chroma and hue, a bump 25° wide around the blue at 275°.
///
/// Absolute error below 1e-11.
fn blue_rotation(cos: f64, sin: f64) -> f64 {
    // The square of the angle to 275° is a series in 1 − cosine: arccos²(1 − u) = 2 Σ (2u)ⁿ / (n² · (2n choose n)). Far from
    // 275° the truncated series is too small by at most a sixth, where the bump is below 1e-15.
    let u = 1.0 - (cos * TURN_275[0] + sin * TURN_275[1]);
    let mut square = 0.0;
    for factor in ARCCOS.iter().rev() {
        square = (square + factor) * u;
    }
    // exp(−x) = exp(−x / 64)⁶⁴, in radians: 25° are 0.436.
    let x = square * (1.0 / (0.436_332_312_998_582_4 * 0.436_332_312_998_582_4 * 64.0));
    let mut bump = 0.0;
    for factor in EXP.iter().rev() {
        bump = bump * -x + factor;
    }
    for _ in 0..6 {
        bump *= bump;
    }
    // The formula counts hues from 0° to 360° and ignores that 0° is also near 275° the other way round. A hue of 0° counts as
    // 0° even if rounding turns it to just below 360°.
    let bump = if sin > -1e-14 && cos > 0.0 { 0.0 } else { bump };
    let angle = bump * std::f64::consts::FRAC_PI_3;
    let mut sine = 0.0;
    for factor in SIN.iter().rev() {
        sine = sine * -(angle * angle) + factor;
    }
    sine * angle
}

/// 2 · 2ⁿ / (n² · (2n choose n)), from n = 1.
const ARCCOS: [f64; 16] = {
    let mut factors = [0.0; 16];
    // 2ⁿ / (2n choose n)
    let mut ratio = 1.0;
    let mut n = 1;
    while n <= 16 {
        let count = n as f64;
        ratio *= count / (2.0 * count - 1.0);
        factors[n - 1] = 2.0 * ratio / (count * count);
        n += 1;
    }
    factors
};

/// 1 / n!, from n = 0.
const EXP: [f64; 7] = {
    let mut factors = [1.0; 7];
    let mut n = 1;
    while n < 7 {
        factors[n] = factors[n - 1] / n as f64;
        n += 1;
    }
    factors
};

/// 1 / (2n + 1)!, from n = 0.
const SIN: [f64; 7] = {
    let mut factors = [1.0; 7];
    let mut n = 1;
    while n < 7 {
        factors[n] = factors[n - 1] / ((2 * n) as f64 * (2 * n + 1) as f64);
        n += 1;
    }
    factors
};

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn lab() -> impl Strategy<Value = Lab> {
        (0.0..=100.0, -110.0..110.0, -110.0..110.0).prop_map(|(l, a, b)| Lab([l, a, b]))
    }

    /// The formula as published, with angles.
    fn as_written(x: Lab, y: Lab) -> f64 {
        let ([l1, a1, b1], [l2, a2, b2]) = (x.0, y.0);
        let sin = |degrees: f64| libm::sin(degrees.to_radians());
        let cos = |degrees: f64| libm::cos(degrees.to_radians());
        let g = 0.5 * (1.0 - saturation(f64::midpoint(libm::hypot(a1, b1), libm::hypot(a2, b2))));
        let polar = |a: f64, b: f64| {
            let a = a * (1.0 + g);
            let hue = libm::atan2(b, a).to_degrees().rem_euclid(360.0);
            (libm::hypot(a, b), hue)
        };
        let ((c1, h1), (c2, h2)) = (polar(a1, b1), polar(a2, b2));
        let (gap, grey) = (h2 - h1, c1 * c2 == 0.0);
        let turn = match gap {
            _ if grey => 0.0,
            gap if gap > 180.0 => gap - 360.0,
            gap if gap < -180.0 => gap + 360.0,
            gap => gap,
        };
        let hue = match h1 + h2 {
            sum if grey => sum,
            sum if gap.abs() <= 180.0 => sum / 2.0,
            sum if sum < 360.0 => f64::midpoint(sum, 360.0),
            sum => (sum - 360.0) / 2.0,
        };
        let t = 1.0 - 0.17 * cos(hue - 30.0) + 0.24 * cos(2.0 * hue) + 0.32 * cos(3.0 * hue + 6.0)
            - 0.20 * cos(4.0 * hue - 63.0);
        let (l, c) = (f64::midpoint(l1, l2) - 50.0, f64::midpoint(c1, c2));
        let lightness = (l2 - l1) / (1.0 + 0.015 * l * l / (20.0 + l * l).sqrt());
        let chroma = (c2 - c1) / (1.0 + 0.045 * c);
        let turned = 2.0 * (c1 * c2).sqrt() * sin(turn / 2.0) / (1.0 + 0.015 * c * t);
        let theta = 30.0 * libm::exp(-((hue - 275.0) / 25.0) * ((hue - 275.0) / 25.0));
        let rotation = -2.0 * saturation(c) * sin(2.0 * theta);
        let square = lightness * lightness + chroma * chroma + turned * turned + rotation * chroma * turned;
        square.max(0.0).sqrt()
    }

    #[track_caller]
    fn check(a: [f64; 3], b: [f64; 3]) {
        let (found, expected) = (ciede2000(Lab(a), Lab(b)), as_written(Lab(a), Lab(b)));
        assert!(
            (found - expected).abs() < 1e-9,
            "{a:?} to {b:?}: {found}, expected {expected}"
        );
    }

    #[test]
    fn greys_and_opposite_hues_match_the_formula() {
        check([50.0, 0.0, 0.0], [50.0, 0.0, 0.0]);
        check([50.0, 0.0, 0.0], [60.0, 20.0, -30.0]);
        check([50.0, 20.0, -30.0], [60.0, 0.0, 0.0]);
        // Exactly opposite hues, in both orders.
        for (a, b) in [(2.5, 0.0), (0.0, 2.5), (1.5, -2.0), (-1.5, -2.0), (3.0, 4.0)] {
            check([50.0, a, b], [50.0, -a, -b]);
        }
        // The hue between them is 0°, or just below 360°.
        check([50.0, 40.0, 8.0], [70.0, 60.0, -12.0]);
        check([50.0, 40.0, 8.0], [70.0, 60.0, -12.1]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn fast_form_equals_the_published_formula(a in lab(), b in lab()) {
            prop_assert!((ciede2000(a, b) - as_written(a, b)).abs() < 1e-9);
        }

        #[test]
        fn ciede2000_is_symmetric_and_zero_on_itself(a in lab(), b in lab()) {
            prop_assert_eq!(ciede2000(a, a), 0.0);
            prop_assert!((ciede2000(a, b) - ciede2000(b, a)).abs() < 1e-9);
            prop_assert!(ciede2000(a, b) >= 0.0);
        }
    }
}
