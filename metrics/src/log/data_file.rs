//! Reads one `data-log.tsv`: its header, its rows, and what is wrong with them.
//!
//! Not here: how the files of a log go together, see `reader`.

use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

use csv::{ErrorKind, StringRecord};
use indexmap::IndexMap;

use super::cell::{Cell, ParamsReader};
use super::columns::{SINCE_1_1, STANDARD};
use super::record::{BlockSubtype, BlockType, ExpStatus, Record};
use crate::MetricsError;

/// Largest data file that is read, in bytes.
pub const MAX_FILE_BYTES: u64 = 1 << 30;

/// Largest cell, in bytes.
pub const MAX_CELL_BYTES: usize = 1 << 20;

/// Reads every row in the order of the file and hands it on with its line number; returns the header.
pub(super) fn read(
    path: &Path,
    metrics_columns: &[String],
    params: &mut ParamsReader,
    mut take: impl FnMut(Record, u64) -> Result<(), MetricsError>,
) -> Result<Vec<String>, MetricsError> {
    let (file, length) = open_whole(path)?;
    // Rows that a running writer adds meanwhile are left for the next reading.
    let mut rows = csv::ReaderBuilder::new()
        .delimiter(b'\t')
        .has_headers(false)
        .flexible(true)
        .from_reader(BufReader::new(file.take(length)));
    let mut row = StringRecord::new();
    if !next_row(&mut rows, &mut row, path)? {
        return Err(MetricsError::EmptyFile { path: path.to_owned() });
    }
    let header = Header::new(path, &row, metrics_columns)?;
    while next_row(&mut rows, &mut row, path)? {
        let line = row.position().map_or(0, csv::Position::line);
        take(header.record(&row, line, params)?, line)?;
    }
    Ok(header.names)
}

/// Opens a data file after checking its size and that its last line is whole.
fn open_whole(path: &Path) -> Result<(File, u64), MetricsError> {
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
    if length > 0 && last_byte(&mut file).map_err(MetricsError::io(path, "read this file"))? != b'\n' {
        let line = num_lines(&mut file, length).map_err(MetricsError::io(path, "read this file"))? + 1;
        return Err(MetricsError::TornLastLine {
            path: path.to_owned(),
            line,
        });
    }
    file.rewind().map_err(MetricsError::io(path, "read this file"))?;
    Ok((file, length))
}

fn last_byte(file: &mut File) -> std::io::Result<u8> {
    let mut byte = [0];
    file.seek(SeekFrom::End(-1))?;
    file.read_exact(&mut byte)?;
    Ok(byte[0])
}

fn num_lines(file: &mut File, length: u64) -> std::io::Result<u64> {
    file.rewind()?;
    let mut count = 0;
    for byte in BufReader::new(file.take(length)).bytes() {
        count += u64::from(byte? == b'\n');
    }
    Ok(count)
}

fn next_row(rows: &mut csv::Reader<impl Read>, row: &mut StringRecord, path: &Path) -> Result<bool, MetricsError> {
    rows.read_record(row).map_err(|error| {
        let line = error.position().map_or(0, csv::Position::line);
        match error.into_kind() {
            ErrorKind::Utf8 { .. } => MetricsError::NotUtf8 {
                path: path.to_owned(),
                line,
            },
            ErrorKind::Io(source) => MetricsError::io(path, "read this file")(source),
            other => MetricsError::io(path, "read this file")(std::io::Error::other(format!("{other:?}"))),
        }
    })
}

/// Where the columns of one file are.
struct Header<'a> {
    path: &'a Path,
    names: Vec<String>,
    standard: [usize; STANDARD.len()],
    /// Column of `block_subtype`, which logs of format 1.0 lack.
    subtype: Option<usize>,
    /// Columns that must hold numbers.
    metrics: Vec<usize>,
    /// Columns nobody declared; kept where they hold numbers.
    others: Vec<usize>,
}

impl<'a> Header<'a> {
    fn new(path: &'a Path, row: &StringRecord, metrics_columns: &[String]) -> Result<Self, MetricsError> {
        let names: Vec<String> = row.iter().map(str::to_owned).collect();
        if let Some(repeated) = names
            .iter()
            .enumerate()
            .find(|(index, name)| names[..*index].contains(name))
        {
            return Err(MetricsError::RepeatedColumn {
                path: path.to_owned(),
                column: repeated.1.clone(),
            });
        }
        let place = |column: &str| names.iter().position(|name| name == column);
        let required = |column: &str| {
            place(column).ok_or_else(|| MetricsError::MissingColumn {
                path: path.to_owned(),
                column: column.to_owned(),
                found: names.join(", "),
            })
        };
        let mut standard = [0; STANDARD.len()];
        for (index, column) in standard
            .iter_mut()
            .zip(STANDARD)
            .filter(|(_, column)| *column != SINCE_1_1)
        {
            *index = required(column)?;
        }
        let metrics = metrics_columns
            .iter()
            .map(|column| required(column))
            .collect::<Result<Vec<_>, _>>()?;
        let is_other = |index: &usize| !metrics.contains(index) && !STANDARD.contains(&names[*index].as_str());
        let others = (0..names.len()).filter(is_other).collect();
        Ok(Self {
            path,
            subtype: place(SINCE_1_1),
            standard,
            metrics,
            others,
            names,
        })
    }

    fn record(&self, row: &StringRecord, line: u64, params: &mut ParamsReader) -> Result<Record, MetricsError> {
        if row.len() != self.names.len() {
            let (found, expected) = (row.len(), self.names.len());
            return Err(MetricsError::RaggedRow {
                path: self.path.to_owned(),
                line,
                found,
                expected,
            });
        }
        // Every index is below the number of names, which is the number of cells.
        let cell = |index: usize| Cell {
            path: self.path,
            line,
            column: &self.names[index],
            text: &row[index],
        };
        if let Some(index) = (0..row.len()).find(|index| row[*index].len() > MAX_CELL_BYTES) {
            return Err(cell(index).error(format!("at most {MAX_CELL_BYTES} bytes; is a quote not closed?")));
        }
        let [
            block_num,
            exp_num,
            worker_id,
            block_type,
            _,
            task_name,
            task_params,
            exp_status,
            timestamp,
        ] = self.standard.map(cell);
        Ok(Record {
            block_num: block_num.whole_number()?,
            exp_num: exp_num.whole_number()?,
            worker_id: worker_id.worker()?,
            block_type: block_type.word(BlockType::expected)?,
            block_subtype: match self.subtype {
                Some(index) => cell(index).word(BlockSubtype::expected)?,
                None => BlockSubtype::Wake,
            },
            task_name: task_name.text.to_owned(),
            task_params: params.read(task_params)?,
            exp_status: exp_status.word(ExpStatus::expected)?,
            timestamp: timestamp.timestamp()?,
            metrics: self.numbers(cell)?,
        })
    }

    fn numbers<'r>(&self, cell: impl Fn(usize) -> Cell<'r>) -> Result<IndexMap<String, f64>, MetricsError> {
        let mut numbers = IndexMap::with_capacity(self.metrics.len() + self.others.len());
        for &index in &self.metrics {
            numbers.insert(self.names[index].clone(), cell(index).number()?);
        }
        for &index in &self.others {
            if let Ok(number) = cell(index).number() {
                numbers.insert(self.names[index].clone(), number);
            }
        }
        Ok(numbers)
    }
}
