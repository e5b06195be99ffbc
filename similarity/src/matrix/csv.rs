//! Distance matrices as CSV: a line of labels after an empty cell, then a line for each item, its label first.

use std::iter::Peekable;
use std::str::Chars;

use driftworld_text::{Cells, unguarded};
use ndarray::Array2;

use super::{DistanceMatrix, MAX_ITEMS};
use crate::SimilarityError;

impl DistanceMatrix {
    /// The matrix as CSV (RFC 4180 with bare line feeds). Every number reads back exactly. Labels that a spreadsheet would take
    /// for formulas are escaped with an apostrophe, which reading removes.
    pub fn to_csv(&self) -> String {
        self.to_csv_with(Cells::Guarded)
    }

    /// Like [`DistanceMatrix::to_csv`], with labels escaped or raw.
    pub fn to_csv_with(&self, cells: Cells) -> String {
        let cell = |text: &str| {
            let text = cells.cell(text);
            if text.contains([',', '"', '\n', '\r']) {
                format!("\"{}\"", text.replace('"', "\"\""))
            } else {
                text.into_owned()
            }
        };
        let names: Vec<String> = self.labels().iter().map(|label| cell(label)).collect();
        let mut text = format!(",{}\n", names.join(","));
        for (name, row) in names.iter().zip(self.values().rows()) {
            let numbers: Vec<String> = row.iter().map(f64::to_string).collect();
            text.extend([name, ",", &numbers.join(","), "\n"]);
        }
        text
    }

    /// Reads the output of [`DistanceMatrix::to_csv`]. CSV does not record the measure's metric properties, so the default
    /// applies.
    ///
    /// # Errors
    /// [`SimilarityError::BadMatrix`] if the text is not such a table; otherwise as [`DistanceMatrix::from_values`].
    ///
    /// # Example
    /// ```
    /// use driftworld_similarity::DistanceMatrix;
    /// let matrix = DistanceMatrix::from_csv(",a,b\na,0,2.5\nb,2.5,0\n")?;
    /// assert_eq!(matrix.get(0, 1), 2.5);
    /// # Ok::<(), driftworld_similarity::SimilarityError>(())
    /// ```
    pub fn from_csv(text: &str) -> Result<Self, SimilarityError> {
        let mut rows = Rows::of(text);
        let Some(heading) = rows.next().transpose()? else {
            return Err(bad(1, "no lines", "a line of labels after an empty cell"));
        };
        if heading.cells.len() < 2 || !heading.cells[0].is_empty() {
            let found = format!("{:?} in the first of {} cells", heading.cells[0], heading.cells.len());
            return Err(bad(heading.line, found, "an empty cell followed by labels"));
        }
        let labels: Vec<String> = heading.cells[1..]
            .iter()
            .map(|label| unguarded(label).to_owned())
            .collect();
        let n = Self::bounded(labels.len())?;
        // Parses line by line: the numbers take less memory than the text of their cells.
        let mut values: Vec<f64> = Vec::new();
        let (mut read, mut last) = (0, heading.line);
        for row in rows {
            let row = row?;
            last = row.line;
            read += 1;
            let Some(label) = labels.get(read - 1) else { continue };
            if row.cells.len() != n + 1 {
                let found = format!("{} cells", row.cells.len());
                return Err(bad(row.line, found, format!("{}: a label and {n} numbers", n + 1)));
            }
            if unguarded(&row.cells[0]) != label {
                let expected = format!("{label:?}, as in the first line");
                return Err(bad(row.line, format!("the label {:?}", row.cells[0]), expected));
            }
            for cell in &row.cells[1..] {
                let number = cell.trim().parse::<f64>();
                values.push(number.map_err(|_| bad(row.line, format!("{cell:?}"), "a number"))?);
            }
        }
        // An empty matrix is written as a line of two empty cells.
        if read == 0 && labels == [""] {
            return Self::from_values(Vec::new(), Array2::zeros((0, 0)));
        }
        if read != n {
            let found = format!("{read} lines below the labels");
            return Err(bad(last, found, format!("{n}, one for each label")));
        }
        let values = Array2::from_shape_vec((n, n), values).expect("there are n rows of n numbers");
        Self::from_values(labels, values)
    }
}

fn bad(line: usize, found: impl Into<String>, expected: impl Into<String>) -> SimilarityError {
    SimilarityError::BadMatrix {
        place: format!("line {line}"),
        found: found.into(),
        expected: expected.into(),
    }
}

/// A line of a table, with its line number, from 1.
struct Row {
    line: usize,
    cells: Vec<String>,
}

/// Iterates over the lines of a table; a cell in quotes may hold commas and line breaks, and a doubled quote stands for one.
/// Empty lines, which some editors append, are skipped.
struct Rows<'t> {
    chars: Peekable<Chars<'t>>,
    line: usize,
}

