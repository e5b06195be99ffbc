//! A backend for the plotting library that records what it draws as shapes of a [`Drawing`].

use std::convert::Infallible;

use plotters_backend::text_anchor::{HPos, VPos};
use plotters_backend::{
    BackendColor, BackendCoord, BackendStyle, BackendTextStyle, DrawingBackend, DrawingErrorKind, FontTransform,
};

use super::{Drawing, Level, Shape, Side, TextLine, corner, middle};

/// The plotting library's font size divided by the font size in CSS: the library measures from a font's descender to its
/// ascender.
const LIBRARY_SIZE: f64 = 1.24;

/// The backend, which appends to a drawing.
pub(crate) struct Recorder<'a> {
    drawing: &'a mut Drawing,
}

type Outcome = Result<(), DrawingErrorKind<Infallible>>;

impl<'a> Recorder<'a> {
    pub(crate) fn onto(drawing: &'a mut Drawing) -> Self {
        Self { drawing }
    }

    fn push_line(&mut self, points: Vec<[f32; 2]>, style: &impl BackendStyle) {
        let BackendColor { alpha, rgb: (r, g, b) } = style.color();
        if alpha > 0.0 {
            self.drawing.shapes.push(Shape::Line {
                points,
                width: style.stroke_width() as f32,
                color: [r, g, b],
                alpha: alpha as f32,
                dash: None,
            });
        }
    }

    fn push_area(&mut self, points: Vec<[f32; 2]>, color: BackendColor) {
        let BackendColor { alpha, rgb: (r, g, b) } = color;
        if alpha > 0.0 {
            self.drawing.tint(points, [r, g, b], alpha as f32);
        }
    }
}

/// Lines of even width have sharp edges if they run between pixels, other lines if they run through pixel centres.
fn on_line(place: BackendCoord, style: &impl BackendStyle) -> [f32; 2] {
    if style.stroke_width().is_multiple_of(2) {
        corner(place)
    } else {
        middle(place)
    }
}

impl DrawingBackend for Recorder<'_> {
    type ErrorType = Infallible;

    fn get_size(&self) -> (u32, u32) {
        (self.drawing.width, self.drawing.height)
    }

    fn ensure_prepared(&mut self) -> Outcome {
        Ok(())
    }

    fn present(&mut self) -> Outcome {
        Ok(())
    }

    fn draw_pixel(&mut self, (x, y): BackendCoord, color: BackendColor) -> Outcome {
        let corners = [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)];
        let points = corners.map(corner);
        self.push_area(points.to_vec(), color);
        Ok(())
    }

    fn draw_line<S: BackendStyle>(&mut self, from: BackendCoord, to: BackendCoord, style: &S) -> Outcome {
        self.push_line(vec![on_line(from, style), on_line(to, style)], style);
        Ok(())
    }

    /// Filled rectangles include the pixels of both corners.
    fn draw_rect<S: BackendStyle>(
        &mut self,
        (left, top): BackendCoord,
        (right, bottom): BackendCoord,
        style: &S,
        fill: bool,
    ) -> Outcome {
        let (left, right) = (left.min(right), left.max(right));
        let (top, bottom) = (top.min(bottom), top.max(bottom));
        if fill {
            let corners = [
                (left, top),
                (right + 1, top),
                (right + 1, bottom + 1),
                (left, bottom + 1),
            ];
            let points = corners.map(corner);
            self.push_area(points.to_vec(), style.color());
        } else {
            let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
            self.push_line(corners.map(|corner| on_line(corner, style)).to_vec(), style);
        }
        Ok(())
    }

    fn draw_path<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(&mut self, path: I, style: &S) -> Outcome {
        let points = path.into_iter().map(|place| on_line(place, style)).collect();
        self.push_line(points, style);
        Ok(())
    }

    fn draw_circle<S: BackendStyle>(&mut self, at: BackendCoord, radius: u32, style: &S, fill: bool) -> Outcome {
        let (at, radius) = (middle(at), radius as f32);
        let BackendColor { alpha, rgb: (r, g, b) } = style.color();
        if fill && alpha > 0.0 {
            self.drawing.tint_disc(at, radius, [r, g, b], alpha as f32);
        } else if !fill {
            self.push_line(super::ring(at, radius), style);
        }
        Ok(())
    }

    fn fill_polygon<S: BackendStyle, I: IntoIterator<Item = BackendCoord>>(
        &mut self,
        corners: I,
        style: &S,
    ) -> Outcome {
        let points = corners.into_iter().map(corner).collect();
        self.push_area(points, style.color());
        Ok(())
    }

    fn draw_text<S: BackendTextStyle>(&mut self, text: &str, style: &S, (x, y): BackendCoord) -> Outcome {
        let BackendColor { rgb: (r, g, b), .. } = style.color();
        let size = (style.size() / LIBRARY_SIZE) as f32;
        let at = corner((x, y));
        let side = match style.anchor().h_pos {
            HPos::Left => Side::Left,
            HPos::Center => Side::Middle,
            HPos::Right => Side::Right,
        };
        let level = match style.anchor().v_pos {
            VPos::Top => Level::Top,
            VPos::Center => Level::Middle,
            VPos::Bottom => Level::Bottom,
        };
        let turns = match style.transform() {
            FontTransform::None => 0,
            FontTransform::Rotate90 => 1,
            FontTransform::Rotate180 => 2,
            FontTransform::Rotate270 => 3,
        };
        let words = TextLine::new(text, at, size, [r, g, b]).anchored(side, level);
        self.drawing.write(TextLine { turns, ..words });
        Ok(())
    }

    fn estimate_text_size<S: BackendTextStyle>(
        &self,
        text: &str,
        style: &S,
    ) -> Result<(u32, u32), DrawingErrorKind<Infallible>> {
        let size = style.size() / LIBRARY_SIZE;
        Ok((super::text_width(text, size as f32).ceil() as u32, size as u32))
    }
}
