//! A whole log: its two info files and the rows of all its workers, in order.
//!
//! Not here: how one data file is read, see `data_file`; every fault of a log at once, see `validation`.

use std::path::{Path, PathBuf};

use super::faults::Faults;
use super::logger_info::LoggerInfo;
use super::record::is_conventional_task_name;
use super::rows::Rows;
use super::scenario_info::ScenarioInfo;
use super::table::{Table, Texts};
use super::warning::LogWarning;
use super::{data_file, data_files};
use crate::MetricsError;

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
    pub rows: Rows,
    /// What was odd about it.
    pub warnings: Vec<LogWarning>,
}

/// Reads the log in a directory: format 1.0 or 1.1, written by us or by l2logger, by one worker or by several.
///
/// Columns of words that `logger_info.json` does not declare are left out; see [`read_log_with_texts`]. Data files may be links, and so
/// may the directories of workers and blocks.
///
/// # Errors
/// One of [`MetricsError`]'s reading variants, each naming file, line and column where there are such. Never panics,
/// whatever the files hold; at most [`MAX_RECORDS`](crate::MAX_RECORDS) rows of [`MAX_COLUMNS`](crate::MAX_COLUMNS)
/// columns, [`MAX_LOG_FILES`](crate::MAX_LOG_FILES) files and [`MAX_FILE_BYTES`](crate::MAX_FILE_BYTES) per file are read.
pub fn read_log(dir: impl AsRef<Path>) -> Result<Log, MetricsError> {
    read(dir.as_ref(), Texts::Leave)
}

/// The same with all columns, so that nothing of a log is lost: those of words that nobody declared are in
/// [`Rows::text`], too.
///
/// # Errors
/// Those of [`read_log`].
pub fn read_log_with_texts(dir: impl AsRef<Path>) -> Result<Log, MetricsError> {
    read(dir.as_ref(), Texts::Keep)
}

fn read(dir: &Path, texts: Texts) -> Result<Log, MetricsError> {
    let files = data_files::find(dir)?;
    let logger_info = LoggerInfo::read(dir)?;
    let mut warnings = Vec::new();
    let scenario_info = ScenarioInfo::read(dir, &mut warnings)?;
    if files.is_empty() {
        return Err(MetricsError::NoDataFiles(dir.to_owned()));
    }
    let mut table = Table::new(dir, logger_info.metrics_columns(), texts);
    for path in &files {
        data_file::read(path, logger_info.metrics_columns(), &mut table, &mut Faults::Stop)?;
    }
    table.complete()?;
    let order = table.rows.sort();
    if let Some(fault) = block_order(&table, order.as_deref(), &files) {
        return Err(fault);
    }
    warn_of_task_names(&table.rows, |warning| warnings.push(warning));
    Ok(Log {
        run_id: run_id(dir),
        logger_info,
        scenario_info,
        rows: table.rows,
        warnings,
    })
}

/// The fault of block numbers that fall while experience numbers rise, in a table that was sorted: `order` is where its rows
/// were before.
pub(super) fn block_order(table: &Table<'_>, order: Option<&[u32]>, files: &[PathBuf]) -> Option<MetricsError> {
    let blocks = table.rows.block_nums();
    let row = (1..blocks.len()).find(|&row| blocks[row] < blocks[row - 1])?;
    let (file, line) = table.place(order.map_or(row, |order| order[row] as usize));
    Some(MetricsError::BlockOrder {
        path: files[file].clone(),
        line,
        found: blocks[row],
        expected: blocks[row - 1],
    })
}

/// Warns of each odd name once, in the order of the rows.
pub(super) fn warn_of_task_names(rows: &Rows, mut warn: impl FnMut(LogWarning)) {
    let names = rows.task_names();
    let mut odd: Vec<bool> = names
        .values()
        .iter()
        .map(|name| !is_conventional_task_name(name))
        .collect();
    if odd.contains(&true) {
        for &id in names.ids() {
            if std::mem::take(&mut odd[id as usize]) {
                let found = names.values()[id as usize].clone();
                warn(LogWarning::TaskName { found });
            }
        }
    }
}

/// The directory's own name; where the path ends in `..` or is `.`, the name it stands for if there is one.
fn run_id(dir: &Path) -> String {
    let name = dir.file_name().map(ToOwned::to_owned);
    let name = name.or_else(|| dir.canonicalize().ok()?.file_name().map(ToOwned::to_owned));
    name.unwrap_or_default().to_string_lossy().into_owned()
}
