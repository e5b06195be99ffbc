//! Films: sequences of images, as GIF or animated PNG.

mod gif;
mod palette;

use std::io::Write;

use self::gif::GifFrames;
use crate::ReportError;
use crate::picture::Picture;

/// The kinds of films.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FilmKind {
    /// At most 255 colours in the changes from one image to the next; times in hundredths of a second. Works everywhere.
    Gif,
    /// Animated PNG: exact colours, times in milliseconds. Works in browsers; files are larger.
    Apng,
}

impl FilmKind {
    /// The kind of film for a file extension, `gif` or `apng`.
    pub fn of_ending(ending: &str) -> Option<Self> {
        [("gif", Self::Gif), ("apng", Self::Apng)]
            .into_iter()
            .find_map(|(known, kind)| ending.eq_ignore_ascii_case(known).then_some(kind))
    }

    /// The shortest time in seconds for which viewers show an image.
    pub fn shortest(self) -> f64 {
        match self {
            // Browsers turn shorter times into a tenth of a second.
            Self::Gif => 0.02,
            Self::Apng => 0.01,
        }
    }
}

/// Time units per second in an animated PNG.
const APNG_UNITS: u16 = 1000;

/// A film being written, image by image.
pub struct Film<W: Write> {
    frames: Frames<W>,
    size: [u32; 2],
    delays: Delays,
}

/// The encoder, by the kind of film.
enum Frames<W: Write> {
    Gif(GifFrames<W>),
    /// Written by the crate `png`.
    Apng(png::Writer<W>),
}

impl<W: Write> Film<W> {
    /// Starts an endlessly looping film of images of this size.
    ///
    /// # Errors
    /// [`ReportError::FilmSize`] for an unsupported size, or no images; [`ReportError::Gif`], [`ReportError::Png`] if it cannot
    /// be written.
    pub fn new(kind: FilmKind, to: W, [width, height]: [u32; 2], num_pictures: u32) -> Result<Self, ReportError> {
        let sides = 1..=u32::from(u16::MAX);
        if !sides.contains(&width) || !sides.contains(&height) || num_pictures == 0 {
            return Err(ReportError::FilmSize {
                found: format!("{num_pictures} pictures of {width} × {height} pixels"),
                expected: "at least one, each side 1 to 65535 pixels".to_owned(),
            });
        }
        let size = [width, height];
        let (frames, units_per_second) = match kind {
            FilmKind::Gif => (Frames::Gif(GifFrames::new(to, size)?), 100.0),
            FilmKind::Apng => {
                let mut encoder = png::Encoder::new(to, width, height);
                encoder.set_color(png::ColorType::Rgb);
                encoder.set_depth(png::BitDepth::Eight);
                encoder.set_animated(num_pictures, 0)?;
                encoder.validate_sequence(true);
                (Frames::Apng(encoder.write_header()?), APNG_UNITS.into())
            }
        };
        let delays = Delays::new(units_per_second);
        Ok(Self { frames, size, delays })
    }

    /// Adds an image that is shown for `seconds`.
    ///
    /// # Errors
    /// [`ReportError::FilmSize`] for an image of a different size; otherwise as for [`Film::new`].
    pub fn add(&mut self, picture: &Picture, seconds: f64) -> Result<(), ReportError> {
        expect_size(picture, self.size)?;
        let delay = self.delays.next(seconds);
        match &mut self.frames {
            Frames::Gif(frames) => frames.add(picture, delay),
            Frames::Apng(writer) => {
                writer.set_frame_delay(delay, APNG_UNITS)?;
                Ok(writer.write_image_data(&picture.rgb)?)
            }
        }
    }

    /// Finishes the film.
    ///
    /// # Errors
    /// As for [`Film::new`]; also if fewer images were added to an animated PNG than announced.
    pub fn finish(self) -> Result<(), ReportError> {
        match self.frames {
            Frames::Gif(frames) => frames.finish(),
            Frames::Apng(writer) => Ok(writer.finish()?),
        }
    }
}

