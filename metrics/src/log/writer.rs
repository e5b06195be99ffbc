//! Writes a log, format 1.1: one directory, two info files, one data file per worker and block, one line per record.
//!
//! Not here: taking up a log that was interrupted, see `resume`.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use super::record::{ExpStatus, Record, is_worker_id};
use super::{LoggerInfo, ScenarioInfo, begun, cell, columns, data_files, json_file, logger_info, scenario_info};
use crate::MetricsError;
use crate::log::BlockType;

/// Writes records to a log directory, each flushed to the operating system as soon as it is written.
///
/// The rules of the format are kept record by record: block and experience numbers never fall, every record has the
/// same metrics, a worker completes an experience once. Opens one file at a time, and asks the disk to have it when it
/// turns to the next: a machine that loses its power loses rows of the last block at most. Two writers on one directory
/// would spoil it, so that the second is refused where the system can tell.
#[derive(Debug)]
pub struct LogWriter {
    dir: PathBuf,
    metrics_columns: Vec<String>,
    pub(super) progress: Progress,
    file: Option<BlockFile>,
    /// Held, not used: the system lets go of it when the writer ends, however it ends.
    _lock: Option<File>,
}

/// What later records are checked against.
#[derive(Debug, Default)]
pub(super) struct Progress {
    /// Metrics of every record, alphabetical; known once there is a record.
    pub(super) columns: Option<Vec<String>>,
    last_block_num: u64,
    last_exp_num: u64,
    /// Workers that completed the last experience.
    completed_by: BTreeSet<String>,
}

#[derive(Debug)]
struct BlockFile {
    path: PathBuf,
    file: File,
    /// Bytes of whole lines in it.
    length: u64,
}

impl LogWriter {
    /// Begins a log in `dir`, conventionally `BASE/SCENARIO-TIMESTAMP`; makes the directory if need be.
    ///
    /// # Errors
    /// [`MetricsError::LogExists`] when the directory holds anything but what is left of a log whose making was interrupted,
    /// [`MetricsError::InUse`], [`MetricsError::Io`].
    pub fn create(
        dir: impl AsRef<Path>,
        logger_info: &LoggerInfo,
        scenario_info: &ScenarioInfo,
    ) -> Result<Self, MetricsError> {
        let dir = dir.as_ref();
        fs::create_dir_all(dir).map_err(MetricsError::io(dir, "make this directory"))?;
        // Before anything is looked at or written: two that begin at the same moment would both find the directory free.
        let lock = lock(dir)?;
        if !begun::is_free(dir)? {
            return Err(MetricsError::LogExists { path: dir.to_owned() });
        }
        json_file::write_json(&dir.join(scenario_info::FILE_NAME), scenario_info)?;
        json_file::write_json(&dir.join(logger_info::FILE_NAME), logger_info)?;
        begun::remove_leftovers(dir)?;
        Ok(Self::with_progress(dir, logger_info, Progress::default(), lock))
    }

    pub(super) fn with_progress(dir: &Path, logger_info: &LoggerInfo, progress: Progress, lock: Option<File>) -> Self {
        let metrics_columns = logger_info.metrics_columns().to_vec();
        Self {
            dir: dir.to_owned(),
            metrics_columns,
            progress,
            file: None,
            _lock: lock,
        }
    }

    /// The directory of the log.
    pub fn dir(&self) -> &Path {
        &self.dir
    }

    /// The columns beside the standard ones, of metrics and of words, in their order; `None` before the first record.
    pub fn columns(&self) -> Option<&[String]> {
        self.progress.columns.as_deref()
    }

    /// Writes one record as one line and flushes it.
    ///
    /// # Errors
    /// [`MetricsError::Record`] when it breaks a rule of the format: then nothing is written, and the log goes on as
    /// if it had not been given. [`MetricsError::Io`] when the disk refuses: a line begun is taken back if possible.
    pub fn write(&mut self, record: &Record) -> Result<(), MetricsError> {
        check_cells(record)?;
        self.check_metrics(record)?;
        self.progress.check(record)?;
        let columns = self
            .progress
            .columns
            .clone()
            .unwrap_or_else(|| columns::metric_columns(record));
        let line = columns::line(cells(record, &columns));
        self.block_file(record, &columns)?.append(&line)?;
        self.progress.advance(record, columns);
        Ok(())
    }

