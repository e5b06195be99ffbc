//! Writes a log in format 1.1: a directory with two info files and one data file per worker and block, with one line per record.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use super::block_file::{BlockFile, Written};
use super::log_folder::LogFolder;
use super::record::{ExpStatus, Record, is_worker_id};
use super::{LoggerInfo, ScenarioInfo, begun, cell, columns, data_files, json_file, logger_info, scenario_info};
use crate::MetricsError;
use crate::log::BlockType;

/// Writes records to a log directory, each flushed to the operating system as soon as it is written.
///
/// Checks the rules of the format for every record: block and experience numbers never decrease, every record has the same metrics,
/// a worker completes an experience only once, and its rows of one experience in one block have the same block type. Keeps one
/// file open at a time, and syncs it to disk when it switches to the next, so that a power failure loses at most rows of the last
/// block. A second writer to the directory is refused where the system can detect it.
///
/// Before each record, and at the end, it checks that the directory and the files are still those that it wrote, with the same
/// lengths. If one was removed, renamed, replaced or truncated in the meantime, it fails and does not recreate anything.
#[derive(Debug)]
pub struct LogWriter {
    folder: LogFolder,
    metrics_columns: Vec<String>,
    pub(super) progress: Progress,
    file: Option<BlockFile>,
    /// The files that are not open, by their paths inside the directory.
    files: BTreeMap<PathBuf, Written>,
    /// Whether files are synced to disk.
    syncs: bool,
}

/// State that later records are checked against.
#[derive(Debug, Default)]
pub(super) struct Progress {
    /// Metrics of every record, sorted; known after the first record.
    pub(super) columns: Option<Vec<String>>,
    last_block_num: u64,
    last_exp_num: u64,
    /// Workers that completed the last experience.
    completed_by: BTreeSet<String>,
    /// For each worker, the block of its last row in the last experience.
    begun_in: BTreeMap<String, (u64, BlockType)>,
}

impl LogWriter {
    /// Starts a log in `dir`, conventionally `BASE/SCENARIO-TIMESTAMP`; creates the directory if necessary.
    ///
    /// # Errors
    /// [`MetricsError::LogExists`] if the directory contains anything but the leftovers of an interrupted creation;
    /// [`MetricsError::InUse`] if another writer is using it; [`MetricsError::Io`].
    pub fn create(
        dir: impl AsRef<Path>,
        logger_info: &LoggerInfo,
        scenario_info: &ScenarioInfo,
    ) -> Result<Self, MetricsError> {
        Self::begin(dir.as_ref(), logger_info, scenario_info, true)
    }

    /// Like [`LogWriter::create`], but without syncing to disk, for a log that is read immediately and thrown away.
    ///
    /// # Errors
    /// Those of [`LogWriter::create`].
    pub fn create_unsynced(
        dir: impl AsRef<Path>,
        logger_info: &LoggerInfo,
        scenario_info: &ScenarioInfo,
    ) -> Result<Self, MetricsError> {
        Self::begin(dir.as_ref(), logger_info, scenario_info, false)
    }

    fn begin(
        dir: &Path,
        logger_info: &LoggerInfo,
        scenario_info: &ScenarioInfo,
        syncs: bool,
    ) -> Result<Self, MetricsError> {
        fs::create_dir_all(dir).map_err(MetricsError::io(dir, "make this directory"))?;
        // Locks before reading or writing anything; otherwise two simultaneous writers could both find the directory free.
        let folder = LogFolder::lock(dir)?;
        if !begun::is_free(dir)? {
            return Err(MetricsError::LogExists(dir.to_owned()));
        }
        json_file::write_info(&dir.join(scenario_info::FILE_NAME), scenario_info, syncs)?;
        json_file::write_info(&dir.join(logger_info::FILE_NAME), logger_info, syncs)?;
        begun::remove_leftovers(dir)?;
        let writer = Self::with_progress(folder, logger_info, Progress::default(), BTreeMap::new());
        Ok(Self { syncs, ..writer })
    }

