//! CIE76: Euclidean distance in L*a*b*.

use crate::color::euclidean;
use crate::color::lab::Lab;

/// The largest distance between two sRGB colours, rounded up: from blue to pure green (`lime` in CSS).
pub(crate) const CIE76_DIAMETER: f64 = 258.680_21;

/// Euclidean distance in CIE L*a*b*: √(ΔL² + Δa² + Δb²). About 2.3 is just noticeable.
///
/// A metric, from 0 to 258.68 within sRGB (blue to green), no unit. Exaggerates differences between strong colours;
/// [`ciede2000`] corrects that but is not a metric. Takes a few nanoseconds for colours already in L*a*b*.
///
/// Source: CIE 15 (1976); the same numbers as `skimage.color.deltaE_cie76` within 1e-9, see `tests/oracle/color.json`.
///
/// [`ciede2000`]: crate::ciede2000()
///
/// # Example
/// ```
/// use driftworld_similarity::{Lab, cie76};
/// assert_eq!(cie76(Lab([50.0, 3.0, 0.0]), Lab([50.0, 0.0, 4.0])), 5.0);
/// ```
pub fn cie76(a: impl Into<Lab>, b: impl Into<Lab>) -> f64 {
    euclidean(a.into().0, b.into().0)
}
