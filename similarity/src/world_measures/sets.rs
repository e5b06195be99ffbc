//! [`world_sets_measure_distance`]: one measure between sets of worlds, as a distance in one element.

use driftworld_spec::World;

use super::measure::WorldMeasure;
use crate::SimilarityError;
use crate::combined::{Distance, Part, Weights};
use crate::distribution::Method;

/// The mean of [`WorldMeasure::between`] over pairs, the first with the first and so on, as a distance in the measure's
/// element alone; worlds without a partner are left out. `weights`: supplies the weight of the element. One unit of the
/// measure counts as 1.
///
/// # Errors
/// [`SimilarityError::Empty`] if there is no pair, and as [`WorldMeasure::between`].
pub fn world_sets_measure_distance(
    a: &[World],
    b: &[World],
    measure: WorldMeasure,
    weights: &Weights,
) -> Result<Distance, SimilarityError> {
    let count = a.len().min(b.len());
    if count == 0 {
        return Err(SimilarityError::Empty);
    }
    let mut sum = 0.0;
    for (a, b) in a.iter().zip(b) {
        sum += measure.between(a, b)?;
    }
    let mean = sum / count as f64;
    let part = Part {
        method: Some(Method::Samples { count }),
        ..Part::of(measure.kind(), measure.element(), measure.label(), mean)
    };
    Ok(Distance::new(vec![part], weights))
}