    /// Continues in a directory with these data files.
    pub(super) fn with_progress(
        mut folder: LogFolder,
        logger_info: &LoggerInfo,
        progress: Progress,
        files: BTreeMap<PathBuf, Written>,
    ) -> Self {
        folder.note_info_files();
        Self {
            folder,
            metrics_columns: logger_info.metrics_columns().to_vec(),
            progress,
            file: None,
            files,
            syncs: true,
        }
    }

    /// The directory of the log.
    pub fn dir(&self) -> &Path {
        self.folder.shown()
    }

    /// The metrics and text columns, in order; `None` before the first record.
    pub fn columns(&self) -> Option<&[String]> {
        self.progress.columns.as_deref()
    }

    /// Writes one record as one line and flushes it.
    ///
    /// # Errors
    /// [`MetricsError::Record`] if the record breaks a rule of the format: nothing is written, and the log can continue.
    /// [`MetricsError::Io`] if the disk fails: a partial line is removed if possible. [`MetricsError::FolderLost`] and
    /// [`MetricsError::FileLost`] if earlier rows are no longer there: nothing is written.
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
        self.switch_to(record, &columns)?;
        // The file that was just opened, or was open already.
        if let Some(file) = &mut self.file {
            file.add_row(&self.folder, &line)?;
        }
        self.progress.advance(record, columns);
        Ok(())
    }

    /// Removes the last written block with its whole folder, as if it had never started.
    ///
    /// # Errors
    /// [`MetricsError::Io`] if the files cannot be removed; [`MetricsError::FolderLost`] if the log is no longer there.
    pub fn withdraw_block(&mut self) -> Result<(), MetricsError> {
        self.check_folder()?;
        let Some(open) = self.file.take() else { return Ok(()) };
        let rows = self.dir().join(&open.inside);
        let folder = rows.parent().unwrap_or(&rows);
        // The rows are removed first: without them the log continues with this block, whatever else remains of it.
        let removed = fs::remove_file(&rows).and_then(|()| fs::remove_dir_all(folder));
        removed.map_err(MetricsError::io(folder, "remove the block"))
    }

    /// Ends the log: syncs it to disk, and checks that all of it is there. Every record has already been flushed.
    ///
    /// # Errors
    /// [`MetricsError::Io`]; [`MetricsError::FolderLost`], [`MetricsError::FileLost`] and [`MetricsError::MissingFile`] if
    /// anything that was written is missing.
    pub fn finish(mut self) -> Result<(), MetricsError> {
        self.check_folder()?;
        self.close_file()?;
        self.folder.check_info_files()?;
        self.files
            .iter()
            .try_for_each(|(inside, written)| written.check(&self.folder, inside))
    }

    /// Opens or creates the file of a record's worker and block unless it is open already, and checks that everything is
    /// unchanged.
    fn switch_to(&mut self, record: &Record, columns: &[String]) -> Result<(), MetricsError> {
        let inside = data_path(&record.worker_id, record.block_num, record.block_type);
        let is_open = |open: &&BlockFile| open.inside == inside;
        let open = self.file.as_ref().filter(is_open);
        if open.is_some_and(BlockFile::is_unchanged) {
            return Ok(());
        }
        self.check_folder()?;
        if let Some(open) = open {
            return open.written.check(&self.folder, &inside);
        }
        self.close_file()?;
        // Checks again, because the disk may have been slow, and nothing may be created in a directory that replaced ours.
        self.check_folder()?;
        let before = self.files.get(&inside).copied();
        let header = columns::line(columns::header(columns));
        let opened = BlockFile::open(&self.folder, inside.clone(), before, &header)?;
        self.files.remove(&inside);
        self.file = Some(opened);
        // Checks again, because the new file is in a different directory if ours was replaced in the meantime.
        self.check_folder()
    }

    /// Closes the open file after syncing it to disk.
    fn close_file(&mut self) -> Result<(), MetricsError> {
        let Some(open) = &self.file else { return Ok(()) };
        if self.syncs {
            open.sync(&self.folder)?;
        }
        open.written.check(&self.folder, &open.inside)?;
        self.files.insert(open.inside.clone(), open.written);
        self.file = None;
        Ok(())
    }

    fn check_folder(&self) -> Result<(), MetricsError> {
        let open = self.file.iter().map(|open| &open.written);
        self.folder.check(self.files.values().chain(open))
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
            return bad(found, format!("them to include {missing}, a metrics column of the log"));
        }
        Ok(())
    }
}

