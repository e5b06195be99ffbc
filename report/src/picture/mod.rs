//! Pictures with words in them: sheets of views, heat maps, maps of paths, blocks of curricula, points on axes. Each is a
//! [`Drawing`], of which PNG and SVG are made.
//!
//! Not here: the views themselves, which `env` renders; figures of lifetimes, see `figure`; files, which are the caller's.

mod blocks;
mod caption;
mod heat_map;
mod lines;
mod path_map;
mod scatter;
mod sheet;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

pub use blocks::blocks;
pub use caption::{MAX_CAPTION_LINES, caption_lines};
pub use heat_map::heat_map;
pub use lines::text_lines;
pub use path_map::path_map;
pub use scatter::{Panel, Point, scatter};
pub use sheet::{SheetRow, sheet};

pub use crate::drawing::{Drawing, Gray, Level, Picture, Rgb, Shape, Side, TextLine, ring, text_width};

use crate::ReportError;
use crate::drawing::Recorder;
use crate::figure::load_font;

const INK: RGBColor = RGBColor(38, 42, 48);
const FAINT: RGBColor = RGBColor(110, 116, 124);

/// A text in a picture: where its anchor is, how large in pixels, in which colour.
struct Label<'a> {
    text: &'a str,
    at: (i32, i32),
    size: u32,
    color: RGBColor,
    anchor: Pos,
}

impl Label<'_> {
    fn words(&self) -> TextLine {
        let side = match self.anchor.h_pos {
            HPos::Left => Side::Left,
            HPos::Center => Side::Middle,
            HPos::Right => Side::Right,
        };
        let level = match self.anchor.v_pos {
            VPos::Top => Level::Top,
            VPos::Center => Level::Middle,
            VPos::Bottom => Level::Bottom,
        };
        let at = [self.at.0 as f32, self.at.1 as f32];
        let RGBColor(r, g, b) = self.color;
        TextLine::new(self.text, at, self.size as f32, [r, g, b]).anchored(side, level)
    }
}

impl Drawing {
    /// Writes texts.
    fn label(&mut self, labels: &[Label]) {
        for label in labels {
            self.write(label.words());
        }
    }

    /// Draws with the plotting library onto this drawing, whose lengths are multiplied by `scale`.
    fn draw(
        &mut self,
        scale: f32,
        job: impl FnOnce(&DrawingArea<Recorder<'_>, plotters::coord::Shift>) -> Result<(), Box<dyn std::error::Error>>,
    ) -> Result<(), ReportError> {
        load_font();
        let area = Recorder::onto(self, scale).into_drawing_area();
        job(&area)
            .and_then(|()| Ok(area.present()?))
            .map_err(|error| ReportError::Drawing {
                figure: "picture",
                // What the plotting library says cannot be sent between threads.
                source: error.to_string().into(),
            })
    }
}
