//! Experience logs on disk, format 1.1 of l2logger: what a record is, how it is written, how it is read.
//!
//! Not here: what the numbers mean; that is `lifetime` and `score`.

mod begun;
mod cell;
mod columns;
mod data_file;
mod data_files;
mod json_file;
mod logger_info;
mod reader;
mod record;
mod resume;
mod scenario_info;
mod spaced_json;
mod timestamp;
mod writer;

pub use begun::begun_log;
pub use data_file::{MAX_CELL_BYTES, MAX_FILE_BYTES};
pub use data_files::MAX_LOG_FILES;
pub use logger_info::{LOG_FORMAT_VERSION, LoggerInfo};
pub use reader::{Log, LogWarning, MAX_RECORDS, read_log, read_ste_log};
pub use record::{BlockSubtype, BlockType, DEFAULT_WORKER, ExpStatus, Record, TaskParams};
pub use scenario_info::{Complexity, Difficulty, ScenarioInfo, ScenarioType};
pub use timestamp::Timestamp;
pub use writer::LogWriter;

pub(crate) use columns::line;
pub(crate) use json_file::{write_json, write_whole};
pub(crate) use spaced_json::spaced_json;
