//! Sheets of views: rows of images under their titles.

use super::lines::cut;
use super::{Drawing, FAINT, INK, Rgb, TextLine, text_lines, text_width};

/// One row of a [`sheet`].
#[derive(Clone, Debug, PartialEq)]
pub struct SheetRow {
    /// Its title.
    pub title: String,
    /// A few words below, continued on further lines if needed.
    pub words: String,
    /// Its images, all of the same height.
    pub pictures: Vec<Drawing>,
}

impl SheetRow {
    /// Makes a row.
    pub fn new(title: impl Into<String>, words: impl Into<String>, pictures: Vec<Drawing>) -> Self {
        let (title, words) = (title.into(), words.into());
        Self { title, words, pictures }
    }
}

/// Gap between images, in pixels.
const GAP: u32 = 12;
/// Font sizes, and line heights.
const TITLE: (f32, u32) = (19.0, 26);
const WORDS: (f32, u32) = (13.0, 17);
/// Maximum number of lines below a title.
const MAX_LINES: usize = 5;
/// Colour of the border of images, which gives white ones visible edges.
const RIM: Rgb = [150, 154, 160];

/// Draws rows of images, each under its title, with `columns` rows side by side.
pub fn sheet(rows: &[SheetRow], columns: usize) -> Drawing {
    let width_of = |row: &SheetRow| row.pictures.iter().map(|picture| picture.width + GAP).sum::<u32>();
    let cell_width = rows.iter().map(width_of).max().unwrap_or(0);
    let columns = columns.clamp(1, rows.len().max(1));
    let cells: Vec<Cell> = rows.iter().map(|row| Cell::of(row, cell_width - GAP)).collect();
    // Cells side by side start and end at the same height.
    let heads = |line: &[Cell]| line.iter().map(Cell::head).max().unwrap_or(0);
    let bodies = |line: &[Cell]| line.iter().map(Cell::body).max().unwrap_or(0);
    let height: u32 = cells.chunks(columns).map(|line| heads(line) + bodies(line) + GAP).sum();
    let mut sheet = Drawing::blank(cell_width * columns as u32 + GAP, height + GAP);
    let mut top = GAP;
    for line in cells.chunks(columns) {
        let head = heads(line);
        for (column, cell) in line.iter().enumerate() {
            cell.put(&mut sheet, [column as u32 * cell_width + GAP, top], head);
        }
        top += head + bodies(line) + GAP;
    }
    sheet
}

/// A row with its text broken into lines.
struct Cell<'a> {
    title: String,
    lines: Vec<String>,
    pictures: &'a [Drawing],
}

impl<'a> Cell<'a> {
    /// Makes a cell. If the title is too wide for its image, the part after its colon moves into the words below.
    fn of(row: &'a SheetRow, width: u32) -> Self {
        let title = driftworld_text::printable(&row.title).into_owned();
        let mut words = driftworld_text::printable(&row.words).into_owned();
        let width = width as f32;
        let title = match title.split_once(": ") {
            Some((first, rest)) if text_width(&title, TITLE.0) > width => {
                // The no-break space keeps the dot at the end of a line.
                words = [rest, words.as_str()].map(str::trim).join("\u{a0}· ");
                first
            }
            _ => &title,
        };
        Self {
            title: cut(title, TITLE.0, width),
            lines: lines(words.trim_end_matches("\u{a0}· "), WORDS.0, width),
            pictures: &row.pictures,
        }
    }

    fn head(&self) -> u32 {
        TITLE.1 + WORDS.1 * self.lines.len() as u32 + 3
    }

    fn body(&self) -> u32 {
        self.pictures.iter().map(|picture| picture.height).max().unwrap_or(0)
    }

    /// Draws the cell with its top left corner at `(left, top)`, and its images `head` lower.
    fn put(&self, sheet: &mut Drawing, [left, top]: [u32; 2], head: u32) {
        let at = |line: u32| [left as f32, (top + line) as f32];
        sheet.write(TextLine::new(&self.title, at(2), TITLE.0, INK));
        for (number, line) in self.lines.iter().enumerate() {
            let below = TITLE.1 + number as u32 * WORDS.1;
            sheet.write(TextLine::new(line, at(below), WORDS.0, FAINT));
        }
        let mut x = left;
        for picture in self.pictures {
            sheet.put(picture.clone(), [x, top + head]);
            let (x0, y0) = (x as f32 + 0.5, (top + head) as f32 + 0.5);
            let (x1, y1) = (x0 + picture.width as f32 - 1.0, y0 + picture.height as f32 - 1.0);
            sheet.line([[x0, y0], [x1, y0], [x1, y1], [x0, y1], [x0, y0]], 1.0, RIM);
            x += picture.width + GAP;
        }
    }
}

/// Breaks a text into at most `MAX_LINES` lines of at most this width. A separator never ends a line.
fn lines(text: &str, size: f32, width: f32) -> Vec<String> {
    let mut lines = text_lines(text, size, width);
    for line in &mut lines {
        line.truncate(line.trim_end_matches(" ·").len());
    }
    if lines.len() > MAX_LINES {
        let rest = lines.split_off(MAX_LINES - 1).join(" ");
        lines.push(cut(&rest, size, width));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::Picture;

    #[test]
    fn words_continue_on_the_next_line_and_none_is_too_wide() {
        let text = "Red cubes at dusk; the light is 0.3 instead of 1, and everything else is as in the first variant. "
            .repeat(4);
        for width in [40.0, 120.0, 333.0] {
            let lines = lines(&text, 13.0, width);
            assert!(lines.len() <= MAX_LINES && lines.iter().all(|line| text_width(line, 13.0) <= width));
            assert!(lines.last().is_some_and(|line| line.ends_with('…')));
        }
        assert_eq!(lines("a few words", 13.0, 300.0), ["a few words"]);
    }

    #[test]
    fn title_too_wide_for_its_image_continues_in_the_words() {
        let row = SheetRow {
            title: "Step 120: touches the red berries: +100.0".to_owned(),
            words: "12.0 s · return 98.8".to_owned(),
            pictures: Vec::new(),
        };
        let shown = |width| {
            let cell = Cell::of(&row, width);
            (cell.title, cell.lines.join(" "))
        };
        assert_eq!(shown(500), (row.title.clone(), row.words.clone()));
        // The dot is dropped at the end of a line.
        let below = "touches the red berries: +100.0 12.0 s · return 98.8";
        assert_eq!(shown(200), ("Step 120".to_owned(), below.to_owned()));
        let silent = SheetRow {
            words: String::new(),
            ..row.clone()
        };
        assert_eq!(
            Cell::of(&silent, 160).lines.join(" "),
            "touches the red berries: +100.0"
        );
    }

    #[test]
    fn everything_is_inside_the_sheet() {
        let row = |words: &str, wide: u32| SheetRow {
            title: "a title that is much too long for the little room that it has here".to_owned(),
            words: words.to_owned(),
            pictures: vec![Picture::blank(wide, 50).into()],
        };
        let rows = [row("one", 220), row(&"many words ".repeat(30), 120), row("", 90)];
        for columns in 1..4 {
            let sheet = sheet(&rows, columns);
            for shape in &sheet.shapes {
                match shape {
                    crate::picture::Shape::Inner { at, drawing } => {
                        assert!(at[0] + drawing.width < sheet.width && at[1] + drawing.height < sheet.height);
                    }
                    crate::picture::Shape::Text(words) => {
                        assert!(words.at[0] + words.width() <= sheet.width as f32);
                    }
                    _ => {}
                }
            }
        }
    }
}
