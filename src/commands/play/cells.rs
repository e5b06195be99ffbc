//! Pictures in a terminal: each cell is a half block with two pixels, one above the other. Only changed cells are sent.

use std::fmt::Write;

use crate::report::picture::Picture;

/// A picture as terminal cells.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Cells {
    columns: usize,
    /// The upper and the lower pixel of each cell, row by row.
    cells: Vec<[[u8; 3]; 2]>,
}

impl Cells {
    /// A picture centred on black, in the given number of columns and rows.
    pub(super) fn new(picture: &Picture, columns: usize, rows: usize) -> Self {
        let (width, height) = (picture.width as usize, picture.height as usize);
        let (left, top) = (columns.saturating_sub(width) / 2, (2 * rows).saturating_sub(height) / 2);
        let pixel = |x: usize, y: usize| -> [u8; 3] {
            let (Some(x), Some(y)) = (x.checked_sub(left), y.checked_sub(top)) else {
                return [0; 3];
            };
            if x >= width || y >= height {
                return [0; 3];
            }
            let start = 3 * (y * width + x);
            [picture.rgb[start], picture.rgb[start + 1], picture.rgb[start + 2]]
        };
        let cell = |index: usize| {
            let (x, y) = (index % columns, index / columns);
            [pixel(x, 2 * y), pixel(x, 2 * y + 1)]
        };
        Self {
            columns,
            cells: (0..columns * rows).map(cell).collect(),
        }
    }

    /// The terminal codes that replace the picture `before` with this one, starting at the terminal's first row. Draws the whole
    /// picture if `before` is missing or has a different size.
    pub(super) fn draw_over(&self, before: Option<&Self>) -> String {
        let before = before.filter(|before| (before.columns, before.cells.len()) == (self.columns, self.cells.len()));
        let mut out = String::new();
        // The cell at the cursor, and the current colours.
        let (mut cursor, mut colors) = (None, None);
        for (index, cell) in self.cells.iter().enumerate() {
            if before.is_some_and(|before| before.cells[index] == *cell) {
                continue;
            }
            let (row, column) = (index / self.columns, index % self.columns);
            // Writing into a string cannot fail.
            if cursor != Some(index) || column == 0 {
                let _ = write!(out, "\x1b[{};{}H", row + 1, column + 1);
            }
            if colors != Some(*cell) {
                let [[r, g, b], [r2, g2, b2]] = cell;
                let _ = write!(out, "\x1b[38;2;{r};{g};{b};48;2;{r2};{g2};{b2}m");
                colors = Some(*cell);
            }
            out.push('▀');
            cursor = Some(index + 1);
        }
        if !out.is_empty() {
            out.push_str("\x1b[0m");
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const COLUMNS: usize = 7;
    const ROWS: usize = 4;

    /// A minimal terminal that interprets the codes of [`Cells::draw_over`].
    fn interpret(sent: &str, shown: &mut [[[u8; 3]; 2]]) {
        let (mut index, mut colors) = (0, [[0; 3]; 2]);
        let mut rest = sent;
        while !rest.is_empty() {
            if let Some(after) = rest.strip_prefix('▀') {
                shown[index] = colors;
                (index, rest) = (index + 1, after);
                continue;
            }
            let code = rest.strip_prefix("\x1b[").expect("a code");
            let end = code
                .find(|c: char| c.is_ascii_alphabetic())
                .expect("a code ends with a letter");
            let numbers: Vec<usize> = code[..end]
                .split(';')
                .map(|number| number.parse().expect("it is a number"))
                .collect();
            match (&code[end..=end], &numbers[..]) {
                ("H", [row, column]) => index = (row - 1) * COLUMNS + column - 1,
                ("m", [38, 2, r, g, b, 48, 2, r2, g2, b2]) => {
                    colors = [[*r as u8, *g as u8, *b as u8], [*r2 as u8, *g2 as u8, *b2 as u8]];
                }
                ("m", [0]) => {}
                other => panic!("{other:?}"),
            }
            rest = &code[end + 1..];
        }
    }

    fn picture() -> impl Strategy<Value = Picture> {
        (1u32..=COLUMNS as u32, 1u32..=2 * ROWS as u32).prop_flat_map(|(width, height)| {
            let bytes = prop::collection::vec(prop::sample::select(vec![0u8, 9, 200]), (3 * width * height) as usize);
            bytes.prop_map(move |rgb| Picture { width, height, rgb })
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// The terminal shows the new picture, whatever it showed before. If nothing changed, nothing is sent.
        #[test]
        fn terminal_shows_the_last_picture(pictures in prop::collection::vec(picture(), 1..4)) {
            let mut terminal = vec![[[1; 3]; 2]; COLUMNS * ROWS];
            let mut before: Option<Cells> = None;
            for picture in pictures {
                let cells = Cells::new(&picture, COLUMNS, ROWS);
                interpret(&cells.draw_over(before.as_ref()), &mut terminal);
                prop_assert_eq!(&terminal, &cells.cells);
                prop_assert_eq!(cells.draw_over(Some(&cells)), "");
                let lit = cells.cells.iter().flatten().filter(|pixel| **pixel != [0; 3]).count();
                let expected = picture.rgb.chunks_exact(3).filter(|pixel| *pixel != [0; 3]).count();
                prop_assert_eq!(lit, expected, "the whole picture is drawn");
                before = Some(cells);
            }
        }
    }
}
