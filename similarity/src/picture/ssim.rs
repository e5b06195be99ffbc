//! Structural similarity of two pictures.

use super::Picture;
use crate::SimilarityError;

/// Radius of the Gaussian window (standard deviation 1.5 pixels), truncated as in scikit-image.
const REACH: usize = 5;

/// Side of the window, and so the minimum side of a picture.
pub const LEAST_SIDE: usize = 2 * REACH + 1;

/// (0.01 · 255)² and (0.03 · 255)²: they stabilise dark and flat areas.
const STEADY_MEAN: f64 = 6.5025;
const STEADY_SPREAD: f64 = 58.5225;

/// Mean structural similarity (SSIM) of two pictures: mean, contrast and structure of the brightness around each pixel, channel
/// by channel.
///
/// Mean over the channels red, green and blue and over all positions of a Gaussian window (11 × 11 pixels, standard deviation
/// 1.5) of (2 μν + C₁)(2 κ + C₂) / ((μ² + ν² + C₁)(σ² + τ² + C₂)), with the means μ and ν, the variances σ² and τ², the
/// covariance κ and C₁ = 6.5025, C₂ = 58.5225. 1 for equal pictures, about 0 for unrelated ones, at least −1. Symmetric. A
/// similarity; `(1 − SSIM) / 2` is a distance but not a metric. Time proportional to the number of pixels: about 130
/// multiplications per pixel and channel.
///
/// Source: Wang, Bovik, Sheikh and Simoncelli 2004, "Image quality assessment: from error visibility to structural similarity";
/// the same numbers as `skimage.metrics.structural_similarity(a, b, channel_axis=2, gaussian_weights=True, sigma=1.5,
/// use_sample_covariance=False, data_range=255)` within 1e-9, see `tests/oracle/ssim.json`.
///
/// # Errors
/// [`SimilarityError::PictureSizes`] if they differ in height or width, [`SimilarityError::PictureSide`] below
/// [`LEAST_SIDE`].
///
/// # Example
/// ```
/// use driftworld_similarity::picture::{Picture, structural_similarity};
/// let (black, white) = ([0; 11 * 11 * 3], [255; 11 * 11 * 3]);
/// let (a, b) = (Picture::new(&black, 11, 11)?, Picture::new(&white, 11, 11)?);
/// assert_eq!(structural_similarity(a, a)?, 1.0);
/// assert!((structural_similarity(a, b)? - 0.0001).abs() < 1e-6);
/// # Ok::<(), driftworld_similarity::SimilarityError>(())
/// ```
pub fn structural_similarity(a: Picture, b: Picture) -> Result<f64, SimilarityError> {
    a.check_size(b)?;
    let (height, width) = (a.height, a.width);
    for found in [height, width] {
        if found < LEAST_SIDE {
            return Err(SimilarityError::PictureSide {
                found,
                least: LEAST_SIDE,
                most: super::MAX_SIDE,
            });
        }
    }
    let weights = gaussian();
    let (inner, rows) = (width - 2 * REACH, height - 2 * REACH);
    // The rows within the window, already blurred horizontally: five moments each.
    let mut blurred = vec![[0.0; 5]; LEAST_SIDE * inner];
    let mut moments = vec![[0.0; 5]; width];
    let mut sum = 0.0;
    for channel in 0..3 {
        for row in 0..height {
            let line = row * width * 3..(row + 1) * width * 3;
            let pixels = a.rgb[line.clone()].iter().zip(&b.rgb[line]).skip(channel).step_by(3);
            for (moments, (&x, &y)) in moments.iter_mut().zip(pixels) {
                let (x, y) = (f64::from(x), f64::from(y));
                *moments = [x, y, x * x, y * y, x * y];
            }
            let slot = row % LEAST_SIDE * inner;
            for (blurred, window) in blurred[slot..slot + inner].iter_mut().zip(moments.windows(LEAST_SIDE)) {
                *blurred = weighted(&weights, window.iter());
            }
            if row + 1 >= LEAST_SIDE {
                let first = row + 1 - LEAST_SIDE;
                for column in 0..inner {
                    let window = (first..=row).map(|row| &blurred[row % LEAST_SIDE * inner + column]);
                    sum += similarity(weighted(&weights, window));
                }
            }
        }
    }
    Ok(sum / (3 * inner * rows) as f64)
}

fn weighted<'a>(weights: &[f64; LEAST_SIDE], window: impl Iterator<Item = &'a [f64; 5]>) -> [f64; 5] {
    let mut sums = [0.0; 5];
    for (weight, moments) in weights.iter().zip(window) {
        for (sum, moment) in sums.iter_mut().zip(moments) {
            *sum += weight * moment;
        }
    }
    sums
}

/// From the means of x, y, x², y² and xy around a pixel.
fn similarity([x, y, xx, yy, xy]: [f64; 5]) -> f64 {
    let (spread_x, spread_y, joint) = (xx - x * x, yy - y * y, xy - x * y);
    let mean = (2.0 * x * y + STEADY_MEAN) / (x * x + y * y + STEADY_MEAN);
    let structure = (2.0 * joint + STEADY_SPREAD) / (spread_x + spread_y + STEADY_SPREAD);
    mean * structure
}

fn gaussian() -> [f64; LEAST_SIDE] {
    let weights: [f64; LEAST_SIDE] = std::array::from_fn(|k| {
        let offset = k as f64 - REACH as f64;
        libm::exp(-offset * offset / (2.0 * 1.5 * 1.5))
    });
    let sum: f64 = weights.iter().sum();
    weights.map(|weight| weight / sum)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const BYTES: usize = 12 * 13 * 3;

    #[test]
    fn picture_smaller_than_the_window_is_refused() {
        let rgb = [0; 10 * 20 * 3];
        let picture = Picture::new(&rgb, 10, 20).unwrap();
        let error = structural_similarity(picture, picture).unwrap_err();
        assert!(
            matches!(
                error,
                SimilarityError::PictureSide {
                    found: 10,
                    least: 11,
                    ..
                }
            ),
            "{error}"
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 32)))]

        #[test]
        fn ssim_is_symmetric_and_1_for_equal_pictures(
            a in prop::collection::vec(any::<u8>(), BYTES),
            b in prop::collection::vec(any::<u8>(), BYTES),
        ) {
            let (a, b) = (Picture::new(&a, 12, 13).unwrap(), Picture::new(&b, 12, 13).unwrap());
            prop_assert!((structural_similarity(a, a).unwrap() - 1.0).abs() < 1e-12);
            let (there, back) = (structural_similarity(a, b).unwrap(), structural_similarity(b, a).unwrap());
            prop_assert_eq!(there, back);
            prop_assert!((-1.0..1.0).contains(&there));
        }
    }
}
