//! Distance matrices as CSV: a line of labels behind an empty cell, then a line for each item, its label first. Files are the
//! callers'.

use driftworld_text::{Cells, unguarded};
use ndarray::Array2;

use super::DistanceMatrix;
use crate::SimilarityError;

impl DistanceMatrix {
    /// The matrix as CSV (RFC 4180 with bare line feeds). Every number reads back as the same one. Labels that a spreadsheet would take for
    /// formulas are guarded by an apostrophe, which is taken away when they are read.
    pub fn to_csv(&self) -> String {
        self.to_csv_with(Cells::Guarded)
    }

    /// As [`DistanceMatrix::to_csv`], with labels guarded or as they are.
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

    /// Reads what [`DistanceMatrix::to_csv`] writes. CSV does not say what the measure was: the nature is the default.
    ///
    /// # Errors
    /// [`SimilarityError::BadMatrix`] where the text is no such table; whatever [`DistanceMatrix::from_values`] says.
    ///
    /// # Example
    /// ```
    /// use driftworld_similarity::DistanceMatrix;
    /// let matrix = DistanceMatrix::from_csv(",a,b\na,0,2.5\nb,2.5,0\n")?;
    /// assert_eq!(matrix.get(0, 1), 2.5);
    /// # Ok::<(), driftworld_similarity::SimilarityError>(())
    /// ```
    pub fn from_csv(text: &str) -> Result<Self, SimilarityError> {
        let rows = cells(text)?;
        let Some((heading, rows)) = rows.split_first() else {
            return Err(bad(1, "no lines", "a line of labels behind an empty cell"));
        };
        if heading.cells.len() < 2 || !heading.cells[0].is_empty() {
            let found = format!("{:?} in the first cell of {}", heading.cells[0], heading.cells.len());
            return Err(bad(heading.line, found, "a line of labels behind an empty cell"));
        }
        let labels: Vec<String> = heading.cells[1..]
            .iter()
            .map(|label| unguarded(label).to_owned())
            .collect();
        let n = Self::bounded(labels.len())?;
        if rows.len() != n {
            let line = rows.last().map_or(heading.line, |row| row.line);
            let found = format!("{} lines below the labels", rows.len());
            return Err(bad(line, found, format!("{n}, one for each label")));
        }
        let mut values = Array2::zeros((n, n));
        for (a, row) in rows.iter().enumerate() {
            if row.cells.len() != n + 1 {
                let found = format!("{} cells", row.cells.len());
                return Err(bad(row.line, found, format!("{}: a label and {n} numbers", n + 1)));
            }
            if unguarded(&row.cells[0]) != labels[a] {
                let expected = format!("{:?}, as in the first line", labels[a]);
                return Err(bad(row.line, format!("the label {:?}", row.cells[0]), expected));
            }
            for (b, cell) in row.cells[1..].iter().enumerate() {
                let number = cell.trim().parse::<f64>();
                values[[a, b]] = number.map_err(|_| bad(row.line, format!("{cell:?}"), "a number"))?;
            }
        }
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

/// A line of a table, and where it begins, from 1.
struct Row {
    line: usize,
    cells: Vec<String>,
}

/// The cells of every line; a cell in quotes may hold commas and line ends, and a doubled quote is one.
fn cells(text: &str) -> Result<Vec<Row>, SimilarityError> {
    let mut rows: Vec<Row> = Vec::new();
    let (mut cells, mut cell) = (Vec::new(), String::new());
    let (mut quoted, mut line, mut begun) = (false, 1, 1);
    let mut letters = text.strip_prefix('\u{feff}').unwrap_or(text).chars().peekable();
    while let Some(letter) = letters.next() {
        line += usize::from(letter == '\n');
        match letter {
            '"' if quoted && letters.next_if_eq(&'"').is_some() => cell.push('"'),
            '"' if quoted || cell.is_empty() => quoted = !quoted,
            ',' if !quoted => cells.push(std::mem::take(&mut cell)),
            '\r' if !quoted && letters.peek() == Some(&'\n') => {}
            '\n' if !quoted => {
                cells.push(std::mem::take(&mut cell));
                rows.push(Row {
                    line: begun,
                    cells: std::mem::take(&mut cells),
                });
                begun = line;
            }
            other => cell.push(other),
        }
    }
    if quoted {
        return Err(bad(begun, "quotes that do not end", "a second quote"));
    }
    if !cell.is_empty() || !cells.is_empty() {
        cells.push(cell);
        rows.push(Row { line: begun, cells });
    }
    // Empty lines, as some editors leave at the end, say nothing.
    rows.retain(|row| row.cells.len() > 1 || !row.cells[0].is_empty());
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn check_error(text: &str, expected: &str) {
        assert_eq!(
            DistanceMatrix::from_csv(text).unwrap_err().to_string(),
            expected,
            "{text:?}"
        );
    }

    #[test]
    fn csv_quotes_what_needs_it() {
        let names = vec!["a,b".to_owned(), "say \"x\"".to_owned()];
        let matrix = DistanceMatrix::measure(names, |_, _| Ok::<_, SimilarityError>(0.5)).unwrap();
        assert_eq!(
            matrix.to_csv(),
            ",\"a,b\",\"say \"\"x\"\"\"\n\"a,b\",0,0.5\n\"say \"\"x\"\"\",0.5,0\n"
        );
    }

    proptest! {
        #[test]
        fn what_is_written_reads_back_the_same(
            labels in prop::collection::btree_set("['=+@-]{0,2}[a-z1,\"\n\r\t #é]{1,5}", 1..6),
            numbers in prop::collection::vec(0.0..1e9_f64, 15),
        ) {
            let measure = |a: usize, b: usize| Ok::<_, SimilarityError>(numbers[(a * 5 + b) % 15]);
            let matrix = DistanceMatrix::measure(labels.into_iter().collect(), measure).unwrap();
            prop_assert_eq!(&DistanceMatrix::from_csv(&matrix.to_csv()).unwrap(), &matrix);
            // What is written raw reads back the same, too, but for labels that look guarded.
            if matrix.labels().iter().all(|label| !label.starts_with('\'')) {
                prop_assert_eq!(DistanceMatrix::from_csv(&matrix.to_csv_with(Cells::Raw)).unwrap(), matrix);
            }
        }
    }

    #[test]
    fn labels_that_are_formulas_are_guarded() {
        let names = vec!["=1+2".to_owned(), "-3".to_owned()];
        let matrix = DistanceMatrix::measure(names, |_, _| Ok::<_, SimilarityError>(0.5)).unwrap();
        assert_eq!(matrix.to_csv(), ",'=1+2,-3\n'=1+2,0,0.5\n-3,0.5,0\n");
        assert_eq!(matrix.to_csv_with(Cells::Raw), ",=1+2,-3\n=1+2,0,0.5\n-3,0.5,0\n");
    }

    #[test]
    fn other_programs_line_ends_and_marks_are_understood() {
        let matrix = DistanceMatrix::from_csv("\u{feff},a,b\r\na,0, 1e-1\r\nb,0.1,0\r\n\r\n").unwrap();
        assert_eq!((matrix.labels().join(" "), matrix.get(1, 0)), ("a b".to_owned(), 0.1));
    }

    #[test]
    fn what_is_no_table_says_where() {
        check_error(
            "",
            "matrix, line 1: found no lines, expected a line of labels behind an empty cell",
        );
        check_error(
            ",a,b\na,0,1\n",
            "matrix, line 2: found 1 lines below the labels, expected 2, one for each label",
        );
        check_error(
            ",a,b\na,0\nb,1,0\n",
            "matrix, line 2: found 2 cells, expected 3: a label and 2 numbers",
        );
        check_error(
            ",a,b\na,0,1\nc,1,0\n",
            "matrix, line 3: found the label \"c\", expected \"b\", as in the first line",
        );
        check_error(
            ",a,b\na,0,far\nb,1,0\n",
            "matrix, line 2: found \"far\", expected a number",
        );
        check_error(
            ",\"a\n",
            "matrix, line 1: found quotes that do not end, expected a second quote",
        );
    }
}
