//! Distance between sets of colours, of equal or different size.

use driftworld_spec::Color;

use crate::SimilarityError;
use crate::assignment::Assignment;
use crate::color::measure::ColorMeasure;

/// The distance between two sets of colours: the mean distance of optimally matched pairs, where each unmatched colour counts 1.
///
/// (min Σ d(aᵢ, b₍ᵢ₎) + | |A| − |B| |) / max(|A|, |B|) with d as a share of the [`ColorMeasure::diameter`]; two empty sets are
/// 0 apart, an empty set is 1 away from any other. In `0..=1`. A metric between multisets for every measure except CIEDE2000.
/// Order within a set does not matter. Time `O(n³)` at worst; up to [`MAX_ASSIGNED`](crate::MAX_ASSIGNED) colours each.
///
/// Source: Schuhmacher, Vo and Vo 2008 (OSPA with order 1 and cut-off 1).
///
/// # Errors
/// [`SimilarityError::TooMany`] for larger sets, [`SimilarityError::BadCost`] for a colour whose channels are not finite.
///
/// # Example
/// ```
/// use driftworld_similarity::{ColorMeasure, color_sets_distance};
/// use driftworld_spec::Color;
/// let [black, white] = [[0.0; 3], [1.0; 3]].map(Color);
/// let distance = |a: &[Color], b: &[Color]| color_sets_distance(a, b, ColorMeasure::Srgb);
/// assert_eq!(distance(&[black, white], &[white, black])?, 0.0);
/// assert_eq!(distance(&[black], &[white, black])?, 0.5);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn color_sets_distance(a: &[Color], b: &[Color], measure: ColorMeasure) -> Result<f64, SimilarityError> {
    let (longer, shorter) = (a.len().max(b.len()), a.len().min(b.len()));
    // Checked before allocating the cost matrix.
    SimilarityError::check_count(longer, crate::MAX_ASSIGNED)?;
    if longer == 0 {
        return Ok(0.0);
    }
    let prepare = |colors: &[Color]| -> Vec<_> { colors.iter().map(|&color| measure.prepare(color)).collect() };
    let (from, to) = (prepare(a), prepare(b));
    let share = |a, b| {
        let share = measure.between_prepared(a, b) / measure.diameter();
        // A comparison, because `min` would turn NaN into 1.
        if share > 1.0 { 1.0 } else { share }
    };
    let costs: Vec<f64> = from
        .iter()
        .flat_map(|&a| to.iter().map(move |&b| share(a, b)))
        .collect();
    let total = Assignment::new().solve(&costs, a.len(), b.len())?;
    Ok((total + (longer - shorter) as f64) / longer as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn colors() -> impl Strategy<Value = Vec<Color>> {
        prop::collection::vec(prop::array::uniform3(0.0..=1.0).prop_map(Color), 0..6)
    }

    #[test]
    fn empty_set_has_distance_1_from_others() {
        let red = [Color([1.0, 0.0, 0.0])];
        let distance = |a: &[Color], b: &[Color]| color_sets_distance(a, b, ColorMeasure::Oklab).unwrap();
        assert_eq!(distance(&[], &[]), 0.0);
        assert_eq!(distance(&[], &red), 1.0);
    }

    #[test]
    fn non_finite_channels_are_refused() {
        let error = color_sets_distance(&[Color([f64::NAN; 3])], &[Color([0.0; 3])], ColorMeasure::Srgb).unwrap_err();
        assert!(matches!(error, SimilarityError::BadCost { .. }), "{error}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn set_distance_is_a_metric(a in colors(), b in colors(), c in colors()) {
            for &measure in ColorMeasure::ALL {
                let d = |a: &[Color], b: &[Color]| color_sets_distance(a, b, measure).unwrap();
                let mut reversed = a.clone();
                reversed.reverse();
                prop_assert!(d(&a, &reversed).abs() < 1e-12);
                prop_assert!((d(&a, &b) - d(&b, &a)).abs() < 1e-9);
                prop_assert!((0.0..=1.0).contains(&d(&a, &b)));
                if measure.properties().is_metric() {
                    prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-9);
                }
            }
        }
    }
}
