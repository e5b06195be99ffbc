//! Checks of point sets that weigh 1 as a whole. What lies between two of them is measured by `earth_movers.rs`.

use crate::SimilarityError;

/// Refuses coordinates whose squares could not be added up, and an empty set beside one that is not.
pub(super) fn check(a: &[[f64; 2]], b: &[[f64; 2]]) -> Result<(), SimilarityError> {
    for (side, points) in [("a", a), ("b", b)] {
        for (index, point) in points.iter().enumerate() {
            for &found in point {
                if !(-1e100..=1e100).contains(&found) {
                    return Err(SimilarityError::BadPoint { side, index, found });
                }
            }
        }
    }
    if a.is_empty() == b.is_empty() {
        return Ok(());
    }
    let weight = |points: &[[f64; 2]]| if points.is_empty() { 0.0 } else { 1.0 };
    let (from, to) = (weight(a), weight(b));
    Err(SimilarityError::UnequalMasses { from, to })
}
