//! Encodes the images of a film as a GIF. Each image stores the changes since the one before, with a palette of its own.

use std::io::Write;

use gif::{DisposalMethod, Encoder, Frame, Repeat};

use super::palette::Palette;
use crate::ReportError;
use crate::picture::Picture;

/// Maximum number of colours of an image; one more is transparent, for unchanged pixels.
const COLORS: usize = 255;

/// A GIF encoder, fed image by image.
pub(super) struct GifFrames<W: Write> {
    encoder: Encoder<W>,
    last: Option<Picture>,
}

impl<W: Write> GifFrames<W> {
    pub(super) fn new(to: W, size: [u32; 2]) -> Result<Self, ReportError> {
        // `Film::new` has checked that the sides fit.
        let [width, height] = size.map(|side| side as u16);
        let mut encoder = Encoder::new(to, width, height, &[])?;
        encoder.set_repeat(Repeat::Infinite)?;
        Ok(Self { encoder, last: None })
    }

    /// Adds an image of the film's size, shown for `delay` hundredths of a second.
    pub(super) fn add(&mut self, picture: &Picture, delay: u16) -> Result<(), ReportError> {
        let last = self.last.as_ref();
        let [left, top, right, bottom] =
            last.map_or([0, 0, picture.width, picture.height], |last| changed(last, picture));
        let at = |picture: &Picture, x: u32, y: u32| {
            let place = 3 * (y as usize * picture.width as usize + x as usize);
            [picture.rgb[place], picture.rgb[place + 1], picture.rgb[place + 2]]
        };
        let places = (top..bottom).flat_map(|y| (left..right).map(move |x| (x, y)));
        // Unchanged pixels have no colour.
        let pixels: Vec<Option<[u8; 3]>> = places
            .map(|(x, y)| {
                let now = at(picture, x, y);
                last.is_none_or(|last| at(last, x, y) != now).then_some(now)
            })
            .collect();
        let palette = Palette::new(pixels.iter().flatten().copied(), COLORS);
        let colors = palette.colors();
        let clear = colors.len() as u8;
        let buffer: Vec<u8> = pixels
            .iter()
            .map(|pixel| pixel.map_or(clear, |color| palette.place(color)))
            .collect();
        let mut table: Vec<u8> = colors.iter().flatten().copied().collect();
        table.extend([0; 3]);
        self.encoder.write_frame(&Frame {
            delay,
            dispose: DisposalMethod::Keep,
            transparent: Some(clear),
            left: left as u16,
            top: top as u16,
            width: (right - left) as u16,
            height: (bottom - top) as u16,
            palette: Some(table),
            buffer: buffer.into(),
            ..Frame::default()
        })?;
        self.last = Some(picture.clone());
        Ok(())
    }

    pub(super) fn finish(self) -> Result<(), ReportError> {
        let mut to = self.encoder.into_inner()?;
        to.flush().map_err(|error| ReportError::Gif(error.into()))
    }
}

/// The smallest rectangle around all changed pixels: left, top, and exclusive right and bottom; one pixel if nothing changed.
fn changed(last: &Picture, now: &Picture) -> [u32; 4] {
    let row = 3 * now.width as usize;
    let mut bounds: Option<[u32; 4]> = None;
    for (y, (before, after)) in (0..).zip(last.rgb.chunks_exact(row).zip(now.rgb.chunks_exact(row))) {
        let differs = |byte: &usize| before[*byte] != after[*byte];
        let Some(first) = (0..row).find(differs) else { continue };
        let end = (0..row).rfind(differs).unwrap_or(first);
        let (left, right) = ((first / 3) as u32, (end / 3) as u32 + 1);
        let [old_left, top, old_right, _] = bounds.unwrap_or([left, y, right, y]);
        bounds = Some([old_left.min(left), top, old_right.max(right), y + 1]);
    }
    bounds.unwrap_or([0, 0, 1, 1])
}
