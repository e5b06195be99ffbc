//! Reads the rows of one `data-log.tsv` and reports their faults.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use csv::{ErrorKind, StringRecord};
use driftworld_files::Opened;

use super::faults::Faults;
use super::header::Header;
use super::regular_file;
use super::table::Table;
use super::whole_rows::{self, WholeRows};
use crate::{LogLine, MetricsError};

/// Maximum size of a data file, in bytes.
pub const MAX_FILE_BYTES: u64 = 1 << 30;

/// Maximum size of a cell, in bytes.
pub const MAX_CELL_BYTES: usize = 1 << 20;

/// Bytes per read.
const BUFFER_BYTES: usize = 1 << 16;

/// Adds every row to the table in file order; returns the header.
///
/// Adds faults of single rows to `faults`; a fault that makes the file unreadable is returned as the error.
pub(super) fn read<'a>(
    path: &'a Path,
    metrics_columns: &[String],
    table: &mut Table<'a>,
    faults: &mut Faults,
) -> Result<Vec<String>, MetricsError> {
    table.begin_file(path);
    let source = Source::open(path)?;
    let mut rows = csv::ReaderBuilder::new()
        .delimiter(b'\t')
        .has_headers(false)
        .flexible(true)
        .buffer_capacity(BUFFER_BYTES)
        // Stops at this length: rows that a running writer adds in the meantime are not read.
        .from_reader((&source.file).take(source.whole));
    let mut row = StringRecord::new();
    if !next_row(&mut rows, &mut row, path)? {
        return Err(source.torn.unwrap_or_else(|| MetricsError::EmptyFile(path.to_owned())));
    }
    let is_last = |rows: &csv::Reader<_>| rows.position().byte() >= source.whole;
    if is_last(&rows)
        && let Some(fault) = source.open_quote(path, 0, 1)?
    {
        return Err(fault);
    }
    let header = Header::new(path, &row, metrics_columns, table, faults)?;
    // If lines end with two characters, the reader has not yet consumed the second.
    let line_ends = (rows.position().line() - line_breaks(&row) - 1).min(1);
    loop {
        match next_row(&mut rows, &mut row, path) {
            Ok(true) => {}
            Ok(false) => break,
            Err(fault @ MetricsError::NotUtf8(_)) => {
                faults.add(fault)?;
                continue;
            }
            Err(error) => return Err(error),
        }
        // Blank lines before a row are skipped, so its line is computed from its end.
        let line = rows.position().line() - line_breaks(&row) - line_ends;
        let start = row.position().map_or(0, csv::Position::byte);
        if is_last(&rows)
            // A row that ends within quotes has no line ending of its own.
            && let Some(fault) = source.open_quote(path, start, line + line_ends)?
        {
            faults.add(fault)?;
            return Ok(header.names);
        }
        header.add(&row, line, table, faults)?;
    }
    if let Some(fault) = source.torn {
        faults.add(fault)?;
    }
    Ok(header.names)
}

/// Number of line breaks within the cells of a row.
fn line_breaks(row: &StringRecord) -> u64 {
    row.as_slice().bytes().filter(|byte| *byte == b'\n').count() as u64
}

fn next_row(rows: &mut csv::Reader<impl Read>, row: &mut StringRecord, path: &Path) -> Result<bool, MetricsError> {
    rows.read_record(row).map_err(|error| row_error(path, error))
}

fn row_error(path: &Path, error: csv::Error) -> MetricsError {
    let line = error.position().map_or(0, csv::Position::line);
    match error.into_kind() {
        ErrorKind::Utf8 { .. } => MetricsError::NotUtf8(LogLine {
            path: path.to_owned(),
            line,
        }),
        ErrorKind::Io(source) => MetricsError::io(path, "read this file")(source),
        other => MetricsError::io(path, "read this file")(std::io::Error::other(format!("{other:?}"))),
    }
}

/// An open data file, with the length to read.
struct Source {
    file: File,
    /// Bytes up to the end of the last whole row.
    whole: u64,
    /// The fault to report for the bytes after the last whole row, if there are any.
    torn: Option<MetricsError>,
}

impl Source {
    /// Opens a data file after checking its size.
    fn open(path: &Path) -> Result<Self, MetricsError> {
        let failed = || MetricsError::io(path, "read this file");
        let Opened { mut file, length } = regular_file::open(path, MAX_FILE_BYTES)?;
        let (mut whole, mut torn) = (length, None);
        if length > 0 && last_byte(&mut file).map_err(failed())? != b'\n' {
            file.rewind().map_err(failed())?;
            let buffered = BufReader::with_capacity(BUFFER_BYTES, (&file).take(length));
            let found = whole_rows::measure(buffered).map_err(failed())?;
            whole = found.bytes;
            torn = Some(found.fault(path, 1));
        }
        file.rewind().map_err(failed())?;
        Ok(Self { file, whole, torn })
    }

    /// The fault of the last row, which starts at this byte, if it ends within quotes: it is torn, or a quote was never closed.
    fn open_quote(&self, path: &Path, start: u64, line: u64) -> Result<Option<MetricsError>, MetricsError> {
        let failed = || MetricsError::io(path, "read this file");
        let mut file = &self.file;
        file.seek(SeekFrom::Start(start)).map_err(failed())?;
        let buffered = BufReader::with_capacity(BUFFER_BYTES, file.take(self.whole - start));
        let found = whole_rows::measure(buffered).map_err(failed())?;
        // Only blank lines precede the open row.
        let found_here = WholeRows { lines: 0, ..found };
        Ok((found.bytes < self.whole - start).then(|| found_here.fault(path, line)))
    }
}

fn last_byte(file: &mut File) -> std::io::Result<u8> {
    let mut byte = [0];
    file.seek(SeekFrom::End(-1))?;
    file.read_exact(&mut byte)?;
    Ok(byte[0])
}
