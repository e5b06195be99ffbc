//! [`Drawing`]s: lists of shapes, text and pixels, which become PNG or SVG files.

mod fill;
mod pixels;
mod recorder;
mod svg;
mod text;

pub use pixels::{Gray, Picture};
pub(crate) use recorder::Recorder;
pub use text::text_width;

use crate::ReportError;

/// A colour of a drawing, sRGB.
pub type Rgb = [u8; 3];

/// Position of a text's anchor along its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Before the first character.
    Left,
    /// In the middle.
    Middle,
    /// After the last character.
    Right,
}

/// Position of a text's anchor across its line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// At the top of capital letters.
    Top,
    /// In the middle of lower-case letters.
    Middle,
    /// Below the line.
    Bottom,
}

/// A line of text in a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct TextLine {
    /// Its content, on one line.
    pub text: String,
    /// Position of its anchor, in pixels from the left and from the top.
    pub at: [f32; 2],
    /// Font size in pixels, as in CSS.
    pub size: f32,
    /// Its colour.
    pub color: Rgb,
    /// The anchor along the line.
    pub side: Side,
    /// The anchor across the line.
    pub level: Level,
    /// Colour of an outline around the characters, to make them readable on an image.
    pub rim: Option<Rgb>,
    /// Quarter turns clockwise around the anchor.
    pub turns: u8,
}

impl TextLine {
    /// Text with its anchor at the top left.
    pub fn new(text: impl Into<String>, at: [f32; 2], size: f32, color: Rgb) -> Self {
        Self {
            text: text.into(),
            at,
            size,
            color,
            side: Side::Left,
            level: Level::Top,
            rim: None,
            turns: 0,
        }
    }

    /// Moves the anchor.
    #[must_use]
    pub fn anchored(self, side: Side, level: Level) -> Self {
        Self { side, level, ..self }
    }

    /// Adds an outline.
    #[must_use]
    pub fn rimmed(self, color: Rgb) -> Self {
        Self {
            rim: Some(color),
            ..self
        }
    }

    /// Its width in pixels, according to the font.
    pub fn width(&self) -> f32 {
        text_width(&self.text, self.size)
    }

    /// Offset of the start of the line from the anchor: to the right, and down to the baseline.
    fn offset(&self) -> [f32; 2] {
        let along = match self.side {
            Side::Left => 0.0,
            Side::Middle => -0.5,
            Side::Right => -1.0,
        };
        let down = match self.level {
            Level::Top => 0.76,
            Level::Middle => 0.26,
            Level::Bottom => -0.26,
        };
        [along * self.width(), down * self.size]
    }
}

/// A shape of a drawing. Lengths are in pixels, alphas in 0..=1.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A filled polygon.
    Area {
        /// Its corners.
        points: Vec<[f32; 2]>,
        /// Its colour.
        color: Rgb,
        /// Its opacity.
        alpha: f32,
    },
    /// A line through points.
    Line {
        /// Its points.
        points: Vec<[f32; 2]>,
        /// Its width.
        width: f32,
        /// Its colour.
        color: Rgb,
        /// Its opacity.
        alpha: f32,
        /// Length of its dashes and of the gaps between them; `None` for a solid line.
        dash: Option<f32>,
    },
    /// A filled circle.
    Disc {
        /// Its centre.
        middle: [f32; 2],
        /// Its radius.
        radius: f32,
        /// Its colour.
        color: Rgb,
        /// Its opacity.
        alpha: f32,
    },
    /// Text.
    Text(TextLine),
    /// Another drawing, with its top left corner at `at`; anything beyond its edges is cut off.
    Inner {
        /// Pixels from the left and from the top.
        at: [u32; 2],
        /// The drawing.
        drawing: Drawing,
    },
    /// Pixels, with their top left corner at the drawing's.
    Pixels(Picture),
}

/// A list of shapes on white paper, the lowest first.
#[derive(Clone, Debug, PartialEq)]
pub struct Drawing {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// Its shapes, the lowest first.
    pub shapes: Vec<Shape>,
}

impl From<Picture> for Drawing {
    fn from(picture: Picture) -> Self {
        Self {
            width: picture.width,
            height: picture.height,
            shapes: vec![Shape::Pixels(picture)],
        }
    }
}

