//! Distance between two sets of pictures, pose by pose.

use super::{Picture, picture_oklab, structural_similarity};
use crate::{MetricProperties, SimilarityError};

/// A measure of the distance between two pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PictureMeasure {
    /// [`picture_oklab`]: colours pixel by pixel. A metric.
    #[default]
    Oklab,
    /// `(1 − SSIM) / 2` by [`structural_similarity`]: edges and shading more than colours. 0.5 for unrelated pictures.
    Structure,
}

impl PictureMeasure {
    /// Its name in tables and on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Oklab => "oklab",
            Self::Structure => "ssim",
        }
    }

    /// The metric properties of the measure.
    pub fn properties(self) -> MetricProperties {
        match self {
            Self::Oklab => MetricProperties::Metric,
            Self::Structure => MetricProperties::Distance,
        }
    }

    /// The distance between two pictures, in `0..=1`.
    ///
    /// # Errors
    /// As [`picture_oklab`] and [`structural_similarity`].
    pub fn between(self, a: Picture, b: Picture) -> Result<f64, SimilarityError> {
        match self {
            Self::Oklab => picture_oklab(a, b),
            // Rounding may push the similarity of equal pictures slightly above 1.
            Self::Structure => Ok(((1.0 - structural_similarity(a, b)?) / 2.0).clamp(0.0, 1.0)),
        }
    }
}

/// Mean distance between pictures from the same poses: the first of each set, the second of each set, and so on.
///
/// In `0..=1`, with the metric properties of the measure. Both sets must have the same number of pictures, with equal sizes in
/// each pair. Takes as long as all its pairs together.
///
/// # Errors
/// [`SimilarityError::NoPictures`] if both are empty, [`SimilarityError::Shape`] if one set has more; otherwise as
/// [`PictureMeasure::between`].
///
/// # Example
/// ```
/// use driftworld_similarity::picture::{Picture, PictureMeasure, views_distance};
/// let (black, white) = ([0; 3], [255; 3]);
/// let (black, white) = (Picture::new(&black, 1, 1)?, Picture::new(&white, 1, 1)?);
/// let distance = views_distance(&[black, black], &[black, white], PictureMeasure::Oklab)?;
/// assert!((distance - 0.5).abs() < 1e-6);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn views_distance(a: &[Picture], b: &[Picture], measure: PictureMeasure) -> Result<f64, SimilarityError> {
    SimilarityError::check_length("pictures of the second set", b.len(), a.len())?;
    if a.is_empty() {
        return Err(SimilarityError::NoPictures);
    }
    let mut sum = 0.0;
    for (&a, &b) in a.iter().zip(b) {
        sum += measure.between(a, b)?;
    }
    Ok(sum / a.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn sets_must_have_the_same_number_of_pictures() {
        let rgb = [0; 3];
        let picture = Picture::new(&rgb, 1, 1).unwrap();
        let code = |a: &[Picture], b: &[Picture]| views_distance(a, b, PictureMeasure::Oklab).unwrap_err().code();
        assert_eq!(code(&[picture], &[]), "similarity/shape");
        assert_eq!(code(&[], &[]), "similarity/no-pictures");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 32)))]

        #[test]
        fn measures_satisfy_their_metric_properties(bytes in prop::collection::vec(any::<u8>(), 6 * 11 * 11 * 3)) {
            let pictures: Vec<Picture> = bytes.chunks(11 * 11 * 3).map(|rgb| Picture::new(rgb, 11, 11).unwrap()).collect();
            let (a, b, c) = (&pictures[..2], &pictures[2..4], &pictures[4..]);
            for measure in [PictureMeasure::Oklab, PictureMeasure::Structure] {
                let d = |a, b| views_distance(a, b, measure).unwrap();
                prop_assert!(d(a, a) < 1e-12);
                prop_assert_eq!(d(a, b), d(b, a));
                prop_assert!((0.0..=1.0).contains(&d(a, b)));
                if measure.properties().is_metric() {
                    prop_assert!(d(a, c) <= d(a, b) + d(b, c) + 1e-12);
                }
            }
        }
    }
}
