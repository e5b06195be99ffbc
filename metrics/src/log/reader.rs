//! Reads a whole log: its two info files and the rows of all its workers, in order.

use std::path::Path;

use super::faults::Faults;
use super::logger_info::LoggerInfo;
use super::rows::Rows;
use super::scenario_info::ScenarioInfo;
use super::table::Texts;
use super::validation::Check;
use super::warning::LogWarning;
use crate::MetricsError;

/// A log, read from its directory.
#[derive(Debug, Clone, PartialEq)]
pub struct Log {
    /// Name of the log's directory.
    pub run_id: String,
    /// The metrics columns.
    pub logger_info: LoggerInfo,
    /// The description of the run.
    pub scenario_info: ScenarioInfo,
    /// All rows of all workers, by experience number, then block number, then the order of files and lines.
    pub rows: Rows,
    /// Irregularities found while reading.
    pub warnings: Vec<LogWarning>,
}

/// Reads the log in a directory: format 1.0 or 1.1, written by us or by l2logger, by one worker or several. The rules are those of
/// [`validate_log`](crate::validate_log), which lists every fault; here, faults that do not affect scores are warnings.
///
/// Text columns that `logger_info.json` does not declare are left out; see [`read_log_with_texts`]. Data files may be links,
/// and so may the directories of workers and blocks.
///
/// # Errors
/// The first fault, with file, line and column if known. Never panics, whatever the files contain; reads at most
/// [`MAX_RECORDS`](crate::MAX_RECORDS) rows of [`MAX_COLUMNS`](crate::MAX_COLUMNS) columns,
/// [`MAX_LOG_FILES`](crate::MAX_LOG_FILES) files and [`MAX_FILE_BYTES`](crate::MAX_FILE_BYTES) per file.
pub fn read_log(dir: impl AsRef<Path>) -> Result<Log, MetricsError> {
    read(dir.as_ref(), Texts::Leave)
}

/// Like [`read_log`], but lossless: undeclared text columns are also read, into [`Rows::text`].
///
/// # Errors
/// Those of [`read_log`].
pub fn read_log_with_texts(dir: impl AsRef<Path>) -> Result<Log, MetricsError> {
    read(dir.as_ref(), Texts::Keep)
}

fn read(dir: &Path, texts: Texts) -> Result<Log, MetricsError> {
    let mut check = Check::new(Faults::Stop);
    let (logger_info, scenario_info, rows) = check.all(dir, texts)?;
    Ok(Log {
        run_id: run_id(dir),
        logger_info,
        scenario_info,
        rows,
        warnings: check.warnings.first,
    })
}

/// The directory's own name. If the path ends in `..` or is `.`, the name of the directory that it resolves to; empty if there is
/// none.
fn run_id(dir: &Path) -> String {
    let name = dir.file_name().map(ToOwned::to_owned);
    let name = name.or_else(|| dir.canonicalize().ok()?.file_name().map(ToOwned::to_owned));
    name.unwrap_or_default().to_string_lossy().into_owned()
}