impl Drawing {
    /// An empty white drawing.
    pub fn blank(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            shapes: Vec::new(),
        }
    }

    /// Adds a filled polygon.
    pub fn area(&mut self, points: impl Into<Vec<[f32; 2]>>, color: Rgb) {
        self.tint(points, color, 1.0);
    }

    /// Adds a filled polygon with this alpha.
    pub fn tint(&mut self, points: impl Into<Vec<[f32; 2]>>, color: Rgb, alpha: f32) {
        let points = points.into();
        self.shapes.push(Shape::Area { points, color, alpha });
    }

    /// Adds a filled rectangle: left, top, width, height.
    pub fn rectangle(&mut self, [left, top, width, height]: [f32; 4], color: Rgb) {
        let (right, bottom) = (left + width, top + height);
        self.area([[left, top], [right, top], [right, bottom], [left, bottom]], color);
    }

    /// Adds a line.
    pub fn line(&mut self, points: impl Into<Vec<[f32; 2]>>, width: f32, color: Rgb) {
        self.shapes.push(Shape::Line {
            points: points.into(),
            width,
            color,
            alpha: 1.0,
            dash: None,
        });
    }

    /// Adds a filled circle.
    pub fn disc(&mut self, middle: [f32; 2], radius: f32, color: Rgb) {
        self.tint_disc(middle, radius, color, 1.0);
    }

    /// Adds a filled circle with this alpha.
    pub fn tint_disc(&mut self, middle: [f32; 2], radius: f32, color: Rgb, alpha: f32) {
        self.shapes.push(Shape::Disc {
            middle,
            radius,
            color,
            alpha,
        });
    }

    /// Adds text, with unprintable characters escaped.
    #[expect(
        clippy::needless_pass_by_value,
        reason = "a line of text is passed by value, like every other shape"
    )]
    pub fn write(&mut self, words: TextLine) {
        let text = driftworld_text::printable(&words.text).to_string();
        self.shapes.push(Shape::Text(TextLine { text, ..words }));
    }

    /// Adds another drawing, clipped to its bounds.
    pub fn put(&mut self, drawing: impl Into<Self>, at: [u32; 2]) {
        let drawing = drawing.into();
        self.shapes.push(Shape::Inner { at, drawing });
    }

    /// The drawing as pixels.
    pub fn to_picture(&self) -> Picture {
        let mut picture = Picture::blank(self.width, self.height);
        for shape in &self.shapes {
            match shape {
                Shape::Area { points, color, alpha } => {
                    fill::fill(&mut picture, std::slice::from_ref(points), *color, *alpha);
                }
                Shape::Line {
                    points,
                    width,
                    color,
                    alpha,
                    dash,
                } => {
                    let dashes = fill::dashes(points, *dash);
                    let pieces: Vec<_> = dashes.iter().flat_map(|piece| fill::stroke(piece, *width)).collect();
                    fill::fill(&mut picture, &pieces, *color, *alpha);
                }
                Shape::Disc {
                    middle,
                    radius,
                    color,
                    alpha,
                } => fill::fill(&mut picture, &[fill::circle(*middle, *radius)], *color, *alpha),
                Shape::Text(words) => text::draw(&mut picture, words),
                Shape::Inner { at, drawing } => picture.paste(&drawing.to_picture(), at[0], at[1]),
                Shape::Pixels(pixels) => picture.paste(pixels, 0, 0),
            }
        }
        picture
    }

    /// The drawing as a PNG file's bytes.
    ///
    /// # Errors
    /// [`ReportError::Png`] for a drawing without pixels.
    pub fn to_png(&self) -> Result<Vec<u8>, ReportError> {
        self.to_picture().to_png()
    }

    /// The drawing as an SVG file: shapes as vectors, text as text, pixels as embedded PNG.
    ///
    /// # Errors
    /// [`ReportError::Png`] for invalid pixels.
    pub fn to_svg(&self) -> Result<String, ReportError> {
        svg::file(self)
    }

    /// All texts in the drawing, including those of inner drawings.
    pub fn texts(&self) -> Vec<&str> {
        let mut texts = Vec::new();
        for shape in &self.shapes {
            match shape {
                Shape::Text(words) => texts.push(words.text.as_str()),
                Shape::Inner { drawing, .. } => texts.extend(drawing.texts()),
                _ => {}
            }
        }
        texts
    }
}

/// The centre of a pixel.
pub(crate) fn middle((x, y): (i32, i32)) -> [f32; 2] {
    [x, y].map(|pixel| pixel as f32 + 0.5)
}

/// The top left corner of a pixel.
pub(crate) fn corner((x, y): (i32, i32)) -> [f32; 2] {
    [x, y].map(|pixel| pixel as f32)
}

/// A closed line around a centre, for rings.
pub fn ring(middle: [f32; 2], radius: f32) -> Vec<[f32; 2]> {
    let mut points = fill::circle(middle, radius);
    points.extend(points.first().copied());
    points
}
