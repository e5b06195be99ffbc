//! Where the whole rows of a data file end, when its writer may have been stopped at any byte.
//!
//! A line break in quotes belongs to its cell, so that a file may end with one and still be torn. Quotes are read as the crate
//! `csv` reads them: they open a cell only at its very beginning.
//!
//! Not here: what the rows hold, see `data_file`.

use std::io::{self, BufRead};
use std::path::Path;

use crate::{LogLine, MetricsError};

/// Tabs of a line that looks like a row: the fewest that a row of any version has.
const TABS_OF_A_ROW: usize = 8;

/// The part of a file that consists of whole rows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct WholeRows {
    /// Bytes up to and with the end of the last whole row.
    pub(super) bytes: u64,
    /// Lines in them.
    pub(super) lines: u64,
    /// Whether what follows holds lines that look like rows: then it is no torn row, but one in which a quote was opened and
    /// never closed, so that it swallowed the rows after it.
    pub(super) swallowed: bool,
    /// Whether what follows holds lines that end with a carriage return alone, which is no torn row either.
    pub(super) returns: bool,
}

impl WholeRows {
    /// What is wrong with what follows; the piece that was looked at begins at this line of its file.
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
    /// After a quote within quotes: the end of the cell, or the first of two that stand for one.
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
    /// Tabs since the line began.
    tabs: usize,
    /// Whether a line of this row ended within quotes already.
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
        // A quote within a cell is a letter like others.
        check("a\tb\"\nc", 5, 1);
        check("a\r\n\"b\r\n", 3, 1);
    }

    #[test]
    fn a_quote_that_swallows_rows_is_told_from_a_torn_row() {
        let row = "0\t1\t2\t3\t4\t5\t6\t7\t8\n";
        let check = |text: &str, swallowed: bool| {
            assert_eq!(measure(text.as_bytes()).unwrap().swallowed, swallowed, "{text:?}");
        };
        check(&format!("{row}0\t\"1\n{row}"), true);
        check(&format!("{row}0\t\"1\n{row}\"\n"), false);
        // The line in which the quote stands does not count, nor does one without an end.
        check("0\t1\t2\t3\t4\t5\t6\t7\t\"8\n0\t1", false);
    }

    #[test]
    fn carriage_returns_as_line_ends_are_told_from_a_torn_row() {
        let check = |text: &str, returns: bool| {
            assert_eq!(measure(text.as_bytes()).unwrap().returns, returns, "{text:?}");
        };
        check("a\tb\r0\t1\r", true);
        check("a\tb\r\n0\t1\r2\t3", true);
        // The line feed was cut off, or will be read with the rest.
        check("a\tb\r", false);
        check("a\tb\r\n0\t1\r\n", false);
        check("a\t\"b\r0\"", false);
        check("a\tb\r0\n", false);
    }
}
