//! `HyAB`: the difference in lightness plus the chromatic distance, in L*a*b*.

use crate::color::lab::Lab;

/// Difference of lightness plus Euclidean distance in a* and b*: |ΔL| + √(Δa² + Δb²). Designed for large differences.
///
/// A metric, from 0 to 308.11 within sRGB (blue to green), no unit. Takes a few nanoseconds for colours already in L*a*b*.
///
/// Source: Abasi, Tehran and Fairchild 2020, "Distance metrics for very large color differences"; the same numbers as colour-science's
/// `delta_E_HyAB` within 1e-9, see `tests/oracle/color.json`.
///
/// # Example
/// ```
/// use driftworld_similarity::{Lab, hyab};
/// assert_eq!(hyab(Lab([50.0, 3.0, 4.0]), Lab([60.0, 0.0, 0.0])), 15.0);
/// ```
pub fn hyab(a: impl Into<Lab>, b: impl Into<Lab>) -> f64 {
    let ([l1, a1, b1], [l2, a2, b2]) = (a.into().0, b.into().0);
    (l1 - l2).abs() + ((a1 - a2) * (a1 - a2) + (b1 - b2) * (b1 - b2)).sqrt()
}
