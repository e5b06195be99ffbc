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
    /// A picture centred on black, in this number of columns and rows.
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
            let place = 3 * (y * width + x);
            [picture.rgb[place], picture.rgb[place + 1], picture.rgb[place + 2]]
        };
        let cell = |place: usize| {
            let (x, y) = (place % columns, place / columns);
            [pixel(x, 2 * y), pixel(x, 2 * y + 1)]
        };
        Self {
            columns,
            cells: (0..columns * rows).map(cell).collect(),
        }
    }

    /// The codes that make a terminal that shows `before` show this picture, from the terminal's first row on; the whole picture
    /// if `before` is missing or has a different size.
    pub(super) fn drawn_over(&self, before: Option<&Self>) -> String {
        let before = before.filter(|before| (before.columns, before.cells.len()) == (self.columns, self.cells.len()));
        let mut out = String::new();
        // Tracks the cursor's position and the current colours.
        let (mut cursor, mut colors) = (None, None);
        for (place, cell) in self.cells.iter().enumerate() {
            if before.is_some_and(|before| before.cells[place] == *cell) {
                continue;
            }
            let (row, column) = (place / self.columns, place % self.columns);
            // Writing into a string cannot fail.
            if cursor != Some(place) || column == 0 {
                let _ = write!(out, "\x1b[{};{}H", row + 1, column + 1);
            }
            if colors != Some(*cell) {
                let [[r, g, b], [r2, g2, b2]] = cell;
                let _ = write!(out, "\x1b[38;2;{r};{g};{b};48;2;{r2};{g2};{b2}m");
                colors = Some(*cell);
            }
            out.push('▀');
            cursor = Some(place + 1);
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

    /// A minimal terminal that interprets the codes sent here.
    fn shown(sent: &str, shown: &mut [[[u8; 3]; 2]]) {
        let (mut place, mut colors) = (0, [[0; 3]; 2]);
        let mut rest = sent;
        while !rest.is_empty() {
            if let Some(after) = rest.strip_prefix('▀') {
                shown[place] = colors;
                (place, rest) = (place + 1, after);
                continue;
            }
            let code = rest.strip_prefix("\x1b[").expect("a code");
            let end = code
                .find(|letter: char| letter.is_ascii_alphabetic())
                .expect("a code ends with a letter");
            let numbers: Vec<usize> = code[..end]
                .split(';')
                .map(|number| number.parse().expect("a number"))
                .collect();
            match (&code[end..=end], &numbers[..]) {
                ("H", [row, column]) => place = (row - 1) * COLUMNS + column - 1,
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

        /// Whatever was shown before, the terminal then shows the picture; and nothing is sent if nothing changed.
        #[test]
        fn terminal_shows_the_last_picture(pictures in prop::collection::vec(picture(), 1..4)) {
            let mut terminal = vec![[[1; 3]; 2]; COLUMNS * ROWS];
            let mut before: Option<Cells> = None;
            for picture in pictures {
                let cells = Cells::new(&picture, COLUMNS, ROWS);
                shown(&cells.drawn_over(before.as_ref()), &mut terminal);
                prop_assert_eq!(&terminal, &cells.cells);
                prop_assert_eq!(cells.drawn_over(Some(&cells)), "");
                let lit = cells.cells.iter().flatten().filter(|pixel| **pixel != [0; 3]).count();
                let expected = picture.rgb.chunks_exact(3).filter(|pixel| *pixel != [0; 3]).count();
                prop_assert_eq!(lit, expected, "the whole picture is there");
                before = Some(cells);
            }
        }
    }
}
