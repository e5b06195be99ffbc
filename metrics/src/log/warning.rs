//! Irregularities of a log that can still be read.

use std::path::PathBuf;

use driftworld_text::{ShownPath, one_line};

use super::cell::shown;
use super::timestamp::Timestamp;
use crate::LogLine;

/// An irregularity of a log that can still be read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LogWarning {
    /// A broken rule of the format that does not affect scores, with the text of the [`MetricsError`](crate::MetricsError) that
    /// validation lists.
    #[error("{0}; scored as it is")]
    Breach(String),
    /// There is no `scenario_info.json`.
    #[error("scenario_info.json: found no such file; read without it")]
    NoScenarioInfo,
    /// A field of `scenario_info.json` is not an accepted word; it was dropped.
    #[error("scenario_info.json, {field}: found {found}, expected one of {expected}; left out", found = one_line(found))]
    ScenarioInfo {
        /// The field.
        field: &'static str,
        /// Its value, as JSON.
        found: String,
        /// The accepted words.
        expected: String,
    },
    /// The version in `logger_info.json` contradicts the columns; the columns take precedence.
    #[error("{}:1: found {} block_subtype, expected {} in a log of format {}; {}", path.shown(), if *has_subtype { "the column" } else { "no column" }, if *has_subtype { "none" } else { "one" }, one_line(version), if *has_subtype { "used as is" } else { "read as wake" })]
    Version {
        /// The first data file.
        path: PathBuf,
        /// The version, `1.0` or `1.1`.
        version: String,
        /// Whether there is the column `block_subtype`, which came with 1.1.
        has_subtype: bool,
    },
    /// A time stamp is earlier than the one in the row above.
    #[error("{at}, column timestamp: found {found}, expected at least {before} as in the row above; kept")]
    TimeRunsBack {
        /// File and line; the first such line of the file.
        at: LogLine,
        /// The time stamp.
        found: Timestamp,
        /// The time stamp above.
        before: Timestamp,
    },
    /// A row is in the folder of another worker or block; its own fields take precedence.
    #[error("{at}: found a misplaced row, expected it in {}; kept", one_line(expected))]
    OtherFolder {
        /// File and line; the first such line of the file.
        at: LogLine,
        /// The folder it should be in, as `WORKER/BLOCKNUM-BLOCKTYPE`.
        expected: String,
    },
    /// A worker's last experience has no complete row: the run was stopped, or is still running.
    #[error(
        "{at}: found experience {exp_num} without a complete row, the last of its worker; ignored until it has one"
    )]
    Unfinished {
        /// File and line of the experience's first row.
        at: LogLine,
        /// Number of the experience.
        exp_num: u64,
    },
    /// The log of one of our own scenarios ends before the scenario does: the run was stopped, or is still running.
    #[error("the log ends after {done} of the {planned} experiences of its scenario; scored as far as it goes")]
    EndsEarly {
        /// The number of its last experience, plus one.
        done: u64,
        /// Number of experiences of the scenario.
        planned: u64,
    },
    /// Experience numbers are missing; rows may have been lost.
    #[error("{at}: found experience {after} after {before}, expected {}; numbers without a row: {missing}", before + 1)]
    Missing {
        /// File and line of the row after the first gap.
        at: LogLine,
        /// The number before the first gap.
        before: u64,
        /// The number after it.
        after: u64,
        /// Number of missing numbers in total.
        missing: u64,
    },
    /// A metrics column contains no number.
    #[error(
        "column {}: found no number in any row, expected at least one; it cannot be scored",
        one_line(column)
    )]
    NoNumbers {
        /// The column.
        column: String,
    },
    /// A task's name is not `task_variant`; it is used as is.
    #[error(
        "task_name: found {}, expected TASK_VARIANT, with letters and digits on both sides; used as is",
        shown(found)
    )]
    TaskName {
        /// The name.
        found: String,
    },
}
