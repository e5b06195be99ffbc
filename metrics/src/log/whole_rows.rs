//! Finds the end of the whole rows in a data file whose writer may have been stopped at any byte.
//!
//! A line break in quotes belongs to its cell, so a file may end with one and still be torn. Quotes are interpreted as by the
//! crate `csv`: they open a cell only at its very beginning.

use std::io::{self, BufRead};
use std::path::Path;

use crate::{LogLine, MetricsError};

/// Minimum number of tabs in a line that looks like a row: no row has fewer.
const MIN_ROW_TABS: usize = 8;

/// The whole rows at the start of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct WholeRows {
    /// Bytes up to and including the last whole row.
    pub(super) bytes: u64,
    /// Number of lines in them.
    pub(super) lines: u64,
    /// Whether the remainder contains lines that look like rows: then it is not a torn row, but a quote was never closed and
    /// swallowed the rows after it.
    pub(super) rows_swallowed: bool,
    /// Whether the remainder contains lines that end with a lone carriage return: then it is not a torn row either.
    pub(super) lone_returns: bool,
}

impl WholeRows {
    /// The fault to report for the remainder; `first_line` is the line of the file at which reading started.
    pub(super) fn fault(self, path: &Path, first_line: u64) -> MetricsError {
        let (path, line) = (path.to_owned(), first_line + self.lines);
        let variant = match self {
            Self {
                rows_swallowed: true, ..
            } => MetricsError::OpenQuote,
            Self { lone_returns: true, .. } => MetricsError::CarriageReturns,
            _ => MetricsError::TornLastLine,
        };
        variant(LogLine { path, line })
    }
}

#[derive(Clone, Copy, Default, PartialEq)]
enum State {
    #[default]
    CellStart,
    Cell,
    Quotes,
    /// After a quote within quotes, which ends the cell, or is the first of two that encode one.
    QuoteInQuotes,
}

/// Reads a file to its end, and finds its whole rows.
pub(super) fn measure(mut file: impl BufRead) -> io::Result<WholeRows> {
    let mut found = WholeRows::default();
    let mut scan = Scan::default();
    loop {
        let bytes = file.fill_buf()?;
        if bytes.is_empty() {
            return Ok(found);
        }
        for &byte in bytes {
            scan.next_byte(byte, &mut found);
        }
        let num = bytes.len();
        file.consume(num);
    }
}

#[derive(Default)]
struct Scan {
    state: State,
    bytes: u64,
    lines: u64,
    /// Tabs since the start of the line.
    tabs: usize,
    /// Whether a line of this row has ended within quotes.
    has_open_line: bool,
    /// Whether the last byte was a carriage return outside quotes.
    after_return: bool,
}

impl Scan {
    fn next_byte(&mut self, byte: u8, found: &mut WholeRows) {
        self.bytes += 1;
        self.state = match (self.state, byte) {
            (State::Quotes, b'"') => State::QuoteInQuotes,
            (State::Quotes, _) | (State::CellStart | State::QuoteInQuotes, b'"') => State::Quotes,
            (_, b'\t' | b'\n' | b'\r') => State::CellStart,
            _ => State::Cell,
        };
        found.lone_returns |= self.after_return && byte != b'\n';
        self.after_return = byte == b'\r' && self.state == State::CellStart;
        match byte {
            b'\t' => self.tabs += 1,
            b'\n' => {
                self.lines += 1;
                if self.state == State::Quotes {
                    found.rows_swallowed |= self.has_open_line && self.tabs >= MIN_ROW_TABS;
                    self.has_open_line = true;
                } else {
                    (found.bytes, found.lines) = (self.bytes, self.lines);
                    (found.rows_swallowed, found.lone_returns) = (false, false);
                    self.has_open_line = false;
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
                (found.bytes, found.lines, found.rows_swallowed),
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
        let check = |text: &str, rows_swallowed: bool| {
            assert_eq!(
                measure(text.as_bytes()).unwrap().rows_swallowed,
                rows_swallowed,
                "{text:?}"
            );
        };
        check(&format!("{row}0\t\"1\n{row}"), true);
        check(&format!("{row}0\t\"1\n{row}\"\n"), false);
        // Neither the line with the quote nor a line without an ending counts.
        check("0\t1\t2\t3\t4\t5\t6\t7\t\"8\n0\t1", false);
    }

    #[test]
    fn carriage_return_line_endings_are_not_a_torn_row() {
        let check = |text: &str, lone_returns: bool| {
            assert_eq!(measure(text.as_bytes()).unwrap().lone_returns, lone_returns, "{text:?}");
        };
        check("a\tb\r0\t1\r", true);
        check("a\tb\r\n0\t1\r2\t3", true);
        // The line feed may have been cut off, or will be read next.
        check("a\tb\r", false);
        check("a\tb\r\n0\t1\r\n", false);
        check("a\t\"b\r0\"", false);
        check("a\tb\r0\n", false);
    }
}