impl<'t> Rows<'t> {
    fn of(text: &'t str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        Self {
            chars: text.chars().peekable(),
            line: 1,
        }
    }

    /// The next line, which may be empty.
    fn line(&mut self) -> Option<Result<Row, SimilarityError>> {
        self.chars.peek()?;
        let (mut cells, mut cell) = (Vec::new(), String::new());
        let (mut quoted, line) = (false, self.line);
        while let Some(c) = self.chars.next() {
            self.line += usize::from(c == '\n');
            match c {
                '"' if quoted && self.chars.next_if_eq(&'"').is_some() => cell.push('"'),
                '"' if quoted || cell.is_empty() => quoted = !quoted,
                ',' if !quoted => push_cell(&mut cells, &mut cell),
                '\r' if !quoted && self.chars.peek() == Some(&'\n') => {}
                '\n' if !quoted => break,
                other => cell.push(other),
            }
        }
        if quoted {
            return Some(Err(bad(line, "an unclosed quote", "a closing quote")));
        }
        push_cell(&mut cells, &mut cell);
        Some(Ok(Row { line, cells }))
    }
}

/// Adds a cell to its line, but at most one more than any matrix can have.
fn push_cell(cells: &mut Vec<String>, cell: &mut String) {
    let cell = std::mem::take(cell);
    if cells.len() < MAX_ITEMS + 2 {
        cells.push(cell);
    }
}

impl Iterator for Rows<'_> {
    type Item = Result<Row, SimilarityError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            match self.line()? {
                Ok(row) if row.cells.len() == 1 && row.cells[0].is_empty() => {}
                found => return Some(found),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn csv_quotes_labels_that_need_it() {
        let names = vec!["a,b".to_owned(), "say \"x\"".to_owned()];
        let matrix = DistanceMatrix::measure(names, |_, _| Ok::<_, SimilarityError>(0.5)).unwrap();
        assert_eq!(
            matrix.to_csv(),
            ",\"a,b\",\"say \"\"x\"\"\"\n\"a,b\",0,0.5\n\"say \"\"x\"\"\",0.5,0\n"
        );
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn csv_round_trips(
            labels in prop::collection::btree_set("['=+@-]{0,2}[a-z1,\"\n\r\t #é]{1,5}", 1..6),
            numbers in prop::collection::vec(0.0..1e9_f64, 15),
        ) {
            let measure = |a: usize, b: usize| Ok::<_, SimilarityError>(numbers[(a * 5 + b) % 15]);
            let matrix = DistanceMatrix::measure(labels.into_iter().collect(), measure).unwrap();
            prop_assert_eq!(&DistanceMatrix::from_csv(&matrix.to_csv()).unwrap(), &matrix);
            // Raw output also round-trips, except for labels that look escaped.
            if matrix.labels().iter().all(|label| !label.starts_with('\'')) {
                prop_assert_eq!(DistanceMatrix::from_csv(&matrix.to_csv_with(Cells::Raw)).unwrap(), matrix);
            }
        }
    }

    #[test]
    fn formula_labels_are_escaped() {
        let names = vec!["=1+2".to_owned(), "-3".to_owned()];
        let matrix = DistanceMatrix::measure(names, |_, _| Ok::<_, SimilarityError>(0.5)).unwrap();
        assert_eq!(matrix.to_csv(), ",'=1+2,-3\n'=1+2,0,0.5\n-3,0.5,0\n");
        assert_eq!(matrix.to_csv_with(Cells::Raw), ",=1+2,-3\n=1+2,0,0.5\n-3,0.5,0\n");
    }

    #[test]
    fn foreign_line_endings_and_byte_order_marks_are_read() {
        let matrix = DistanceMatrix::from_csv("\u{feff},a,b\r\na,0, 1e-1\r\nb,0.1,0\r\n\r\n").unwrap();
        assert_eq!((matrix.labels().join(" "), matrix.get(1, 0)), ("a b".to_owned(), 0.1));
    }

    #[test]
    fn too_many_lines_or_cells_are_refused() {
        let message = |text: &str| DistanceMatrix::from_csv(text).unwrap_err().to_string();
        let few = message(&format!(",a\na,0\n{}", "a,0\n".repeat(70_000)));
        assert!(few.contains("found 70001 lines below the labels, expected 1"), "{few}");
        let wide = message(&",".repeat(1_000_000));
        assert!(wide.contains("20001"), "{wide}");
    }

    #[test]
    fn bad_csv_error_names_the_line() {
        for row in r#"
 => 1: found no lines, expected a line of labels after an empty cell
,a,b|a,0,1| => 2: found 1 lines below the labels, expected 2, one for each label
,a,b|a,0|b,1,0| => 2: found 2 cells, expected 3: a label and 2 numbers
,a,b|a,0,1|c,1,0| => 3: found the label "c", expected "b", as in the first line
,a,b|a,0,far|b,1,0| => 2: found "far", expected a number
,"a| => 1: found an unclosed quote, expected a closing quote"#
            .lines()
            .skip(1)
        {
            let (text, expected) = row.split_once(" => ").expect("a row has two parts");
            let error = DistanceMatrix::from_csv(&text.replace('|', "\n"))
                .unwrap_err()
                .to_string();
            assert_eq!(error, format!("matrix, line {expected}"), "{text:?}");
        }
    }
}
