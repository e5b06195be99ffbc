//! Distances between rendered views of two worlds: pairs of pictures from the same poses.

mod oklab;
mod ssim;
mod views;

pub use oklab::{picture_oklab, picture_oklab_sums};
pub use ssim::{LEAST_SIDE, structural_similarity};
pub use views::{PictureMeasure, views_distance};

use crate::SimilarityError;

/// Maximum side of a picture in pixels.
pub const MAX_SIDE: usize = 4096;

/// A borrowed picture: `(height, width, 3)` bytes of sRGB, row 0 at the top.
///
/// # Example
/// ```
/// use driftworld_similarity::picture::Picture;
/// let rgb = [0; 2 * 4 * 3];
/// assert!(Picture::new(&rgb, 2, 4).is_ok());
/// let error = Picture::new(&rgb, 4, 4).unwrap_err();
/// assert_eq!(error.to_string(), "bytes of a picture: found 24 numbers, expected 48");
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Picture<'a> {
    rgb: &'a [u8],
    height: usize,
    width: usize,
}

impl<'a> Picture<'a> {
    /// Wraps the bytes of a picture.
    ///
    /// # Errors
    /// [`SimilarityError::PictureSide`] for a side of 0 or above [`MAX_SIDE`], [`SimilarityError::Shape`] unless there are
    /// `height · width · 3` bytes.
    pub fn new(rgb: &'a [u8], height: usize, width: usize) -> Result<Self, SimilarityError> {
        for found in [height, width] {
            if found == 0 || found > MAX_SIDE {
                return Err(SimilarityError::PictureSide {
                    found,
                    least: 1,
                    most: MAX_SIDE,
                });
            }
        }
        SimilarityError::check_length("bytes of a picture", rgb.len(), height * width * 3)?;
        Ok(Self { rgb, height, width })
    }

    /// Checks that another picture has the same height and width.
    fn check_size(self, other: Self) -> Result<(), SimilarityError> {
        if (self.height, self.width) == (other.height, other.width) {
            return Ok(());
        }
        Err(SimilarityError::PictureSizes {
            found: format!("{} × {}", other.height, other.width),
            expected: format!("{} × {}", self.height, self.width),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_are_within_bounds() {
        for (height, width) in [(0, 1), (1, 0), (MAX_SIDE + 1, 1)] {
            let error = Picture::new(&[0; 3], height, width).unwrap_err();
            assert!(matches!(error, SimilarityError::PictureSide { .. }), "{error}");
        }
    }

    #[test]
    fn pictures_of_different_sizes_are_not_compared() {
        let rgb = [0; 15 * 12 * 3];
        let (a, b) = (Picture::new(&rgb, 15, 12).unwrap(), Picture::new(&rgb, 12, 15).unwrap());
        for error in [
            picture_oklab(a, b).unwrap_err(),
            structural_similarity(a, b).unwrap_err(),
        ] {
            assert!(matches!(error, SimilarityError::PictureSizes { .. }), "{error}");
        }
    }
}