/// Returns an error for an image whose size differs from the film's.
fn expect_size(picture: &Picture, [width, height]: [u32; 2]) -> Result<(), ReportError> {
    let pixels = width as usize * height as usize;
    if [picture.width, picture.height] == [width, height] && picture.rgb.len() == 3 * pixels {
        return Ok(());
    }
    Err(ReportError::FilmSize {
        found: format!("a picture of {} × {} pixels", picture.width, picture.height),
        expected: format!("{width} × {height}, the size of the film"),
    })
}

/// Converts display times to whole units without accumulating rounding errors.
#[derive(Debug)]
struct Delays {
    units_per_second: f64,
    /// Total seconds so far.
    seconds: f64,
    /// Total units so far.
    units: u64,
}

impl Delays {
    fn new(units_per_second: f64) -> Self {
        Self {
            units_per_second,
            seconds: 0.0,
            units: 0,
        }
    }

    /// The display time of the next image, in units.
    fn next(&mut self, seconds: f64) -> u16 {
        self.seconds += seconds.max(0.0);
        let units = (self.seconds * self.units_per_second).round() as u64;
        let next = u16::try_from(units - self.units).unwrap_or(u16::MAX);
        self.units = units;
        next
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SIZE: [u32; 2] = [12, 9];

    /// Images that each change some pixels of the previous one, with display times.
    fn film() -> impl Strategy<Value = Vec<(Picture, f64)>> {
        let pixels = (SIZE[0] * SIZE[1]) as usize;
        let change = (0..pixels, 1..pixels, prop::array::uniform3(any::<u8>()), 1u8..9);
        let picture = (prop::collection::vec(change, 0..4), 0.02..0.5f64);
        prop::collection::vec(picture, 1..8).prop_map(move |changes| {
            let mut now = Picture::blank(SIZE[0], SIZE[1]);
            let mut shown = Vec::new();
            for (changes, seconds) in changes {
                for (first, count, color, step) in changes {
                    for pixel in first..(first + count).min(pixels) {
                        let shift = (pixel as u8).wrapping_mul(step);
                        for (k, value) in color.iter().enumerate() {
                            now.rgb[3 * pixel + k] = value.wrapping_add(shift);
                        }
                    }
                }
                shown.push((now.clone(), seconds));
            }
            shown
        })
    }

    fn encoded(kind: FilmKind, pictures: &[(Picture, f64)]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut film = Film::new(kind, &mut bytes, SIZE, pictures.len() as u32).unwrap();
        for (picture, seconds) in pictures {
            film.add(picture, *seconds).unwrap();
        }
        film.finish().unwrap();
        bytes
    }

    /// The images of a GIF as composed by a viewer, with their hundredths of a second.
    fn seen_in_gif(bytes: &[u8]) -> Vec<(Vec<u8>, u16)> {
        let mut options = ::gif::DecodeOptions::new();
        options.set_color_output(::gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(bytes).unwrap();
        assert_eq!(decoder.repeat(), ::gif::Repeat::Infinite);
        let width = usize::from(decoder.width());
        let mut canvas = vec![0; 3 * width * usize::from(decoder.height())];
        let mut seen = Vec::new();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            let across = usize::from(frame.width);
            for (index, pixel) in frame.buffer.chunks_exact(4).enumerate() {
                let (x, y) = (
                    usize::from(frame.left) + index % across,
                    usize::from(frame.top) + index / across,
                );
                if pixel[3] != 0 {
                    canvas[3 * (y * width + x)..][..3].copy_from_slice(&pixel[..3]);
                }
            }
            seen.push((canvas.clone(), frame.delay));
        }
        seen
    }

    /// Like `seen_in_gif`, for an animated PNG, with milliseconds.
    fn seen_in_apng(bytes: &[u8]) -> Vec<(Vec<u8>, u16)> {
        let mut reader = png::Decoder::new(std::io::Cursor::new(bytes)).read_info().unwrap();
        let frames = reader
            .info()
            .animation_control()
            .map_or(1, |control| control.num_frames);
        let mut seen = Vec::new();
        for _ in 0..frames {
            let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut rgb).unwrap();
            let delay = reader.info().frame_control().map_or(0, |control| {
                assert_eq!(control.delay_den, 1000);
                control.delay_num
            });
            seen.push((rgb, delay));
        }
        seen
    }

