//! Heat maps: distances as coloured, numbered cells.

use super::{Drawing, INK, Level, Rgb, Side, TextLine, WHITE, corner, font_size, text_width};

/// Font sizes of names and title, in pixels.
const LABEL: f32 = 14.0;
const TITLE: f32 = 20.0;

/// Draws a square table of distances as coloured cells, numbered if there is room. `labels` name rows and columns.
pub fn heat_map(title: &str, labels: &[String], value: impl Fn(usize, usize) -> f64) -> Drawing {
    let n = labels.len() as i32;
    let longest = labels
        .iter()
        .map(|label| text_width(label, LABEL).ceil() as i32)
        .max()
        .unwrap_or(0);
    let cell = (640 / n.max(1)).clamp(16, 92);
    // Names wider than a column are written vertically.
    let upright = longest > cell - 6;
    let (left, top) = (26 + longest, if upright { 64 + longest } else { 88 });
    let width = (left + cell * n).max(16 + text_width(title, TITLE).ceil() as i32) + 24;
    let mut picture = Drawing::blank(width as u32, (top + cell * n + 24) as u32);
    let numbers: Vec<f64> = (0..n * n).map(|k| value((k / n) as usize, (k % n) as usize)).collect();
    let largest = numbers.iter().copied().fold(0.0, f64::max);
    for (k, number) in numbers.iter().enumerate() {
        let (row, column) = (k as i32 / n, k as i32 % n);
        let at = corner((left + column * cell, top + row * cell));
        let share = if largest > 0.0 { number / largest } else { 0.0 };
        let side = (cell - 1) as f32;
        picture.rectangle([at[0], at[1], side, side], shade(share));
        if cell >= 36 {
            let color = if share > 0.55 { WHITE } else { INK };
            let middle = at.map(|place| place + (cell / 2) as f32);
            let words = TextLine::new(format!("{number:.2}"), middle, font_size(17.0), color);
            picture.write(words.anchored(Side::Middle, Level::Middle));
        }
    }
    picture.write(TextLine::new(title, [16.0, 14.0], TITLE, INK));
    let name = |label: &str, at: (i32, i32)| TextLine::new(label, corner(at), LABEL, INK);
    for (label, index) in labels.iter().zip(0..) {
        let middle = index * cell + cell / 2;
        picture.write(name(label, (left - 10, top + middle)).anchored(Side::Right, Level::Middle));
        if !upright {
            picture.write(name(label, (left + middle, top - 6)).anchored(Side::Middle, Level::Bottom));
        }
    }
    if upright {
        for (label, index) in labels.iter().zip(0..) {
            let words = name(label, (left + index * cell + cell / 2, top - 8)).anchored(Side::Left, Level::Middle);
            picture.write(TextLine { turns: 3, ..words });
        }
    }
    picture
}

/// Interpolates from nearly white at 0 to deep blue at 1.
fn shade(share: f64) -> Rgb {
    let mix = |from: f64, to: f64| (from + (to - from) * share.clamp(0.0, 1.0)) as u8;
    [mix(240.0, 22.0), mix(245.0, 72.0), mix(250.0, 130.0)]
}
