//! Reads one `data-log.tsv`: its rows, and what is wrong with them.
//!
//! Not here: its header, see `header`; how the files of a log go together, see `reader`.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use csv::{ErrorKind, StringRecord};

use super::faults::Faults;
use super::header::Header;
use super::table::Table;
use super::whole_rows;
use crate::MetricsError;

/// Largest data file that is read, in bytes.
pub const MAX_FILE_BYTES: u64 = 1 << 30;

/// Largest cell, in bytes.
pub const MAX_CELL_BYTES: usize = 1 << 20;

/// Bytes asked of the system at a time.
const PIECE: usize = 1 << 16;

/// Adds every row to the table in the order of the file; returns the header.
///
/// Faults of rows go to `faults`; those after which the file makes no sense are the error.
pub(super) fn read(
    path: &Path,
    metrics_columns: &[String],
    table: &mut Table<'_>,
    faults: &mut Faults,
) -> Result<Vec<String>, MetricsError> {
    table.begin_file();
    let source = Source::open(path)?;
    let mut rows = csv::ReaderBuilder::new()
        .delimiter(b'\t')
        .has_headers(false)
        .flexible(true)
        .buffer_capacity(PIECE)
        // Rows that a running writer adds meanwhile are left for the next reading.
        .from_reader((&source.file).take(source.whole));
    let mut row = StringRecord::new();
    let mut next = |row: &mut StringRecord| match rows.read_record(row) {
        Ok(true) => Ok(Some(rows.position().byte() >= source.whole)),
        Ok(false) => Ok(None),
        Err(error) => Err(row_error(path, error)),
    };
    if next(&mut row)?.is_none() {
        return Err(source
            .torn
            .unwrap_or_else(|| MetricsError::EmptyFile { path: path.to_owned() }));
    }
    let mut header = Header::new(path, &row, metrics_columns, table, faults)?;
    loop {
        let is_last = match next(&mut row) {
            Ok(None) => break,
            Ok(Some(is_last)) => is_last,
            Err(error @ MetricsError::NotUtf8 { .. }) => {
                faults.add(error)?;
                continue;
            }
            Err(error) => return Err(error),
        };
        let (start, line) = row.position().map_or((0, 0), |place| (place.byte(), place.line()));
        if is_last && let Some(fault) = source.open_quote(path, start, line)? {
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

fn row_error(path: &Path, error: csv::Error) -> MetricsError {
    let line = error.position().map_or(0, csv::Position::line);
    match error.into_kind() {
        ErrorKind::Utf8 { .. } => MetricsError::NotUtf8 {
            path: path.to_owned(),
            line,
        },
        ErrorKind::Io(source) => MetricsError::io(path, "read this file")(source),
        other => MetricsError::io(path, "read this file")(std::io::Error::other(format!("{other:?}"))),
    }
}

/// An open data file, and how far it is to be read.
struct Source {
    file: File,
    /// Bytes up to the end of the last whole row.
    whole: u64,
    /// What is wrong with what follows.
    torn: Option<MetricsError>,
}

impl Source {
    /// Opens a data file after checking its size.
    fn open(path: &Path) -> Result<Self, MetricsError> {
        let failed = || MetricsError::io(path, "read this file");
        let mut file = File::open(path).map_err(MetricsError::io(path, "open this file"))?;
        let length = file
            .metadata()
            .map_err(MetricsError::io(path, "measure this file"))?
            .len();
        if length > MAX_FILE_BYTES {
            let limit = MAX_FILE_BYTES;
            return Err(MetricsError::TooLarge {
                path: path.to_owned(),
                what: "bytes",
                found: length,
                limit,
            });
        }
        let (mut whole, mut torn) = (length, None);
        if length > 0 && last_byte(&mut file).map_err(failed())? != b'\n' {
            file.rewind().map_err(failed())?;
            let all = BufReader::with_capacity(PIECE, (&file).take(length));
            let found = whole_rows::measure(all).map_err(failed())?;
            whole = found.bytes;
            torn = Some(found.fault(path, 1));
        }
        file.rewind().map_err(failed())?;
        Ok(Self { file, whole, torn })
    }

    /// The fault of the last row, which begins at this byte, if it ends within quotes: torn, or a quote was never closed.
    fn open_quote(&self, path: &Path, start: u64, line: u64) -> Result<Option<MetricsError>, MetricsError> {
        let failed = || MetricsError::io(path, "read this file");
        let mut file = &self.file;
        file.seek(SeekFrom::Start(start)).map_err(failed())?;
        let piece = BufReader::with_capacity(PIECE, file.take(self.whole - start));
        let found = whole_rows::measure(piece).map_err(failed())?;
        Ok((found.bytes < self.whole - start).then(|| found.fault(path, line)))
    }
}

fn last_byte(file: &mut File) -> std::io::Result<u8> {
    let mut byte = [0];
    file.seek(SeekFrom::End(-1))?;
    file.read_exact(&mut byte)?;
    Ok(byte[0])
}
