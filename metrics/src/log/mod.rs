//! Experience logs on disk, format 1.1 of l2logger: what a record is, how it is written, how it is read.
//!
//! Not here: what the numbers mean; that is `lifetime` and `score`.

mod aggregate;
mod begun;
mod block_file;
mod cell;
mod columns;
mod data_file;
mod data_files;
mod faults;
mod folder_name;
mod header;
mod identity;
mod json_file;
mod log_folder;
mod logger_info;
mod reader;
mod record;
mod regular_file;
mod resume;
mod rows;
mod scenario_info;
mod shared_column;
mod spaced_json;
mod ste_folder;
mod ste_store;
mod table;
mod timestamp;
mod validation;
mod warning;
mod whole_rows;
mod writer;

pub use aggregate::{Delimiter, KeptRows, LogTable};
pub use begun::begun_log;
pub use data_file::{MAX_CELL_BYTES, MAX_FILE_BYTES};
pub use data_files::MAX_LOG_FILES;
pub use faults::MAX_LISTED;
pub use json_file::{MAX_JSON_BYTES, MAX_JSON_VALUES};
pub use logger_info::{LOG_FORMAT_VERSION, LoggerInfo};
pub use reader::{Log, read_log, read_log_with_texts};
pub use record::{BlockSubtype, BlockType, DEFAULT_WORKER, ExpStatus, Record, TaskParams};
pub use rows::{Row, Rows};
pub use scenario_info::{Complexity, Difficulty, ScenarioInfo, ScenarioType};
pub use shared_column::SharedColumn;
pub use ste_store::{SteStoreMode, StoredRun, StoredTask, find_ste, store_ste};
pub use table::{MAX_CELLS, MAX_COLUMNS, MAX_RECORDS};
pub use timestamp::Timestamp;
pub use validation::{LogCounts, Validation, validate_log};
pub use warning::LogWarning;
pub use writer::LogWriter;

pub(crate) use columns::line;
pub(crate) use json_file::{write_json, write_whole};
pub(crate) use spaced_json::spaced_json;