impl Progress {
    /// Checks a record against earlier ones.
    fn check(&self, record: &Record) -> Result<(), MetricsError> {
        let order = |field: &str, found: u64, last: u64| {
            if found < last {
                let expected = format!("at least {last}, the previous number: numbers never decrease");
                return Err(bad_record(record, field, found.to_string(), expected));
            }
            Ok(())
        };
        order("block_num", record.block_num, self.last_block_num)?;
        order("exp_num", record.exp_num, self.last_exp_num)?;
        if record.exp_num == self.last_exp_num && self.completed_by.contains(&record.worker_id) {
            let found = format!("another row by {}", record.worker_id);
            let expected = "no row after the complete one: give the next experience a new number".to_owned();
            return Err(bad_record(record, "exp_num", found, expected));
        }
        let begun = self
            .begun_in
            .get(&record.worker_id)
            .filter(|_| record.exp_num == self.last_exp_num);
        // Otherwise the order of the two folders would be ambiguous.
        if let Some((block_num, block_type)) = begun
            && *block_num == record.block_num
            && *block_type != record.block_type
        {
            let found = record.block_type.to_string();
            let expected = format!("{block_type}, as in the previous row of this experience");
            return Err(bad_record(record, "block_type", found, expected));
        }
        Ok(())
    }

    /// Updates the state with a written record.
    pub(super) fn advance(&mut self, record: &Record, columns: Vec<String>) {
        if record.exp_num != self.last_exp_num {
            self.completed_by.clear();
            self.begun_in.clear();
        }
        let worker = record.worker_id.clone();
        self.begun_in.insert(worker, (record.block_num, record.block_type));
        if record.exp_status == ExpStatus::Complete {
            self.completed_by.insert(record.worker_id.clone());
        }
        self.last_block_num = record.block_num;
        self.last_exp_num = record.exp_num;
        self.columns = Some(columns);
    }
}

/// `WORKER/BLOCKNUM-BLOCKTYPE/data-log.tsv`, inside the log's directory.
fn data_path(worker_id: &str, block_num: u64, block_type: BlockType) -> PathBuf {
    Path::new(worker_id)
        .join(format!("{block_num}-{block_type}"))
        .join(data_files::FILE_NAME)
}

/// Checks a record on its own.
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
        if name.is_empty() || columns::STANDARD_COLUMNS.contains(&name.as_str()) {
            let expected = "a non-empty name that is not a standard column's".to_owned();
            return Err(bad_record(record, "metrics", cell::shown(name), expected));
        }
        if value.is_infinite() {
            let expected = "a finite number, or NaN for a missing one".to_owned();
            return Err(bad_record(record, name, number(*value), expected));
        }
    }
    for name in record.texts.keys() {
        if name.is_empty() || columns::STANDARD_COLUMNS.contains(&name.as_str()) || record.metrics.contains_key(name) {
            let expected = "a non-empty name that is neither a standard column's nor a metric's".to_owned();
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
    // The columns were compared with the record's, so each of them has a number or a string.
    let cell = |name: &String| match record.texts.get(name) {
        Some(text) => text.clone(),
        None => number(record.metrics[name.as_str()]),
    };
    standard.into_iter().chain(columns.iter().map(cell)).collect()
}

/// The shortest string that reads back as the same number.
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
