//! Pictures with words: sheets of views and heat maps. The views themselves are rendered by `env`.

mod scatter;

use std::path::Path;
use std::sync::Once;

use driftworld_text::{ShownPath, printable};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, register_font};

pub(crate) use scatter::{Panel, Point, scatter};

use super::{Failure, output};

pub(crate) const INK: RGBColor = RGBColor(38, 42, 48);
pub(crate) const FAINT: RGBColor = RGBColor(110, 116, 124);

/// A picture in memory: 8-bit RGB, row 0 on top.
#[derive(Clone)]
pub(crate) struct Picture {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) rgb: Vec<u8>,
}

/// A picture of numbers in memory: 16 bits each, row 0 on top.
pub(crate) struct Gray {
    pub(crate) width: u32,
    pub(crate) height: u32,
    pub(crate) levels: Vec<u16>,
}

impl Gray {
    /// The picture as a PNG file's bytes.
    pub(crate) fn to_png(&self) -> Result<Vec<u8>, Failure> {
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
fn png_of(size: [u32; 2], color: png::ColorType, depth: png::BitDepth, data: &[u8]) -> Result<Vec<u8>, Failure> {
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
pub(super) struct Label<'a> {
    pub(super) text: &'a str,
    pub(super) at: (i32, i32),
    pub(super) size: u32,
    pub(super) color: RGBColor,
    pub(super) anchor: Pos,
}

impl Picture {
    /// A white picture.
    pub(crate) fn blank(width: u32, height: u32) -> Self {
        Self {
            width,
            height,
            rgb: vec![255; width as usize * height as usize * 3],
        }
    }

    /// Puts a picture into this one with its top left corner at `(x, y)`; what does not fit is cut off.
    pub(crate) fn paste(&mut self, other: &Self, x: u32, y: u32) {
        let columns = other.width.min(self.width.saturating_sub(x)) as usize * 3;
        for row in 0..other.height.min(self.height.saturating_sub(y)) {
            let from = row as usize * other.width as usize * 3;
            let to = ((y + row) as usize * self.width as usize + x as usize) * 3;
            self.rgb[to..to + columns].copy_from_slice(&other.rgb[from..from + columns]);
        }
    }

    /// The picture at half the size, each pixel the mean of four: smooth edges for what was drawn too large.
    pub(crate) fn halved(&self) -> Self {
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
    pub(crate) fn to_png(&self) -> Result<Vec<u8>, Failure> {
        png_of(
            [self.width, self.height],
            png::ColorType::Rgb,
            png::BitDepth::Eight,
            &self.rgb,
        )
    }

    /// Writes the picture as a PNG file.
    ///
    /// A name that ends like another kind of file is refused: it would lie.
    pub(crate) fn write(&self, path: &Path) -> Result<(), Failure> {
        const OTHERS: [&str; 16] = [
            "jpg", "jpeg", "gif", "bmp", "webp", "tif", "tiff", "svg", "pdf", "csv", "html", "json", "jsonl", "npy",
            "parquet", "txt",
        ];
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        if OTHERS.iter().any(|other| ending.eq_ignore_ascii_case(other)) {
            return Err(Failure::usage(format!(
                "{}: found a name that ends with .{ending}, expected .png: pictures are written as PNG",
                path.shown()
            )));
        }
        output::write(path, &self.to_png()?)
    }

    /// Writes the picture as a PNG file, and says so with its size.
    pub(crate) fn write_and_tell(&self, path: &Path) -> Result<(), Failure> {
        self.write(path)?;
        output::line(format!("{}: {} × {} pixels", path.shown(), self.width, self.height))
    }

    /// Draws texts.
    pub(super) fn label(&mut self, labels: &[Label]) -> Result<(), Failure> {
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
    pub(crate) fn draw(
        &mut self,
        job: impl FnOnce(&DrawingArea<BitMapBackend, plotters::coord::Shift>) -> Result<(), Box<dyn std::error::Error>>,
    ) -> Result<(), Failure> {
        load_font();
        let area = BitMapBackend::with_buffer(&mut self.rgb, (self.width, self.height)).into_drawing_area();
        job(&area)
            .and_then(|()| Ok(area.present()?))
            .map_err(|error| Failure::input(format!("drawing: {error}")))
    }
}

/// The font is part of the program, so that pictures look alike on machines with and without fonts.
fn load_font() {
    static LOADED: Once = Once::new();
    LOADED.call_once(|| {
        let loaded = register_font("sans-serif", FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
        debug_assert!(loaded.is_ok(), "the embedded font is a valid one");
    });
}

/// One row of a sheet: what it shows, a few words below, and its pictures, all of one height.
pub(crate) struct SheetRow {
    pub(crate) title: String,
    pub(crate) words: String,
    pub(crate) pictures: Vec<Picture>,
}

/// Rows of pictures, each under its title. `columns` rows stand side by side.
pub(crate) fn sheet(rows: &[SheetRow], columns: usize) -> Result<Picture, Failure> {
    const GAP: u32 = 12;
    const HEAD: u32 = 46;
    let width_of = |row: &SheetRow| row.pictures.iter().map(|picture| picture.width + GAP).sum::<u32>();
    let height_of = |row: &SheetRow| row.pictures.iter().map(|picture| picture.height).max().unwrap_or(0) + HEAD + GAP;
    let cell_width = rows.iter().map(width_of).max().unwrap_or(0);
    let columns = columns.clamp(1, rows.len().max(1));
    let line_height = |line: &[SheetRow]| line.iter().map(height_of).max().unwrap_or(0);
    let height = rows.chunks(columns).map(line_height).sum::<u32>();
    let mut sheet = Picture::blank(cell_width * columns as u32 + GAP, height + GAP);
    let mut top = GAP;
    for line in rows.chunks(columns) {
        for (column, row) in line.iter().enumerate() {
            sheet.row(row, column as u32 * cell_width + GAP, top, [GAP, HEAD])?;
        }
        top += line_height(line);
    }
    Ok(sheet)
}

impl Picture {
    /// Puts one row of a sheet down with its top left corner at `(left, top)`.
    fn row(&mut self, row: &SheetRow, left: u32, top: u32, [gap, head]: [u32; 2]) -> Result<(), Failure> {
        let mut x = left;
        for picture in &row.pictures {
            self.paste(&picture.framed(), x, top + head);
            x += picture.width + gap;
        }
        let anchor = Pos::new(HPos::Left, VPos::Top);
        self.label(&[
            Label {
                text: &row.title,
                at: (left as i32, top as i32),
                size: 22,
                color: INK,
                anchor,
            },
            Label {
                text: &row.words,
                at: (left as i32, top as i32 + 25),
                size: 15,
                color: FAINT,
                anchor,
            },
        ])
    }

    /// The picture with a thin grey rim, so that white ones end somewhere.
    fn framed(&self) -> Self {
        let mut framed = self.clone();
        let (width, height) = (self.width as usize, self.height as usize);
        for y in 0..height {
            for x in 0..width {
                if x == 0 || y == 0 || x + 1 == width || y + 1 == height {
                    framed.rgb[(y * width + x) * 3..][..3].copy_from_slice(&[150, 154, 160]);
                }
            }
        }
        framed
    }
}

/// A square table of distances as coloured cells with their numbers; `labels` name rows and columns.
pub(crate) fn heat_map(
    title: &str,
    labels: &[String],
    value: impl Fn(usize, usize) -> f64,
) -> Result<Picture, Failure> {
    let n = labels.len() as i32;
    let longest = labels.iter().map(|label| label.chars().count()).max().unwrap_or(0) as i32;
    let cell = (640 / n.max(1)).clamp(16, 92);
    let (left, top) = (24 + 9 * longest, 88);
    let mut picture = Picture::blank((left + cell * n + 24) as u32, (top + cell * n + 24) as u32);
    let numbers: Vec<f64> = (0..n * n).map(|k| value((k / n) as usize, (k % n) as usize)).collect();
    let largest = numbers.iter().copied().fold(0.0, f64::max);
    picture.draw(|area| {
        for (k, number) in numbers.iter().enumerate() {
            let (row, column) = (k as i32 / n, k as i32 % n);
            let (x, y) = (left + column * cell, top + row * cell);
            let share = if largest > 0.0 { number / largest } else { 0.0 };
            area.draw(&Rectangle::new(
                [(x, y), (x + cell - 2, y + cell - 2)],
                shade(share).filled(),
            ))?;
            if cell >= 36 {
                let ink = if share > 0.55 { WHITE } else { INK };
                let style = ("sans-serif", 16)
                    .into_font()
                    .color(&ink)
                    .pos(Pos::new(HPos::Center, VPos::Center));
                area.draw_text(&format!("{number:.2}"), &style, (x + cell / 2, y + cell / 2))?;
            }
        }
        Ok(())
    })?;
    let mut texts = vec![Label {
        text: title,
        at: (16, 14),
        size: 22,
        color: INK,
        anchor: Pos::new(HPos::Left, VPos::Top),
    }];
    for (label, index) in labels.iter().zip(0..) {
        let middle = index * cell + cell / 2;
        let right = Pos::new(HPos::Right, VPos::Center);
        texts.push(Label {
            text: label,
            at: (left - 10, top + middle),
            size: 16,
            color: INK,
            anchor: right,
        });
        if cell >= 56 {
            let above = Pos::new(HPos::Center, VPos::Bottom);
            texts.push(Label {
                text: label,
                at: (left + middle, top - 8),
                size: 16,
                color: INK,
                anchor: above,
            });
        }
    }
    picture.label(&texts)?;
    Ok(picture)
}

/// From nearly white at 0 to deep blue at 1.
fn shade(share: f64) -> RGBColor {
    let mix = |from: f64, to: f64| (from + (to - from) * share.clamp(0.0, 1.0)) as u8;
    RGBColor(mix(240.0, 22.0), mix(245.0, 72.0), mix(250.0, 130.0))
}
