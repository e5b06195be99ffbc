//! What is odd about a log, but does not keep it from being read.
//!
//! Not here: what does, see `MetricsError`.

use std::path::PathBuf;

use driftworld_text::{ShownPath, one_line};

use super::cell::shown;
use super::timestamp::Timestamp;
use crate::LogLine;

/// Something about a log that is not as it should be, but does not keep it from being read.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum LogWarning {
    /// A rule of the format was broken that scores do not depend on; the words are those of the
    /// [`MetricsError`](crate::MetricsError) that validating lists.
    #[error("{0}; scored as it is")]
    Breach(String),
    /// There is no `scenario_info.json`.
    #[error("scenario_info.json: found no such file; read without it")]
    NoScenarioInfo,
    /// A field of `scenario_info.json` is none of the words it may be; it was left out.
    #[error("scenario_info.json, {field}: found {found}, expected one of {expected}; left out", found = one_line(found))]
    ScenarioInfo {
        /// The field.
        field: &'static str,
        /// Its value, as JSON.
        found: String,
        /// The words it may be.
        expected: String,
    },
    /// The version that `logger_info.json` names and the columns do not go together; the columns count.
    #[error("{}:1: found {} block_subtype, expected {} in a log of format {}; {}", path.shown(), if *has_subtype { "the column" } else { "no column" }, if *has_subtype { "none" } else { "one" }, one_line(version), if *has_subtype { "it counts" } else { "read as wake" })]
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
        /// The one above.
        before: Timestamp,
    },
    /// A row lies in the folder of another worker or block; it is read as it says.
    #[error("{at}: found a row of another folder, expected it in {}; kept", one_line(expected))]
    OtherFolder {
        /// File and line; the first such line of the file.
        at: LogLine,
        /// The folder it should lie in, as `WORKER/BLOCKNUM-BLOCKTYPE`.
        expected: String,
    },
    /// A worker's last experience has no complete row: the run was stopped, or goes on.
    #[error(
        "{at}: found experience {exp_num} without a complete row, the last of its worker; ignored until it has one"
    )]
    Unfinished {
        /// File and line of the experience's first row.
        at: LogLine,
        /// Number of the experience.
        exp_num: u64,
    },
    /// Experiences whose numbers no row has: rows may have been lost.
    #[error("{at}: found experience {after} after {before}, expected {}; numbers without a row: {missing}", before + 1)]
    Missing {
        /// File and line of the row behind the first gap.
        at: LogLine,
        /// The number before the first gap.
        before: u64,
        /// The number behind it.
        after: u64,
        /// How many numbers all gaps leave out.
        missing: u64,
    },
    /// A metrics column without a single number.
    #[error(
        "column {}: found no number in any row, expected at least one; it cannot be scored",
        one_line(column)
    )]
    NoNumbers {
        /// The column.
        column: String,
    },
    /// A task's name is not `task_variant`; it is used as it is.
    #[error(
        "task_name: found {}, expected TASK_VARIANT, with letters and digits on both sides; used as is",
        shown(found)
    )]
    TaskName {
        /// The name.
        found: String,
    },
}