    /// Ends the log: nothing is pending, since every record was flushed; this asks the disk to have it, too.
    ///
    /// # Errors
    /// [`MetricsError::Io`].
    pub fn finish(self) -> Result<(), MetricsError> {
        self.file.as_ref().map_or(Ok(()), BlockFile::sync)
    }

    /// The file of a record's worker and block, opened or made if it is not the one that is open.
    fn block_file(&mut self, record: &Record, columns: &[String]) -> Result<&mut BlockFile, MetricsError> {
        let path = data_path(&self.dir, &record.worker_id, record.block_num, record.block_type);
        let open = match self.file.take() {
            Some(open) if open.path == path => open,
            before => {
                before.as_ref().map_or(Ok(()), BlockFile::sync)?;
                BlockFile::open(path, columns)?
            }
        };
        Ok(self.file.insert(open))
    }

    fn check_metrics(&self, record: &Record) -> Result<(), MetricsError> {
        let bad = |found: String, expected: String| Err(bad_record(record, "metrics", found, expected));
        if let Some(columns) = &self.progress.columns {
            let found = columns::metric_columns(record);
            if found != *columns {
                return bad(
                    found.join(", "),
                    format!("{} as in the first record", columns.join(", ")),
                );
            }
        } else if let Some(missing) = self
            .metrics_columns
            .iter()
            .find(|name| !record.metrics.contains_key(*name))
        {
            let found = columns::metric_columns(record).join(", ");
            let found = if found.is_empty() { "none".to_owned() } else { found };
            return bad(found, format!("also {missing}, a metrics column of the log"));
        }
        Ok(())
    }
}

impl Progress {
    /// The rules between a record and those before it.
    fn check(&self, record: &Record) -> Result<(), MetricsError> {
        let order = |field: &str, found: u64, last: u64| {
            if found < last {
                let expected = format!("at least {last}, the number before it: numbers never fall");
                return Err(bad_record(record, field, found.to_string(), expected));
            }
            Ok(())
        };
        order("block_num", record.block_num, self.last_block_num)?;
        order("exp_num", record.exp_num, self.last_exp_num)?;
        if record.exp_num == self.last_exp_num && self.completed_by.contains(&record.worker_id) {
            let found = format!("another row by {}", record.worker_id);
            let expected = "no row after the complete one: give the next experience a number of its own".to_owned();
            return Err(bad_record(record, "exp_num", found, expected));
        }
        Ok(())
    }

    /// Takes a record that was written into account.
    pub(super) fn advance(&mut self, record: &Record, columns: Vec<String>) {
        if record.exp_num != self.last_exp_num {
            self.completed_by.clear();
        }
        if record.exp_status == ExpStatus::Complete {
            self.completed_by.insert(record.worker_id.clone());
        }
        self.last_block_num = record.block_num;
        self.last_exp_num = record.exp_num;
        self.columns = Some(columns);
    }
}

impl BlockFile {
    /// Opens a data file for appending, with its header where it is new.
    fn open(path: PathBuf, columns: &[String]) -> Result<Self, MetricsError> {
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent).map_err(MetricsError::io(parent, "make this directory"))?;
        }
        let file = OpenOptions::new().append(true).create(true).open(&path);
        let file = file.map_err(MetricsError::io(&path, "open this file"))?;
        let length = file
            .metadata()
            .map_err(MetricsError::io(&path, "measure this file"))?
            .len();
        let mut opened = Self { path, file, length };
        if length == 0 {
            opened.append(&columns::line(columns::header(columns)))?;
        }
        Ok(opened)
    }

    /// Asks the disk to have what was written.
    fn sync(&self) -> Result<(), MetricsError> {
        // What is no file, such as a pipe that a link leads to, has nothing to keep.
        match self.file.sync_all() {
            Err(error) if error.kind() != ErrorKind::InvalidInput => {
                Err(MetricsError::io(&self.path, "write this file")(error))
            }
            _ => Ok(()),
        }
    }

    /// Adds one line in one call. If only a part of it could be written, that part is taken back.
    fn append(&mut self, line: &[u8]) -> Result<(), MetricsError> {
        if let Err(source) = self.file.write_all(line) {
            // Where even this fails the torn line stays, and the reader names it.
            let _ = self.file.set_len(self.length);
            return Err(MetricsError::io(&self.path, "append a line to this file")(source));
        }
        self.length += line.len() as u64;
        Ok(())
    }
}

