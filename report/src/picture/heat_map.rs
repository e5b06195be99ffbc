//! Heat maps: distances as coloured cells with their numbers.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{Drawing, INK, Label, Level, Side, TextLine, text_width};
use crate::ReportError;

/// Sizes of the letters of names and of the title, in pixels.
const LABEL: f32 = 14.0;
const TITLE: f32 = 20.0;

/// A square table of distances as coloured cells with their numbers; `labels` name rows and columns.
///
/// # Errors
/// [`ReportError::Drawing`].
pub fn heat_map(title: &str, labels: &[String], value: impl Fn(usize, usize) -> f64) -> Result<Drawing, ReportError> {
    let n = labels.len() as i32;
    let longest = labels
        .iter()
        .map(|label| text_width(label, LABEL).ceil() as i32)
        .max()
        .unwrap_or(0);
    let cell = (640 / n.max(1)).clamp(16, 92);
    // Names that are wider than a column stand upright.
    let upright = longest > cell - 6;
    let (left, top) = (26 + longest, if upright { 64 + longest } else { 88 });
    let width = (left + cell * n).max(16 + text_width(title, TITLE).ceil() as i32) + 24;
    let mut picture = Drawing::blank(width as u32, (top + cell * n + 24) as u32);
    let numbers: Vec<f64> = (0..n * n).map(|k| value((k / n) as usize, (k % n) as usize)).collect();
    let largest = numbers.iter().copied().fold(0.0, f64::max);
    picture.draw(1.0, |area| {
        for (k, number) in numbers.iter().enumerate() {
            let (row, column) = (k as i32 / n, k as i32 % n);
            let (x, y) = (left + column * cell, top + row * cell);
            let share = if largest > 0.0 { number / largest } else { 0.0 };
            area.draw(&Rectangle::new(
                [(x, y), (x + cell - 2, y + cell - 2)],
                shade(share).filled(),
            ))?;
            if cell >= 36 {
                let color = if share > 0.55 { WHITE } else { INK };
                let style = ("sans-serif", 17)
                    .into_font()
                    .color(&color)
                    .pos(Pos::new(HPos::Center, VPos::Center));
                area.draw_text(&format!("{number:.2}"), &style, (x + cell / 2, y + cell / 2))?;
            }
        }
        Ok(())
    })?;
    let mut texts = vec![Label {
        text: title,
        at: (16, 14),
        size: TITLE as u32,
        color: INK,
        anchor: Pos::new(HPos::Left, VPos::Top),
    }];
    for (label, index) in labels.iter().zip(0..) {
        let middle = index * cell + cell / 2;
        let right = Pos::new(HPos::Right, VPos::Center);
        texts.push(Label {
            text: label,
            at: (left - 10, top + middle),
            size: LABEL as u32,
            color: INK,
            anchor: right,
        });
        if !upright {
            let above = Pos::new(HPos::Center, VPos::Bottom);
            texts.push(Label {
                text: label,
                at: (left + middle, top - 6),
                size: LABEL as u32,
                color: INK,
                anchor: above,
            });
        }
    }
    picture.label(&texts);
    if upright {
        for (label, index) in labels.iter().zip(0..) {
            let RGBColor(r, g, b) = INK;
            let at = [(left + index * cell + cell / 2) as f32, (top - 8) as f32];
            let words = TextLine::new(label, at, LABEL, [r, g, b]).anchored(Side::Left, Level::Middle);
            picture.write(TextLine { turns: 3, ..words });
        }
    }
    Ok(picture)
}

/// From nearly white at 0 to deep blue at 1.
fn shade(share: f64) -> RGBColor {
    let mix = |from: f64, to: f64| (from + (to - from) * share.clamp(0.0, 1.0)) as u8;
    RGBColor(mix(240.0, 22.0), mix(245.0, 72.0), mix(250.0, 130.0))
}
