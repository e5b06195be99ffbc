//! Images with text: sheets of views, heat maps, path maps, blocks of curricula, scatter plots. Each is a [`Drawing`], which is
//! written as PNG or SVG.

mod blocks;
mod caption;
mod heat_map;
mod lines;
mod path_map;
mod scatter;
mod sheet;

pub use blocks::blocks;
pub use caption::{MAX_CAPTION_LINES, caption_lines};
pub use heat_map::heat_map;
pub use lines::text_lines;
pub use path_map::path_map;
pub use scatter::{Panel, Point, scatter};
pub use sheet::{SheetRow, sheet};

pub use crate::drawing::{Drawing, Gray, Level, Picture, Rgb, Shape, Side, TextLine, ring, text_width};

use crate::drawing::{corner, middle};

const INK: Rgb = [38, 42, 48];
const FAINT: Rgb = [110, 116, 124];
const WHITE: Rgb = [255; 3];

/// Text anchored at a pixel's corner, in a font of this height from descender to ascender.
fn words(text: impl Into<String>, at: (i32, i32), height: f64, color: Rgb) -> TextLine {
    TextLine::new(text, corner(at), font_size(height), color)
}

/// The CSS size of a font of this height from descender to ascender.
fn font_size(height: f64) -> f32 {
    (height / 1.24) as f32
}

/// The smallest of 1, 2, 5 and 10 times a power of ten that is at least the given number.
#[expect(clippy::disallowed_methods, reason = "ticks of a figure, rounded to pixels")]
fn round_step(least: f64) -> f64 {
    let power = 10_f64.powf(least.log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    steps.into_iter().find(|step| *step >= least).unwrap_or(10.0 * power)
}