/// Keeps a second writer away from a directory, as long as the file that comes back is open. Where the system has no such locks, there is none.
///
/// It is the directory that is locked: it is there before any file of the log, and no file is put in its place. Only where locks
/// are advice: elsewhere they would keep readers away, too.
pub(super) fn lock(dir: &Path) -> Result<Option<File>, MetricsError> {
    lock_by(dir, File::try_lock)
}

/// Keeps writers away, but not others that only read.
pub(super) fn lock_for_reading(dir: &Path) -> Result<Option<File>, MetricsError> {
    lock_by(dir, File::try_lock_shared)
}

fn lock_by(dir: &Path, try_lock: fn(&File) -> Result<(), TryLockError>) -> Result<Option<File>, MetricsError> {
    if !cfg!(unix) {
        return Ok(None);
    }
    let file = File::open(dir).map_err(MetricsError::io(dir, "open this directory"))?;
    match try_lock(&file) {
        Ok(()) => Ok(Some(file)),
        Err(TryLockError::WouldBlock) => Err(MetricsError::InUse { path: dir.to_owned() }),
        Err(TryLockError::Error(_)) => Ok(None),
    }
}

/// `DIR/WORKER/BLOCKNUM-BLOCKTYPE/data-log.tsv`.
fn data_path(dir: &Path, worker_id: &str, block_num: u64, block_type: BlockType) -> PathBuf {
    dir.join(worker_id)
        .join(format!("{block_num}-{block_type}"))
        .join(data_files::FILE_NAME)
}

/// The rules a record must keep whatever came before it.
fn check_cells(record: &Record) -> Result<(), MetricsError> {
    if !is_worker_id(&record.worker_id) {
        let expected = "letters, digits, _, - and ., not only dots".to_owned();
        return Err(bad_record(
            record,
            "worker_id",
            cell::shown(&record.worker_id),
            expected,
        ));
    }
    for (name, value) in &record.metrics {
        if name.is_empty() || columns::STANDARD.contains(&name.as_str()) {
            let expected = "a name that is not empty and not a standard column's".to_owned();
            return Err(bad_record(record, "metrics", cell::shown(name), expected));
        }
        if value.is_infinite() {
            let expected = "a finite number, or NaN for a missing one".to_owned();
            return Err(bad_record(record, name, number(*value), expected));
        }
    }
    for name in record.texts.keys() {
        if name.is_empty() || columns::STANDARD.contains(&name.as_str()) || record.metrics.contains_key(name) {
            let expected = "a name that is not empty and neither a standard column's nor a metric's".to_owned();
            return Err(bad_record(record, "texts", cell::shown(name), expected));
        }
    }
    Ok(())
}

fn cells(record: &Record, columns: &[String]) -> Vec<String> {
    let standard = [
        record.block_num.to_string(),
        record.exp_num.to_string(),
        record.worker_id.clone(),
        record.block_type.to_string(),
        record.block_subtype.to_string(),
        record.task_name.clone(),
        super::spaced_json(&record.task_params),
        record.exp_status.to_string(),
        record.timestamp.to_string(),
    ];
    // The columns were compared with the record's, so each of them has a number or a word.
    let cell = |name: &String| match record.texts.get(name) {
        Some(text) => text.clone(),
        None => number(record.metrics[name.as_str()]),
    };
    standard.into_iter().chain(columns.iter().map(cell)).collect()
}

/// The shortest text that reads back as the same number.
fn number(value: f64) -> String {
    if value.is_nan() {
        "nan".to_owned()
    } else {
        format!("{value:?}")
    }
}

fn bad_record(record: &Record, field: &str, found: String, expected: String) -> MetricsError {
    MetricsError::Record {
        exp_num: record.exp_num,
        field: field.to_owned(),
        found,
        expected,
    }
}
