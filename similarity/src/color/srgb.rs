//! Euclidean distance between sRGB triples.

use driftworld_spec::Color;

use crate::color::euclidean;

/// Euclidean distance between two sRGB triples, as in the L2Explorer paper: √(Δr² + Δg² + Δb²).
///
/// A metric, in `0..=√3`, no unit. Ignores perception: black is as far from dark green as from dark blue. Takes a few
/// nanoseconds.
///
/// # Example
/// ```
/// use driftworld_similarity::srgb_distance;
/// use driftworld_spec::Color;
/// let (red, blue) = (Color([1.0, 0.0, 0.0]), Color([0.0, 0.0, 1.0]));
/// assert!((srgb_distance(red, blue) - 2.0_f64.sqrt()).abs() < 1e-15);
/// ```
pub fn srgb_distance(a: Color, b: Color) -> f64 {
    euclidean(a.0, b.0)
}
