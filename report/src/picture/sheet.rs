//! Sheets of views: rows of pictures under their titles.

use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{FAINT, INK, Label, Picture};
use crate::ReportError;

/// One row of a [`sheet`].
#[derive(Clone, Debug)]
pub struct SheetRow {
    /// What it shows.
    pub title: String,
    /// A few words below.
    pub words: String,
    /// Its pictures, all of one height.
    pub pictures: Vec<Picture>,
}

/// Rows of pictures, each under its title. `columns` rows stand side by side.
///
/// # Errors
/// [`ReportError::Drawing`].
pub fn sheet(rows: &[SheetRow], columns: usize) -> Result<Picture, ReportError> {
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
    fn row(&mut self, row: &SheetRow, left: u32, top: u32, [gap, head]: [u32; 2]) -> Result<(), ReportError> {
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
