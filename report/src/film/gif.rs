//! Encodes the images of a film as a GIF. Each image stores the changes since the previous one, with a palette of its own.

use std::io::Write;

use gif::{DisposalMethod, Encoder, Frame, Repeat};

use super::palette::Palette;
use crate::ReportError;
use crate::picture::Picture;

/// Maximum number of colours of an image; one more is transparent, and marks unchanged pixels.
const COLORS: usize = 255;

/// A GIF encoder, fed image by image.
pub(super) struct GifFrames<W: Write> {
    encoder: Encoder<W>,
    previous: Option<Picture>,
}

impl<W: Write> GifFrames<W> {
    pub(super) fn new(output: W, size: [u32; 2]) -> Result<Self, ReportError> {
        // `Film::new` has checked that the sides fit.
        let [width, height] = size.map(|side| side as u16);
        let mut encoder = Encoder::new(output, width, height, &[])?;
        encoder.set_repeat(Repeat::Infinite)?;
        Ok(Self {
            encoder,
            previous: None,
        })
    }

    /// Adds an image of the film's size, shown for `delay` hundredths of a second.
    pub(super) fn add(&mut self, picture: &Picture, delay: u16) -> Result<(), ReportError> {
        let previous = self.previous.as_ref();
        let [left, top, right, bottom] = previous.map_or([0, 0, picture.width, picture.height], |previous| {
            changed(previous, picture)
        });
        let at = |picture: &Picture, x: u32, y: u32| {
            let index = 3 * (y as usize * picture.width as usize + x as usize);
            [picture.rgb[index], picture.rgb[index + 1], picture.rgb[index + 2]]
        };
        let positions = (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y)));
        // `None` for an unchanged pixel.
        let pixels: Vec<Option<[u8; 3]>> = positions
            .map(|(x, y)| {
                let new_color = at(picture, x, y);
                previous
                    .is_none_or(|previous| at(previous, x, y) != new_color)
                    .then_some(new_color)
            })
            .collect();
        let palette = Palette::new(pixels.iter().flatten().copied(), COLORS);
        let colors = palette.colors();
        let transparent = colors.len() as u8;
        let buffer: Vec<u8> = pixels
            .iter()
            .map(|pixel| pixel.map_or(transparent, |color| palette.index_of(color)))
            .collect();
        let mut table: Vec<u8> = colors.iter().flatten().copied().collect();
        table.extend([0; 3]);
        self.encoder.write_frame(&Frame {
            delay,
            dispose: DisposalMethod::Keep,
            transparent: Some(transparent),
            left: left as u16,
            top: top as u16,
            width: (right - left) as u16,
            height: (bottom - top) as u16,
            palette: Some(table),
            buffer: buffer.into(),
            ..Frame::default()
        })?;
        self.previous = Some(picture.clone());
        Ok(())
    }

    pub(super) fn finish(self) -> Result<(), ReportError> {
        let mut output = self.encoder.into_inner()?;
        output.flush().map_err(|error| ReportError::Gif(error.into()))
    }
}

/// The smallest rectangle around all changed pixels: left, top, and exclusive right and bottom; one pixel if nothing changed.
fn changed(previous: &Picture, new_color: &Picture) -> [u32; 4] {
    let row = 3 * new_color.width as usize;
    let mut bounds: Option<[u32; 4]> = None;
    for (y, (before, after)) in (0..).zip(previous.rgb.chunks_exact(row).zip(new_color.rgb.chunks_exact(row))) {
        let differs = |byte: &usize| before[*byte] != after[*byte];
        let Some(first) = (0..row).find(differs) else { continue };
        let end = (0..row).rfind(differs).unwrap_or(first);
        let (left, right) = ((first / 3) as u32, (end / 3) as u32 + 1);
        let [old_left, top, old_right, _] = bounds.unwrap_or([left, y, right, y]);
        bounds = Some([old_left.min(left), top, old_right.max(right), y + 1]);
    }
    bounds.unwrap_or([0, 0, 1, 1])
}
