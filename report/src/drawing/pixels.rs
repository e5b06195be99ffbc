//! Images in memory, and their PNG files.

use crate::ReportError;

/// An RGB image in memory: 8 bits per channel, row 0 at the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// The pixels' bytes, of shape `(height, width, 3)`.
    pub rgb: Vec<u8>,
}

/// A greyscale image in memory: 16 bits per pixel, row 0 at the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Gray {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// The pixels' levels, of shape `(height, width)`.
    pub levels: Vec<u16>,
}

impl Gray {
    /// The image as a PNG file's bytes.
    ///
    /// # Errors
    /// [`ReportError::Png`] for an image without pixels, or whose number of pixels does not match its size.
    pub fn to_png(&self) -> Result<Vec<u8>, ReportError> {
        let bytes: Vec<u8> = self.levels.iter().flat_map(|level| level.to_be_bytes()).collect();
        let size = [self.width, self.height];
        png_of(size, png::ColorType::Grayscale, png::BitDepth::Sixteen, &bytes)
    }
}

/// A PNG file's bytes.
fn png_of(size: [u32; 2], color: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Result<Vec<u8>, ReportError> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, size[0], size[1]);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(data)?;
    writer.finish()?;
    Ok(bytes)
}

impl Picture {
    /// An image with these pixels.
    pub fn new(width: u32, height: u32, rgb: Vec<u8>) -> Self {
        Self { width, height, rgb }
    }

    /// A white image.
    pub fn blank(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            rgb: vec![255; width as usize * height as usize * 3],
        }
    }

    /// Copies an image into this one with its top left corner at `(x, y)`, clipped.
    pub fn paste(&mut self, other: &Self, x: u32, y: u32) {
        let columns = other.width.min(self.width.saturating_sub(x)) as usize * 3;
        if columns == 0 {
            return;
        }
        for row in 0..other.height.min(self.height.saturating_sub(y)) {
            let from = row as usize * other.width as usize * 3;
            let to = ((y + row) as usize * self.width as usize + x as usize) * 3;
            self.rgb[to..to + columns].copy_from_slice(&other.rgb[from..from + columns]);
        }
    }

    /// The image at half the size, averaging each 2 × 2 block of pixels. This antialiases an image drawn at double size.
    #[must_use]
    pub fn halved(&self) -> Self {
        let (width, height) = (self.width / 2, self.height / 2);
        let mut half = Self::blank(width, height);
        let at =
            |x: u32, y: u32, k: usize| u32::from(self.rgb[(y as usize * self.width as usize + x as usize) * 3 + k]);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            for k in 0..3 {
                let sum = at(2 * x, 2 * y, k)
                    + at(2 * x + 1, 2 * y, k)
                    + at(2 * x, 2 * y + 1, k)
                    + at(2 * x + 1, 2 * y + 1, k);
                half.rgb[(y as usize * width as usize + x as usize) * 3 + k] = ((sum + 2) / 4) as u8;
            }
        }
        half
    }

    /// A picture of this width and height with smooth edges: `draw` renders it at twice the size, and the result is halved. Pictures
    /// over 2048 pixels wide or high are rendered at their own size.
    ///
    /// # Errors
    /// Those of `draw`.
    pub fn smooth<E>(size: [u32; 2], draw: impl FnOnce([u32; 2]) -> Result<Vec<u8>, E>) -> Result<Self, E> {
        let is_large = size.iter().any(|side| *side > 2048);
        let [width, height] = if is_large { size } else { size.map(|side| 2 * side) };
        let drawn = Self::new(width, height, draw([width, height])?);
        Ok(if is_large { drawn } else { drawn.halved() })
    }

    /// The image as a PNG file's bytes.
    ///
    /// # Errors
    /// [`ReportError::Png`] for an image without pixels, or whose number of pixels does not match its size.
    pub fn to_png(&self) -> Result<Vec<u8>, ReportError> {
        let size = [self.width, self.height];
        png_of(size, png::ColorType::Rgb, png::BitDepth::Eight, &self.rgb)
    }

    /// Blends a colour into a pixel, with this share.
    pub(crate) fn blend(&mut self, x: usize, y: usize, color: [u8; 3], share: f32) {
        let start = (y * self.width as usize + x) * 3;
        if share >= 1.0 {
            self.rgb[start..start + 3].copy_from_slice(&color);
            return;
        }
        for (level, new) in self.rgb[start..start + 3].iter_mut().zip(color) {
            let mixed = f32::from(*level) + (f32::from(new) - f32::from(*level)) * share;
            *level = (mixed + 0.5) as u8;
        }
    }
}
