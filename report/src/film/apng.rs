//! [`ApngFilm`]: a film as an animated PNG. A PNG is written by the crate `png`.

use std::io::Write;

use super::{Delays, expect_size};
use crate::ReportError;
use crate::picture::Picture;

/// A film as an animated PNG.
pub struct ApngFilm<W: Write> {
    writer: png::Writer<W>,
    size: [u32; 2],
    delays: Delays,
}

impl<W: Write> ApngFilm<W> {
    pub(super) fn new(to: W, size: [u32; 2], num_pictures: u32) -> Result<Self, ReportError> {
        let mut encoder = png::Encoder::new(to, size[0], size[1]);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_animated(num_pictures, 0)?;
        encoder.validate_sequence(true);
        Ok(Self {
            writer: encoder.write_header()?,
            size,
            delays: Delays::new(1000.0),
        })
    }

    pub(super) fn add(&mut self, picture: &Picture, seconds: f64) -> Result<(), ReportError> {
        expect_size(picture, self.size)?;
        self.writer.set_frame_delay(self.delays.next(seconds), 1000)?;
        Ok(self.writer.write_image_data(&picture.rgb)?)
    }

    pub(super) fn finish(self) -> Result<(), ReportError> {
        Ok(self.writer.finish()?)
    }
}
