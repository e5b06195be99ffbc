//! A whole log: its two info files and the rows of all its workers, in order.
//!
//! Not here: how one data file is read, see `data_file`.

use std::fmt;
use std::path::Path;

use indexmap::IndexSet;

use super::cell::{ParamsReader, shown};
use super::logger_info::LoggerInfo;
use super::record::{Record, is_conventional_task_name};
use super::scenario_info::ScenarioInfo;
use super::{data_file, data_files};
use crate::{MetricsError, SteLog};

/// Most records that one log may hold.
pub const MAX_RECORDS: usize = 10_000_000;

/// Something about a log that is not as it should be, but does not keep it from being read.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum LogWarning {
    /// There is no `scenario_info.json`.
    NoScenarioInfo,
    /// A field of `scenario_info.json` is none of the words it may be; it was left out.
    ScenarioInfo {
        /// The field.
        field: &'static str,
        /// Its value, as JSON.
        found: String,
        /// The words it may be.
        expected: String,
    },
    /// A task's name is not `task_variant`; it is used as it is.
    TaskName {
        /// The name.
        found: String,
    },
}

impl fmt::Display for LogWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoScenarioInfo => f.write_str("scenario_info.json: found no such file; read without it"),
            Self::ScenarioInfo { field, found, expected } => {
                write!(
                    f,
                    "scenario_info.json, {field}: found {found}, expected one of {expected}; left out"
                )
            }
            Self::TaskName { found } => {
                let found = shown(found);
                write!(
                    f,
                    "task_name: found {found}, expected TASK_VARIANT, letters and digits on both sides; used as it is"
                )
            }
        }
    }
}

/// A log as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    /// Name of the log's directory.
    pub run_id: String,
    /// Which columns are metrics.
    pub logger_info: LoggerInfo,
    /// What the run was about.
    pub scenario_info: ScenarioInfo,
    /// All rows of all workers, by experience number, then block number, then the order of files and lines.
    pub records: Vec<Record>,
    /// What was odd about it.
    pub warnings: Vec<LogWarning>,
}

/// Reads the log in a directory: format 1.0 or 1.1, written by us or by l2logger, by one worker or by several.
///
/// # Errors
/// One of [`MetricsError`]'s reading variants, each naming file, line and column where there are such. Never panics,
/// whatever the files hold; at most [`MAX_RECORDS`] rows, [`MAX_LOG_FILES`](crate::MAX_LOG_FILES) files and
/// [`MAX_FILE_BYTES`](crate::MAX_FILE_BYTES) per file are read.
pub fn read_log(dir: impl AsRef<Path>) -> Result<Log, MetricsError> {
    let dir = dir.as_ref();
    let files = data_files::find(dir)?;
    let logger_info = LoggerInfo::read(dir)?;
    let mut warnings = Vec::new();
    let scenario_info = ScenarioInfo::read(dir, &mut warnings)?;
    if files.is_empty() {
        return Err(MetricsError::NoDataFiles { path: dir.to_owned() });
    }
    let mut rows: Vec<Row> = Vec::new();
    let mut params = ParamsReader::default();
    for (file, path) in files.iter().enumerate() {
        data_file::read(path, logger_info.metrics_columns(), &mut params, |record, line| {
            if rows.len() == MAX_RECORDS {
                let (found, limit) = (MAX_RECORDS as u64 + 1, MAX_RECORDS as u64);
                return Err(MetricsError::TooLarge {
                    path: dir.to_owned(),
                    what: "rows or more",
                    found,
                    limit,
                });
            }
            rows.push(Row { record, file, line });
            Ok(())
        })?;
    }
    rows.sort_by_key(|row| (row.record.exp_num, row.record.block_num));
    check_block_order(&rows, &files)?;
    warn_of_task_names(&rows, &mut warnings);
    let records = rows.into_iter().map(|row| row.record).collect();
    Ok(Log {
        run_id: run_id(dir),
        logger_info,
        scenario_info,
        records,
        warnings,
    })
}

/// Reads the log of a single-task expert, the yardstick of `ste_rel_perf` and `sample_efficiency`.
///
/// # Errors
/// Those of [`read_log`], and [`MetricsError::NotSingleTask`] when it does not train exactly one task.
pub fn read_ste_log(dir: impl AsRef<Path>) -> Result<SteLog, MetricsError> {
    SteLog::new(read_log(dir)?)
}

/// A record and where it came from.
struct Row {
    record: Record,
    file: usize,
    line: u64,
}

fn check_block_order(rows: &[Row], files: &[std::path::PathBuf]) -> Result<(), MetricsError> {
    match rows
        .windows(2)
        .find(|pair| pair[1].record.block_num < pair[0].record.block_num)
    {
        Some(pair) => Err(MetricsError::BlockOrder {
            path: files[pair[1].file].clone(),
            line: pair[1].line,
            found: pair[1].record.block_num,
            expected: pair[0].record.block_num,
        }),
        None => Ok(()),
    }
}

fn warn_of_task_names(rows: &[Row], warnings: &mut Vec<LogWarning>) {
    let names: IndexSet<&str> = rows.iter().map(|row| row.record.task_name.as_str()).collect();
    let odd = names.into_iter().filter(|name| !is_conventional_task_name(name));
    warnings.extend(odd.map(|name| LogWarning::TaskName { found: name.to_owned() }));
}

/// The directory's own name; where the path ends in `..` or is `.`, the name it stands for if there is one.
fn run_id(dir: &Path) -> String {
    let name = dir.file_name().map(ToOwned::to_owned);
    let name = name.or_else(|| dir.canonicalize().ok()?.file_name().map(ToOwned::to_owned));
    name.unwrap_or_default().to_string_lossy().into_owned()
}
