//! Takes up a log whose run was interrupted.
//!
//! Not here: writing, see `writer`.

use std::fs::{self, OpenOptions};
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use super::cell::ParamsReader;
use super::logger_info::LoggerInfo;
use super::record::Record;
use super::writer::{self, LogWriter, Progress};
use super::{begun, columns, data_file, data_files};
use crate::MetricsError;

impl LogWriter {
    /// Continues the log in `dir`, which was written in format 1.1. A last line that was torn when the run stopped is
    /// removed. Records that follow must have the metrics of those before, and numbers that are not smaller.
    ///
    /// The log may have no record yet; its `logger_info.json` must be there.
    ///
    /// # Errors
    /// Those of [`read_log`](crate::read_log), [`MetricsError::InUse`] while another writer has it, and [`MetricsError::OtherColumns`] for a data file of format 1.0 or
    /// one with columns of its own.
    pub fn resume(dir: impl AsRef<Path>) -> Result<Self, MetricsError> {
        let dir = dir.as_ref();
        // What may not be a directory is told first.
        data_files::find(dir)?;
        let lock = writer::lock(dir)?;
        let files = data_files::find(dir)?;
        let logger_info = LoggerInfo::read(dir)?;
        begun::remove_leftovers(dir)?;
        let mut params = ParamsReader::default();
        let mut columns: Option<Vec<String>> = None;
        let mut latest: Vec<Record> = Vec::new();
        for path in files {
            if !remove_torn_line(&path).map_err(MetricsError::io(&path, "remove a torn last line of this file"))? {
                continue;
            }
            let header = data_file::read(&path, logger_info.metrics_columns(), &mut params, |record, _| {
                keep_latest(&mut latest, record);
                Ok(())
            })?;
            let metrics = columns.get_or_insert_with(|| metrics_of(&header));
            check_header(&path, &header, metrics)?;
        }
        let mut progress = Progress::default();
        latest.sort_by_key(|record| record.block_num);
        for record in &latest {
            progress.advance(record, columns.clone().unwrap_or_default());
        }
        progress.columns = columns;
        Ok(Self::with_progress(dir, &logger_info, progress, lock))
    }
}

/// Keeps the records of the largest experience number, of which there are few.
fn keep_latest(latest: &mut Vec<Record>, record: Record) {
    let last_exp_num = latest.iter().map(|kept| kept.exp_num).max();
    if last_exp_num.is_none_or(|last| record.exp_num > last) {
        latest.clear();
    }
    if last_exp_num.is_none_or(|last| record.exp_num >= last) {
        latest.push(record);
    }
}

/// The columns of a header that are not standard ones.
fn metrics_of(header: &[String]) -> Vec<String> {
    let mut metrics: Vec<String> = header
        .iter()
        .filter(|name| !columns::STANDARD.contains(&name.as_str()))
        .cloned()
        .collect();
    metrics.sort();
    metrics
}

/// Refuses a file whose header is not the one that the log's next record would be written under.
fn check_header(path: &Path, header: &[String], metrics: &[String]) -> Result<(), MetricsError> {
    let expected = columns::header(metrics);
    if header == expected {
        return Ok(());
    }
    Err(MetricsError::OtherColumns {
        path: path.to_owned(),
        found: header.join(", "),
        expected: expected.join(", "),
    })
}

/// Cuts a file after its last line end. Returns whether anything is left; a file without a line is removed.
fn remove_torn_line(path: &Path) -> std::io::Result<bool> {
    let mut file = OpenOptions::new().read(true).write(true).open(path)?;
    let mut end = file.metadata()?.len();
    let mut piece = [0; 4096];
    while end > 0 {
        let start = end.saturating_sub(piece.len() as u64);
        let bytes = &mut piece[..(end - start) as usize];
        file.seek(SeekFrom::Start(start))?;
        file.read_exact(bytes)?;
        if let Some(place) = bytes.iter().rposition(|byte| *byte == b'\n') {
            file.set_len(start + place as u64 + 1)?;
            return Ok(true);
        }
        end = start;
    }
    drop(file);
    fs::remove_file(path)?;
    Ok(false)
}
