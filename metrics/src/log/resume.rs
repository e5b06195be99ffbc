//! Reopens a log whose run was interrupted.

use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::BufReader;
use std::path::Path;

use super::block_file::Written;
use super::cell::listed;
use super::faults::Faults;
use super::log_folder::LogFolder;
use super::logger_info::LoggerInfo;
use super::rows::Rows;
use super::table::{Table, Texts};
use super::whole_rows;
use super::writer::{LogWriter, Progress};
use super::{begun, columns, data_file, data_files};
use crate::MetricsError;

impl LogWriter {
    /// Continues the log in `dir`, which must have format 1.1. Removes the last line if it was torn when the run stopped. New
    /// records must have the same metrics as earlier ones, and numbers that do not decrease.
    ///
    /// The log need not have any record yet, but its `logger_info.json` must exist.
    ///
    /// # Errors
    /// Those of [`read_log`](crate::read_log), [`MetricsError::InUse`] while another writer is using it, and
    /// [`MetricsError::OtherColumns`] for a data file of format 1.0 or one with different columns.
    pub fn resume(dir: impl AsRef<Path>) -> Result<Self, MetricsError> {
        let dir = dir.as_ref();
        // Reports a path that is not a directory before locking it.
        data_files::find(dir)?;
        let folder = LogFolder::lock(dir)?;
        let files = data_files::find(dir)?;
        let logger_info = LoggerInfo::read(dir)?;
        begun::remove_leftovers(dir)?;
        let mut table = Table::new(dir, logger_info.metrics_columns(), Texts::Leave);
        let mut columns: Option<Vec<String>> = None;
        let mut written_files = BTreeMap::new();
        for path in &files {
            let bytes = remove_torn_row(path)?;
            if bytes == 0 {
                continue;
            }
            let before = table.rows.len();
            let header = data_file::read(path, logger_info.metrics_columns(), &mut table, &mut Faults::Stop)?;
            let metrics = columns.get_or_insert_with(|| metrics_of(&header));
            check_header(path, &header, metrics)?;
            let inside = path.strip_prefix(dir).expect("the files were found inside the log");
            let rows = (table.rows.len() - before) as u64;
            written_files.insert(inside.to_owned(), Written::found(path, rows, bytes)?);
        }
        let mut progress = Progress::default();
        for row in latest(&table.rows) {
            let record = table.rows.get(row).expect("it is one of the rows").to_record();
            progress.advance(&record, columns.clone().unwrap_or_default());
        }
        progress.columns = columns;
        Ok(Self::with_progress(folder, &logger_info, progress, written_files))
    }
}

/// The rows with the largest experience number, of which there are few, by block number.
fn latest(rows: &Rows) -> Vec<usize> {
    let last = rows.exp_nums().iter().max();
    let mut latest: Vec<usize> = (0..rows.len())
        .filter(|&row| Some(&rows.exp_nums()[row]) == last)
        .collect();
    latest.sort_by_key(|&row| rows.block_nums()[row]);
    latest
}

/// The columns of a header that are not standard ones.
fn metrics_of(header: &[String]) -> Vec<String> {
    let mut metrics: Vec<String> = header
        .iter()
        .filter(|name| !columns::STANDARD_COLUMNS.contains(&name.as_str()))
        .cloned()
        .collect();
    metrics.sort();
    metrics
}

/// Fails if a file's header differs from the header for the log's next record.
fn check_header(path: &Path, header: &[String], metrics: &[String]) -> Result<(), MetricsError> {
    let expected = columns::header(metrics);
    if header == expected {
        return Ok(());
    }
    Err(MetricsError::OtherColumns {
        path: path.to_owned(),
        found: listed(header),
        expected: listed(&expected),
    })
}

/// Truncates a file after its last whole row, and returns the number of remaining bytes. A file without even a header is removed.
///
/// Removes at most part of a single row: if an open quote swallowed other rows, or lines end with a carriage return only, the file
/// stays unchanged, and the fault is the error.
fn remove_torn_row(path: &Path) -> Result<u64, MetricsError> {
    let failed = || MetricsError::io(path, "remove a torn last line of this file");
    let file = OpenOptions::new().read(true).write(true).open(path).map_err(failed())?;
    let found = whole_rows::measure(BufReader::with_capacity(1 << 16, &file)).map_err(failed())?;
    if found.rows_swallowed || found.lone_returns {
        return Err(found.fault(path, 1));
    }
    if found.bytes == 0 {
        drop(file);
        fs::remove_file(path).map_err(failed())?;
        return Ok(0);
    }
    if file.metadata().map_err(failed())?.len() > found.bytes {
        file.set_len(found.bytes).map_err(failed())?;
    }
    Ok(found.bytes)
}
