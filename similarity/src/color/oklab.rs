//! The distance of colours in Oklab. Pictures are compared with it in `picture/`.

use driftworld_spec::{Color, Oklab};

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