    /// The largest difference in any channel.
    fn error(a: &[u8], b: &[u8]) -> u8 {
        a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: crate::tier::quick_or_full(24, 48), ..ProptestConfig::default() })]
        /// The number of images and their pixels are unchanged, and no cumulative time is off by more than half a unit.
        #[test]
        fn films_show_the_images_that_were_added(pictures in film()) {
            for kind in [FilmKind::Gif, FilmKind::Apng] {
                let bytes = encoded(kind, &pictures);
                let (seen, unit) = match kind {
                    FilmKind::Gif => (seen_in_gif(&bytes), 0.01),
                    FilmKind::Apng => (seen_in_apng(&bytes), 0.001),
                };
                prop_assert_eq!(seen.len(), pictures.len());
                let (mut shown, mut wanted) = (0.0, 0.0);
                for (index, ((rgb, delay), (picture, seconds))) in seen.iter().zip(&pictures).enumerate() {
                    // These images are so small that the palette has room for every colour.
                    prop_assert_eq!(error(rgb, &picture.rgb), 0, "{:?}, picture {}", kind, index);
                    shown += f64::from(*delay) * unit;
                    wanted += seconds;
                    if seen.len() > 1 {
                        prop_assert!((shown - wanted).abs() <= unit / 2.0 + 1e-9, "{} s, {} s", shown, wanted);
                    }
                }
            }
        }
    }

    #[test]
    fn many_colors_are_close_in_a_gif_and_exact_in_a_png() {
        let (width, height) = (96, 96);
        let picture = |shift: u32| Picture {
            width,
            height,
            rgb: (0..width * height)
                .flat_map(|pixel| {
                    let (x, y) = (pixel % width, pixel / width);
                    [(2 * x) as u8, (2 * y) as u8, (x + y + shift) as u8]
                })
                .collect(),
        };
        let pictures = [picture(0), picture(9)];
        for (kind, tolerance) in [(FilmKind::Gif, 24), (FilmKind::Apng, 0)] {
            let mut bytes = Vec::new();
            let mut film = Film::new(kind, &mut bytes, [width, height], 2).unwrap();
            for picture in &pictures {
                film.add(picture, 0.1).unwrap();
            }
            film.finish().unwrap();
            let seen = match kind {
                FilmKind::Gif => seen_in_gif(&bytes),
                FilmKind::Apng => seen_in_apng(&bytes),
            };
            for ((rgb, _), picture) in seen.iter().zip(&pictures) {
                let found = error(rgb, &picture.rgb);
                assert!(found <= tolerance, "{kind:?}: a channel is off by {found}");
            }
        }
    }

    #[test]
    fn invalid_films_are_refused() {
        let code = |size, count| {
            let film = Film::new(FilmKind::Gif, Vec::new(), size, count);
            film.err().map(|error| error.code())
        };
        assert_eq!(code([1, 1], 1), None);
        assert_eq!(code([0, 1], 1), Some("report/film-size"));
        assert_eq!(code([1, 65_536], 1), Some("report/film-size"));
        assert_eq!(code([1, 1], 0), Some("report/film-size"));
        let mut film = Film::new(FilmKind::Apng, Vec::new(), [2, 2], 2).unwrap();
        assert_eq!(
            film.add(&Picture::blank(2, 3), 0.1).unwrap_err().code(),
            "report/film-size"
        );
        film.add(&Picture::blank(2, 2), 0.1).unwrap();
        assert!(film.finish().is_err(), "a picture is missing");
    }
}
