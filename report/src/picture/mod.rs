//! [`Picture`]s of pixels with words in them: sheets of views, heat maps, maps of paths, blocks of curricula, points on axes.
//!
//! Not here: the views themselves, which `env` renders; figures of lifetimes, see `figure`; files, which are the caller's.

mod blocks;
mod heat_map;
mod path_map;
mod scatter;
mod sheet;

use driftworld_text::printable;
use plotters::prelude::*;
use plotters::style::text_anchor::Pos;

pub use blocks::blocks;
pub use heat_map::heat_map;
pub use path_map::path_map;
pub use scatter::{Panel, Point, scatter};
pub use sheet::{SheetRow, sheet};

use crate::ReportError;
use crate::figure::load_font;

const INK: RGBColor = RGBColor(38, 42, 48);
const FAINT: RGBColor = RGBColor(110, 116, 124);

/// A picture in memory: 8-bit RGB, row 0 on top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// `(height, width, 3)`.
    pub rgb: Vec<u8>,
}

/// A picture of numbers in memory: 16 bits each, row 0 on top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Gray {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// `(height, width)`.
    pub levels: Vec<u16>,
}

impl Gray {
    /// The picture as a PNG file's bytes.
    ///
    /// # Errors
    /// [`ReportError::Png`] for a picture without pixels, or with others than its size says.
    pub fn to_png(&self) -> Result<Vec<u8>, ReportError> {
        let bytes: Vec<u8> = self.levels.iter().flat_map(|level| level.to_be_bytes()).collect();
        png_of(
            [self.width, self.height],
            png::ColorType::Grayscale,
            png::BitDepth::Sixteen,
            &bytes,
        )
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

/// A text in a picture: where its anchor is, how large in pixels, in which colour.
struct Label<'a> {
    text: &'a str,
    at: (i32, i32),
    size: u32,
    color: RGBColor,
    anchor: Pos,
}

impl Picture {
    /// A white picture.
    pub fn blank(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            rgb: vec![255; width as usize * height as usize * 3],
        }
    }

    /// Puts a picture into this one with its top left corner at `(x, y)`; what does not fit is cut off.
    pub fn paste(&mut self, other: &Self, x: u32, y: u32) {
        let columns = other.width.min(self.width.saturating_sub(x)) as usize * 3;
        for row in 0..other.height.min(self.height.saturating_sub(y)) {
            let from = row as usize * other.width as usize * 3;
            let to = ((y + row) as usize * self.width as usize + x as usize) * 3;
            self.rgb[to..to + columns].copy_from_slice(&other.rgb[from..from + columns]);
        }
    }

    /// The picture at half the size, each pixel the mean of four: smooth edges for what was drawn too large.
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

    /// The picture as a PNG file's bytes.
    ///
    /// # Errors
    /// [`ReportError::Png`] for a picture without pixels, or with others than its size says.
    pub fn to_png(&self) -> Result<Vec<u8>, ReportError> {
        png_of(
            [self.width, self.height],
            png::ColorType::Rgb,
            png::BitDepth::Eight,
            &self.rgb,
        )
    }

    /// Draws texts.
    fn label(&mut self, labels: &[Label]) -> Result<(), ReportError> {
        self.draw(|area| {
            for label in labels {
                let style = ("sans-serif", label.size)
                    .into_font()
                    .color(&label.color)
                    .pos(label.anchor);
                area.draw_text(&printable(label.text), &style, label.at)?;
            }
            Ok(())
        })
    }

    /// Draws with the plotting library onto this picture.
    fn draw(
        &mut self,
        job: impl FnOnce(&DrawingArea<BitMapBackend, plotters::coord::Shift>) -> Result<(), Box<dyn std::error::Error>>,
    ) -> Result<(), ReportError> {
        load_font();
        let area = BitMapBackend::with_buffer(&mut self.rgb, (self.width, self.height)).into_drawing_area();
        job(&area)
            .and_then(|()| Ok(area.present()?))
            .map_err(|error| ReportError::Drawing {
                figure: "picture",
                // What the plotting library says cannot be sent between threads.
                source: error.to_string().into(),
            })
    }
}
