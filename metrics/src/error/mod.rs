//! The error type of this crate: everything that can be wrong with a log, a record or the options.
//!
//! Longer than 400 lines, because it is one enum, with a message and fields for each mistake.

mod code;

use std::fmt;
use std::io;
use std::path::PathBuf;

use driftworld_text::{ShownPath, counted, one_line};

/// A line of a data file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LogLine {
    /// The file.
    pub path: PathBuf,
    /// From 1; 0 if unknown.
    pub line: u64,
}

impl fmt::Display for LogLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.path.shown(), self.line)
    }
}

/// Everything that can stop a log from being written or read, or metrics from being computed.
///
/// Every message states where the problem is, what was found, what was expected, and what to do if that is not obvious.
#[derive(Debug, thiserror::Error, strum::IntoStaticStr, strum::VariantNames)]
#[strum(prefix = "metrics/", serialize_all = "kebab-case")]
#[non_exhaustive]
pub enum MetricsError {
    /// The file system failed.
    #[error("{}: cannot {doing}: {source}", path.shown(), source = one_line(source))]
    Io {
        /// File or directory concerned.
        path: PathBuf,
        /// The operation, as in "cannot …".
        doing: &'static str,
        /// The operating system's error.
        source: io::Error,
    },

    /// The directory for a new log is not empty.
    #[error(
        "{}: found a directory that is not empty, expected a new or an empty one; choose another name, or continue \
         its log with LogWriter::resume",
        .0.shown()
    )]
    LogExists(PathBuf),

    /// Another writer is using the log.
    #[error(
        "{}: found a log that another run is writing, expected one not in use; wait for that run, or choose another \
         name",
        .0.shown()
    )]
    InUse(PathBuf),

    /// The directory of a log disappeared while the log was being written.
    #[error(
        "{}: found {found}, expected the directory of this log: it was removed, renamed or replaced during the run, \
         and with it {} in {bytes} bytes; put it back and continue the log, or start a new \
         one", path.shown(), counted(*rows as usize, "row")
    )]
    FolderLost {
        /// The directory.
        path: PathBuf,
        /// "no directory", "another directory" or "a file".
        found: &'static str,
        /// Rows that were in it.
        rows: u64,
        /// Bytes of its data files.
        bytes: u64,
    },

    /// A data file of a log was truncated, removed or replaced while the log was being written.
    #[error(
        "{}: found {found}, expected the {} in {bytes} bytes that were written: it was truncated, removed or replaced \
         during the run; put it back and continue the log, or start a new one; a log that lacks only its last rows \
         can be continued as it is",
        path.shown(), counted(*rows as usize, "row")
    )]
    FileLost {
        /// The data file.
        path: PathBuf,
        /// "no file", "another file", "a directory", or the rows and bytes found.
        found: String,
        /// Rows that were written.
        rows: u64,
        /// Bytes that were written, including the header.
        bytes: u64,
    },

    /// An info file of a log was overwritten while the log was being written.
    #[error(
        "{}: found {found} bytes, expected the {expected} bytes that this log was started with; put the file back: \
         without it, the rows cannot be read",
        path.shown()
    )]
    InfoFileChanged {
        /// The info file.
        path: PathBuf,
        /// Bytes found.
        found: u64,
        /// Bytes that were written.
        expected: u64,
    },

    /// The log directory does not exist.
    #[error(
        "{}: found {found}, expected the directory of a log, which holds logger_info.json",
        path.shown()
    )]
    NotADirectory {
        /// The given path.
        path: PathBuf,
        /// "nothing" or "a file".
        found: &'static str,
    },

    /// A log directory has no data file.
    #[error(
        "{}: found no data-log.tsv, expected at least one as WORKER/BLOCKNUM-BLOCKTYPE/data-log.tsv; \
         is this the directory of one log, and has its run begun?",
        .0.shown()
    )]
    NoDataFiles(PathBuf),

    /// A side file of the log is missing.
    #[error("{}: found no such file, expected {expected}", path.shown())]
    MissingFile {
        /// The file.
        path: PathBuf,
        /// Its expected contents.
        expected: &'static str,
    },

    /// A path of the log is not a regular file.
    #[error(
        "{}: found {found}, expected a file; put the file in its place, or remove it",
        path.shown()
    )]
    NotAFile {
        /// The path.
        path: PathBuf,
        /// What the path is instead: "a directory", "a named pipe", "a link that leads nowhere" and so on.
        found: &'static str,
    },

    /// A side file is not JSON, or not the JSON that was expected.
    #[error("{}:{line}:{column}: {wrong}", path.shown(), wrong = one_line(wrong))]
    Json {
        /// The file.
        path: PathBuf,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
        /// The fault.
        wrong: String,
    },

    /// A field of `logger_info.json`, or of the [`LoggerInfo`](crate::LoggerInfo) to be written there, is wrong.
    #[error("logger_info.json, {field}: found {found}, expected {expected}", found = one_line(found))]
    LoggerInfo {
        /// The field.
        field: &'static str,
        /// Its value.
        found: String,
        /// What is allowed.
        expected: &'static str,
    },

    /// A limit of this crate was exceeded; limits keep a broken log from using up all memory.
    #[error("{}: found {found} {what}, expected at most {limit}", path.shown())]
    TooLarge {
        /// The file or directory.
        path: PathBuf,
        /// The thing counted.
        what: &'static str,
        /// The number found.
        found: u64,
        /// The largest allowed.
        limit: u64,
    },

    /// A data file has no header line.
    #[error(
        "{}:1: found an empty file, expected a header line that begins with block_num",
        .0.shown()
    )]
    EmptyFile(PathBuf),

    /// A data file starts with a row instead of its header.
    #[error(
        "{}:1: found {found:?}, which has none of the standard columns, expected a header line that begins with \
         block_num",
        path.shown()
    )]
    NoHeader {
        /// The data file.
        path: PathBuf,
        /// Its first line, cut after 60 characters.
        found: String,
    },

    /// A data file's header is a single cell: its columns are not separated by tabs.
    #[error("{}:1: found the header {found} without a tab, expected a tab between \
         columns", path.shown(), found = one_line(found))]
    NoTabs {
        /// The data file.
        path: PathBuf,
        /// Its header, cut after 60 characters.
        found: String,
    },

    /// A data file lacks a column.
    #[error("{}:1: found the columns {found}, expected {column} as well", path.shown(), column = one_line(column), found = one_line(found))]
    MissingColumn {
        /// The data file.
        path: PathBuf,
        /// The missing column.
        column: String,
        /// The columns found, comma separated.
        found: String,
    },

    /// A data file has two columns of the same name.
    #[error("{}:1: found the column {column} twice, expected every column \
         once", path.shown(), column = one_line(column))]
    RepeatedColumn {
        /// The data file.
        path: PathBuf,
        /// The column.
        column: String,
    },

    /// A data file of a log to be resumed has different columns from the next record.
    #[error(
        "{}:1: found the columns {found}, expected {expected} to continue this log; \
         only logs of format 1.1 written by one writer can be continued; start a new one", path.shown(),
        found = one_line(found),
        expected = one_line(expected)
    )]
    OtherColumns {
        /// The data file.
        path: PathBuf,
        /// Its columns, comma separated.
        found: String,
        /// The expected columns, comma separated.
        expected: String,
    },

    /// A row has more or fewer cells than the header.
    #[error("{at}: found {found} cells, expected {expected} as in the header; is a tab or a quote missing?")]
    RaggedRow {
        /// File and line.
        at: LogLine,
        /// Cells in the row.
        found: usize,
        /// Cells in the header.
        expected: usize,
    },

    /// A cell does not fit its column.
    #[error("{at}, column {column}: found {found}, expected \
         {expected}", column = one_line(column), found = one_line(found), expected = one_line(expected))]
    Cell {
        /// File and line.
        at: LogLine,
        /// Name of the column.
        column: String,
        /// The cell's text, cut after 60 characters.
        found: String,
        /// The expected contents.
        expected: String,
    },

    /// The last line of a data file has no line ending: its writer was stopped in the middle of a row.
    #[error(
        "{0}: found a last line without a line ending, expected complete rows; its writer was interrupted, or \
         an editor omitted the line ending: add one if the line is complete; otherwise delete the line, or continue the \
         log, which deletes it (`driftworld run … --resume`, LogWriter::resume)"
    )]
    TornLastLine(LogLine),

    /// Lines of a data file end with a carriage return only.
    #[error(
        "{0}: found lines that end in a lone carriage return, expected LF or CRLF; save the file with such line endings"
    )]
    CarriageReturns(LogLine),

    /// A quote in a data file is never closed, so it swallows the rows after it.
    #[error(
        "{0}: found a quote that opens a cell and is never closed, expected a closing quote at the end of the cell; \
         the rows after it were read as part of the cell"
    )]
    OpenQuote(LogLine),

    /// A data file is not valid UTF-8.
    #[error("{0}: found bytes that are not UTF-8, expected text")]
    NotUtf8(LogLine),

    /// Block numbers decrease while experience numbers increase.
    #[error(
        "{at}, column block_num: found {found}, expected at least {expected}: \
         in order of exp_num, block numbers never decrease"
    )]
    BlockOrder {
        /// File and line.
        at: LogLine,
        /// The block number there.
        found: u64,
        /// The largest block number of an earlier experience.
        expected: u64,
    },

    /// A number decreases from one row of a data file to the next.
    #[error(
        "{at}, column {column}: found {found}, expected at least {expected} as in the row above: numbers never decrease"
    )]
    NumberFalls {
        /// File and line.
        at: LogLine,
        /// `block_num` or `exp_num`.
        column: &'static str,
        /// The number found.
        found: u64,
        /// The number in the row above.
        expected: u64,
    },

    /// Two data files of one log have different columns.
    #[error(
        "{}:1: found the columns {found}, expected {expected} as in {}", path.shown(), first.shown(),
        found = one_line(found),
        expected = one_line(expected)
    )]
    ColumnsDiffer {
        /// The data file.
        path: PathBuf,
        /// Its columns, comma separated.
        found: String,
        /// Those of the first file, comma separated.
        expected: String,
        /// The first file.
        first: PathBuf,
    },

    /// An experience has no complete row, although its worker continued with the next.
    #[error(
        "{at}: found experience {exp_num} of {worker} without a complete row, expected exactly one: \
         it is not scored",
        worker = one_line(worker)
    )]
    NotCompleted {
        /// File and line of the experience's first row.
        at: LogLine,
        /// Number of the experience.
        exp_num: u64,
        /// Its worker.
        worker: String,
    },

    /// An experience continues after its complete row.
    #[error(
        "{at}: found another row of experience {exp_num} of {worker} after its complete one, expected the \
         complete row to be the last: give the next experience a new number",
        worker = one_line(worker)
    )]
    RowAfterComplete {
        /// File and line.
        at: LogLine,
        /// Number of the experience.
        exp_num: u64,
        /// Its worker.
        worker: String,
    },

    /// A record to be written breaks a rule of the format.
    #[error("record of experience {exp_num}, {field}: found {found}, expected \
         {expected}", field = one_line(field), found = one_line(found), expected = one_line(expected))]
    Record {
        /// Experience number of the record.
        exp_num: u64,
        /// Field that breaks the rule.
        field: String,
        /// Its value.
        found: String,
        /// The rule.
        expected: String,
    },

    /// A time stamp is not of the form `20200913T122640.000000`.
    #[error(
        "timestamp: found {}, expected YYYYMMDDTHHMMSS.ffffff with a valid date, as in 20200913T122640.000000",
        one_line(.0)
    )]
    Timestamp(String),

    /// An unknown word.
    #[error("{what}: found {found:?}, expected one of {expected}", expected = one_line(expected))]
    UnknownWord {
        /// The kind of thing that the word chooses.
        what: &'static str,
        /// The word.
        found: String,
        /// The accepted words, comma separated.
        expected: String,
    },

    /// A log has a column whose name is reserved in the table of several logs.
    #[error(
        "log {run_id}: found a column {column} of its own, expected another name: a table of logs has a column of \
         that name; \
         rename it in the log's files and in logger_info.json",
        run_id = one_line(run_id),
        column = one_line(column)
    )]
    TableColumn {
        /// Name of the log.
        run_id: String,
        /// The column.
        column: String,
    },

    /// The log has no such performance column.
    #[error("log {run_id}: found no metrics column {column:?}, expected one of \
         {available}", run_id = one_line(run_id), available = one_line(available))]
    UnknownColumn {
        /// Name of the log.
        run_id: String,
        /// The column asked for.
        column: String,
        /// The log's declared columns, comma separated.
        available: String,
    },

    /// No row remains after dropping incomplete rows and rows without a number.
    #[error("log {run_id}: found no complete row with a number in column {column:?}, expected at least \
         one", run_id = one_line(run_id))]
    NoUsableRows {
        /// Name of the log.
        run_id: String,
        /// The performance column.
        column: String,
    },

    /// The log of a single-task expert trains no task, or several.
    #[error("single-task expert log {run_id}: found {found}, expected exactly one trained task; give \
         one log per task, or compare with an agent that ran the same blocks (--against), or with floors and \
         ceilings (--scales)", run_id = one_line(run_id), found = one_line(found))]
    NotSingleTask {
        /// Name of the log.
        run_id: String,
        /// "no trained task", or the tasks, comma separated.
        found: String,
    },

    /// A data folder for single-task experts is missing, or is not a folder of experts.
    #[error(
        "{}: found {found}, expected a folder of single-task experts as TASK/RUN/logger_info.json; \
         store an expert's log there first",
        path.shown()
    )]
    NoSteData {
        /// The given path.
        path: PathBuf,
        /// "nothing", "a file" or "a log".
        found: &'static str,
    },

    /// A data folder holds experts in a format that is never read.
    #[error(
        "{}: found a pickle of l2metrics, expected folders of logs: reading a pickle can run code; store the original \
         logs instead, and remove the pickle from this folder",
        .0.shown()
    )]
    StePickle(PathBuf),

    /// A lifetime has too many regimes.
    #[error("log {run_id}: found more than {limit} regimes, expected at most that many; do tasks alternate row by \
         row?", run_id = one_line(run_id))]
    TooManyRegimes {
        /// Name of the log.
        run_id: String,
        /// The limit.
        limit: usize,
    },

    /// A performance is so large that sums would overflow.
    #[error(
        "log {run_id}, task {task}: found a performance of {found:e} {after}, expected less than 1e100 in magnitude",
        run_id = one_line(run_id),
        task = one_line(task)
    )]
    PerformanceOutOfRange {
        /// Name of the log.
        run_id: String,
        /// The task.
        task: String,
        /// The value.
        found: f64,
        /// "as logged" or "after preprocessing".
        after: &'static str,
    },

    /// A user-defined metric failed.
    #[error("metric {metric}, log {run_id}: {source}", metric = one_line(metric), run_id = one_line(run_id), source = one_line(source))]
    Metric {
        /// Name of the metric.
        metric: String,
        /// Name of the log.
        run_id: String,
        /// Its error.
        source: Box<dyn std::error::Error + Send + Sync>,
    },

    /// Scores of repeated runs, or a request about them, are invalid.
    #[error("scores, {place}: found {found}, expected {expected}", place = one_line(place), found = one_line(found), expected = one_line(expected))]
    Scores {
        /// The place: a run, a stratum of a run, or the table as a whole.
        place: String,
        /// The value found.
        found: String,
        /// The allowed values.
        expected: String,
    },

    /// The value of an option is invalid.
    #[error("option {option}: found {found}, expected {expected}", found = one_line(found), expected = one_line(expected))]
    BadOption {
        /// The option.
        option: &'static str,
        /// Its value.
        found: String,
        /// The allowed values.
        expected: String,
    },
}

impl MetricsError {
    /// Adds the path and the operation to an operating system's error.
    pub(crate) fn io(path: impl Into<PathBuf>, doing: &'static str) -> impl FnOnce(io::Error) -> Self {
        let path = path.into();
        move |source| Self::Io { path, doing, source }
    }

    pub(crate) fn logger_info(field: &'static str, found: String, expected: &'static str) -> Self {
        Self::LoggerInfo { field, found, expected }
    }

    pub(crate) fn missing_file(path: impl Into<PathBuf>, expected: &'static str) -> Self {
        let path = path.into();
        Self::MissingFile { path, expected }
    }

    pub(crate) fn too_large(path: impl Into<PathBuf>, what: &'static str, found: u64, limit: u64) -> Self {
        let path = path.into();
        Self::TooLarge {
            path,
            what,
            found,
            limit,
        }
    }

    pub(crate) fn bad_option(option: &'static str, found: impl Into<String>, expected: impl Into<String>) -> Self {
        let (found, expected) = (found.into(), expected.into());
        Self::BadOption {
            option,
            found,
            expected,
        }
    }
}
