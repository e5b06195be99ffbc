//! Finds the end of the whole rows in a data file whose writer may have been stopped at any byte.
//!
//! A line break in quotes belongs to its cell, so a file may end with one and still be torn. Quotes are interpreted as by the
//! crate `csv`: they open a cell only at its very beginning.

use std::io::{self, BufRead};
use std::path::Path;

use crate::{LogLine, MetricsError};

/// Minimum number of tabs in a line that looks like a row: every row of any version has at least as many.
const TABS_OF_A_ROW: usize = 8;

/// The whole rows at the start of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct WholeRows {
    /// Bytes up to and including the last whole row.
    pub(super) bytes: u64,
    /// Number of lines in them.
    pub(super) lines: u64,
    /// Whether lines that look like rows follow: then the remainder is not a torn row, but a quote was never closed and
    /// swallowed the rows after it.
    pub(super) swallowed: bool,
    /// Whether lines that end with a lone carriage return follow: then the remainder is not a torn row either.
    pub(super) returns: bool,
}

impl WholeRows {
    /// The fault to report for the remainder; what was read starts at line `first_line` of its file.
    pub(super) fn fault(self, path: &Path, first_line: u64) -> MetricsError {
        let (path, line) = (path.to_owned(), first_line + self.lines);
        let wrong = match self {
            Self { swallowed: true, .. } => MetricsError::OpenQuote,
            Self { returns: true, .. } => MetricsError::CarriageReturns,
            _ => MetricsError::TornLastLine,
        };
        wrong(LogLine { path, line })
    }
}

#[derive(Clone, Copy, Default, PartialEq)]
enum Place {
    #[default]
    CellStart,
    Cell,
    Quotes,
    /// After a quote within quotes: it ends the cell, or is the first of two that encode one.
    QuoteInQuotes,
}

/// Reads to the end.
pub(super) fn measure(mut file: impl BufRead) -> io::Result<WholeRows> {
    let mut found = WholeRows::default();
    let mut scan = Scan::default();
    loop {
        let bytes = file.fill_buf()?;
        if bytes.is_empty() {
            return Ok(found);
        }
        for &byte in bytes {
            scan.take(byte, &mut found);
        }
        let num = bytes.len();
        file.consume(num);
    }
}

#[derive(Default)]
struct Scan {
    place: Place,
    bytes: u64,
    lines: u64,
    /// Tabs since the start of the line.
    tabs: usize,
    /// Whether a line of this row has ended within quotes.
    broken: bool,
    /// Whether the last byte was a carriage return outside quotes.
    returned: bool,
}

impl Scan {
    fn take(&mut self, byte: u8, found: &mut WholeRows) {
        self.bytes += 1;
        self.place = match (self.place, byte) {
            (Place::Quotes, b'"') => Place::QuoteInQuotes,
            (Place::Quotes, _) | (Place::CellStart | Place::QuoteInQuotes, b'"') => Place::Quotes,
            (_, b'\t' | b'\n' | b'\r') => Place::CellStart,
            _ => Place::Cell,
        };
        found.returns |= self.returned && byte != b'\n';
        self.returned = byte == b'\r' && self.place == Place::CellStart;
        match byte {
            b'\t' => self.tabs += 1,
            b'\n' => {
                self.lines += 1;
                if self.place == Place::Quotes {
                    found.swallowed |= self.broken && self.tabs >= TABS_OF_A_ROW;
                    self.broken = true;
                } else {
                    (found.bytes, found.lines) = (self.bytes, self.lines);
                    (found.swallowed, found.returns) = (false, false);
                    self.broken = false;
                }
                self.tabs = 0;
            }
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_end_with_a_line_break_outside_quotes() {
        let check = |text: &str, bytes: u64, lines: u64| {
            let found = measure(text.as_bytes()).unwrap();
            assert_eq!(
                (found.bytes, found.lines, found.swallowed),
                (bytes, lines, false),
                "{text:?}"
            );
        };
        check("", 0, 0);
        check("a\tb", 0, 0);
        check("a\tb\n", 4, 1);
        check("a\tb\nc", 4, 1);
        check("a\t\"b\n", 0, 0);
        check("a\t\"b\n\"\nc", 7, 2);
        check("a\t\"b\"\"\n\"\n", 9, 2);
        check("a\t\"b\"\"\n\"", 0, 0);
        // A quote within a cell is an ordinary character.
        check("a\tb\"\nc", 5, 1);
        check("a\r\n\"b\r\n", 3, 1);
    }

    #[test]
    fn quote_that_swallows_rows_is_not_a_torn_row() {
        let row = "0\t1\t2\t3\t4\t5\t6\t7\t8\n";
        let check = |text: &str, swallowed: bool| {
            assert_eq!(measure(text.as_bytes()).unwrap().swallowed, swallowed, "{text:?}");
        };
        check(&format!("{row}0\t\"1\n{row}"), true);
        check(&format!("{row}0\t\"1\n{row}\"\n"), false);
        // Neither the line with the quote nor one without an end counts.
        check("0\t1\t2\t3\t4\t5\t6\t7\t\"8\n0\t1", false);
    }

    #[test]
    fn carriage_return_line_endings_are_not_a_torn_row() {
        let check = |text: &str, returns: bool| {
            assert_eq!(measure(text.as_bytes()).unwrap().returns, returns, "{text:?}");
        };
        check("a\tb\r0\t1\r", true);
        check("a\tb\r\n0\t1\r2\t3", true);
        // The line feed was cut off, or will be read next.
        check("a\tb\r", false);
        check("a\tb\r\n0\t1\r\n", false);
        check("a\t\"b\r0\"", false);
        check("a\tb\r0\n", false);
    }
}
