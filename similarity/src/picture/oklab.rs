//! Mean colour difference between two pictures, pixel by pixel.

use std::sync::LazyLock;

use driftworld_spec::{Oklab, linear_from_srgb};

use super::Picture;
use crate::SimilarityError;

/// Linear light of the 256 byte values.
static LIGHT: LazyLock<[f64; 256]> =
    LazyLock::new(|| std::array::from_fn(|byte| linear_from_srgb(byte as f64 / 255.0)));

/// Mean over all pixels of the distance in Oklab between two pictures.
///
/// A metric between pictures of the same size, in `0..=1` (black to white), no unit. A shift by a single pixel counts as much
/// as an absence. Costs about six cube roots per pixel; pixels of equal bytes are free.
///
/// # Errors
/// [`SimilarityError::PictureSizes`] if they differ in height or width.
///
/// # Example
/// ```
/// use driftworld_similarity::picture::{Picture, picture_oklab};
/// let (black, half) = ([0; 6], [0, 0, 0, 255, 255, 255]);
/// let (a, b) = (Picture::new(&black, 1, 2)?, Picture::new(&half, 1, 2)?);
/// assert!((picture_oklab(a, b)? - 0.5).abs() < 1e-6);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn picture_oklab(a: Picture, b: Picture) -> Result<f64, SimilarityError> {
    a.check_size(b)?;
    let (from, to) = (a.rgb.as_chunks::<3>().0, b.rgb.as_chunks::<3>().0);
    // Neighbouring pixels are often equal: the last conversion of each picture is cached.
    let (mut cache_a, mut cache_b) = (Last::default(), Last::default());
    let mut sum = 0.0;
    for (from, to) in from.iter().zip(to) {
        if from != to {
            sum += cache_a.oklab(*from).distance(cache_b.oklab(*to));
        }
    }
    Ok(sum / from.len() as f64)
}

/// The sum of the distances in Oklab and the number of pixels: for the marked pixels, and for the others.
///
/// Add these up over many pictures to get the mean over all pixels of either kind. `marked`: `(height · width,)`.
///
/// # Errors
/// [`SimilarityError::PictureSizes`] if the pictures differ in height or width, [`SimilarityError::Shape`] unless there is a
/// mark for every pixel.
///
/// # Example
/// ```
/// use driftworld_similarity::picture::{Picture, picture_oklab_sums};
/// let (black, half) = ([0; 6], [0, 0, 0, 255, 255, 255]);
/// let (a, b) = (Picture::new(&black, 1, 2)?, Picture::new(&half, 1, 2)?);
/// let [marked, others] = picture_oklab_sums(a, b, &[false, true])?;
/// assert!((marked.0 - 1.0).abs() < 1e-6 && others == (0.0, 1));
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn picture_oklab_sums(a: Picture, b: Picture, marked: &[bool]) -> Result<[(f64, usize); 2], SimilarityError> {
    a.check_size(b)?;
    let (from, to) = (a.rgb.as_chunks::<3>().0, b.rgb.as_chunks::<3>().0);
    SimilarityError::check_length("marks of pixels", marked.len(), from.len())?;
    let (mut cache_a, mut cache_b) = (Last::default(), Last::default());
    let mut sums = [(0.0, 0); 2];
    for ((from, to), is_marked) in from.iter().zip(to).zip(marked) {
        let (sum, count) = &mut sums[usize::from(!is_marked)];
        *count += 1;
        if from != to {
            *sum += cache_a.oklab(*from).distance(cache_b.oklab(*to));
        }
    }
    Ok(sums)
}

/// The bytes of the last pixel, and its colour.
#[derive(Default)]
struct Last([u8; 3], Oklab);

impl Last {
    fn oklab(&mut self, rgb: [u8; 3]) -> Oklab {
        if self.0 != rgb {
            *self = Self(rgb, Oklab::from_linear(rgb.map(|byte| LIGHT[usize::from(byte)])));
        }
        self.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use driftworld_spec::Color;
    use proptest::prelude::*;

    fn pixels() -> impl Strategy<Value = Vec<u8>> {
        let byte = prop_oneof![Just(0), Just(255), any::<u8>()];
        prop::collection::vec(byte, 4 * 3)
    }

    fn distance(a: &[u8], b: &[u8]) -> f64 {
        picture_oklab(Picture::new(a, 2, 2).unwrap(), Picture::new(b, 2, 2).unwrap()).unwrap()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn picture_oklab_is_a_metric(a in pixels(), b in pixels(), c in pixels()) {
            prop_assert_eq!(distance(&a, &a), 0.0);
            prop_assert_eq!(distance(&a, &b), distance(&b, &a));
            prop_assert!(distance(&a, &c) <= distance(&a, &b) + distance(&b, &c) + 1e-12);
            prop_assert!((0.0..=1.0).contains(&distance(&a, &b)));
            prop_assert!(a == b || distance(&a, &b) > 0.0);
        }

        #[test]
        fn sums_of_both_pixel_kinds_give_the_mean(
            a in pixels(), b in pixels(), marked in prop::collection::vec(any::<bool>(), 4)
        ) {
            let [a_picture, b_picture] = [&a, &b].map(|rgb| Picture::new(rgb, 2, 2).unwrap());
            let [on, off] = picture_oklab_sums(a_picture, b_picture, &marked).unwrap();
            prop_assert_eq!((on.1, off.1), (marked.iter().filter(|m| **m).count(), marked.iter().filter(|m| !**m).count()));
            prop_assert!(((on.0 + off.0) / 4.0 - distance(&a, &b)).abs() < 1e-12);
            prop_assert!(picture_oklab_sums(a_picture, b_picture, &marked[1..]).is_err());
        }

        #[test]
        fn mean_is_over_the_distances_of_the_colours(a in pixels(), b in pixels()) {
            let color = |rgb: &[u8]| Color([rgb[0], rgb[1], rgb[2]].map(|byte| f64::from(byte) / 255.0));
            let pairs = a.chunks(3).zip(b.chunks(3));
            let mean = pairs.map(|(a, b)| color(a).distance(color(b))).sum::<f64>() / 4.0;
            prop_assert!((distance(&a, &b) - mean).abs() < 1e-12);
        }
    }
}
