//! Collects rows file by file. All columns grow together, and columns that a file lacks are padded.

use std::convert::Infallible;
use std::ops::Range;
use std::path::Path;

use indexmap::IndexMap;

use super::rows::{Cells, Rows};
use super::shared_column::{Seen, SharedColumn};
use crate::{LogLine, MetricsError};

/// Maximum number of records in one log.
pub const MAX_RECORDS: usize = 10_000_000;

/// Maximum number of columns in the data files of one log.
pub const MAX_COLUMNS: usize = 1_000;

/// Maximum number of cells in metrics and undeclared columns, over all rows.
pub const MAX_CELLS: u64 = 500_000_000;

/// Whether undeclared text columns are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Texts {
    Leave,
    Keep,
}

/// A log's rows while being read.
#[derive(Debug)]
pub(super) struct Table<'a> {
    /// The log's directory, for messages.
    dir: &'a Path,
    texts: Texts,
    pub(super) rows: Rows,
    /// Line of each row in its file.
    lines: Vec<u32>,
    /// The files in order, each with the index of its first row.
    files: Vec<(&'a Path, usize)>,
    pub(super) workers: Seen,
    pub(super) task_names: Seen,
    pub(super) task_params: Seen,
    undeclared: IndexMap<String, Other>,
    num_cells: u64,
    buffer: Vec<f64>,
}

/// An undeclared column.
#[derive(Debug, Default)]
struct Other {
    numbers: Vec<f64>,
    /// Whether any cell was not a number.
    has_words: bool,
    texts: SharedColumn<String>,
    seen: Seen,
}

impl<'a> Table<'a> {
    pub(super) fn new(dir: &'a Path, metrics_columns: &[String], texts: Texts) -> Self {
        let metrics = metrics_columns.iter().map(|name| (name.clone(), Vec::new()));
        let rows = Rows {
            metrics: metrics.collect(),
            ..Rows::default()
        };
        Self {
            dir,
            texts,
            rows,
            lines: Vec::new(),
            files: Vec::new(),
            workers: Seen::default(),
            task_names: Seen::default(),
            task_params: Seen::default(),
            undeclared: IndexMap::new(),
            num_cells: 0,
            buffer: Vec::new(),
        }
    }

    /// Starts the next file; its rows follow.
    pub(super) fn begin_file(&mut self, path: &'a Path) {
        self.files.push((path, self.rows.len()));
    }

    /// Prepares the undeclared columns with these names for the rows that follow; returns their indices.
    pub(super) fn begin_columns<'n>(
        &mut self,
        names: impl Iterator<Item = &'n str>,
    ) -> Result<Vec<usize>, MetricsError> {
        let mut numbers = Vec::new();
        for name in names {
            let entry = self.undeclared.entry(name.to_owned());
            let number = entry.index();
            let missing = entry.or_default().missing(self.rows.len(), self.texts);
            numbers.push(number);
            self.count_cells(missing)?;
            self.undeclared[number].pad(self.rows.len(), self.texts);
        }
        self.check_limit("columns or more", self.undeclared.len() as u64, MAX_COLUMNS as u64)?;
        Ok(numbers)
    }

    /// A reusable buffer for the metrics of a row, which [`push`](Self::push) takes back.
    pub(super) fn take_buffer(&mut self) -> Vec<f64> {
        std::mem::take(&mut self.buffer)
    }

    /// Adds a row: the declared metrics in order, and the cells of undeclared columns with the columns' indices.
    pub(super) fn push<'c>(
        &mut self,
        line: u64,
        cells: &Cells,
        mut metrics: Vec<f64>,
        undeclared: impl ExactSizeIterator<Item = (usize, &'c str)>,
    ) -> Result<(), MetricsError> {
        self.check_limit("rows or more", self.rows.len() as u64 + 1, MAX_RECORDS as u64)?;
        self.count_cells((metrics.len() + undeclared.len()) as u64)?;
        // A file has fewer bytes, and so fewer lines, than the range of a u32.
        self.lines.push(line as u32);
        self.rows.push(cells);
        for (column, number) in self.rows.metrics.values_mut().zip(metrics.drain(..)) {
            column.push(number);
        }
        self.buffer = metrics;
        for (column, text) in undeclared {
            self.undeclared[column].push(text, self.texts);
        }
        Ok(())
    }

    /// File and line of a row, by index in the order of files and lines.
    pub(super) fn line_of(&self, row: usize) -> LogLine {
        let file = self.files.partition_point(|(_, start)| *start <= row).saturating_sub(1);
        LogLine {
            path: self.files[file].0.to_owned(),
            line: u64::from(self.lines[row]),
        }
    }

    /// Each file with its range of row indices.
    pub(super) fn files(&self) -> impl Iterator<Item = (&'a Path, Range<usize>)> {
        let starts = self.files.iter().map(|(_, start)| *start);
        let ends = starts.skip(1).chain([self.rows.len()]);
        self.files
            .iter()
            .zip(ends)
            .map(|((path, start), end)| (*path, *start..end))
    }

    /// Appends the undeclared columns to the declared ones: numeric columns, and text columns if they are kept.
    pub(super) fn complete(&mut self) -> Result<(), MetricsError> {
        let num_rows = self.rows.len();
        for (name, mut other) in std::mem::take(&mut self.undeclared) {
            self.count_cells(other.missing(num_rows, self.texts))?;
            other.pad(num_rows, self.texts);
            if !other.has_words {
                self.rows.metrics.insert(name, other.numbers);
            } else if self.texts == Texts::Keep {
                self.rows.texts.insert(name, other.texts);
            }
        }
        Ok(())
    }

    /// Whether the log has reached one of its overall limits.
    pub(super) fn is_full(&self) -> bool {
        self.rows.len() == MAX_RECORDS || self.undeclared.len() > MAX_COLUMNS || self.num_cells > MAX_CELLS
    }

    fn count_cells(&mut self, more: u64) -> Result<(), MetricsError> {
        self.num_cells += more;
        self.check_limit("numbers or more", self.num_cells, MAX_CELLS)
    }

    fn check_limit(&self, what: &'static str, found: u64, limit: u64) -> Result<(), MetricsError> {
        if found <= limit {
            return Ok(());
        }
        Err(MetricsError::too_large(self.dir, what, found, limit))
    }
}

impl Other {
    /// Number of cells that padding to `num_rows` rows would add.
    fn missing(&self, num_rows: usize, texts: Texts) -> u64 {
        let present = match texts {
            _ if !self.has_words => self.numbers.len(),
            Texts::Keep => self.texts.ids().len(),
            Texts::Leave => num_rows,
        };
        (num_rows - present) as u64
    }

    fn pad(&mut self, num_rows: usize, texts: Texts) {
        if !self.has_words {
            self.numbers.resize(num_rows, f64::NAN);
        }
        if texts == Texts::Keep {
            while self.texts.ids().len() < num_rows {
                self.push_text("");
            }
        }
    }

    fn push(&mut self, text: &str, texts: Texts) {
        if !self.has_words {
            if let Some(number) = super::cell::number(text) {
                self.numbers.push(number);
            } else {
                self.has_words = true;
                self.numbers = Vec::new();
            }
        }
        if texts == Texts::Keep {
            self.push_text(text);
        }
    }

    fn push_text(&mut self, text: &str) {
        let id = self
            .seen
            .id(&mut self.texts, text, |text| Ok::<_, Infallible>(text.to_owned()));
        self.texts.push(id.unwrap_or_else(|never| match never {}));
    }
}
