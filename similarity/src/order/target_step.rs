//! Paths in which every step is close to a target length.

use super::items::Items;
use super::two_opt::cheapest;
use crate::SimilarityError;

/// Random perturbations (shakes) of the path, per item.
const SHAKES_PER_ITEM: usize = 4;

/// Minimises the sum of `|step - target|`.
pub(super) fn order(items: &Items, target: Option<f64>) -> Result<Vec<usize>, SimilarityError> {
    let valid = target.filter(|step| step.is_finite() && *step >= 0.0);
    let Some(step) = valid else {
        let found = target.map_or_else(|| "none".to_owned(), |step| step.to_string());
        return Err(SimilarityError::BadTargetStep { found });
    };
    Ok(cheapest(items, &|a, b| (items.gap(a, b) - step).abs(), SHAKES_PER_ITEM))
}
