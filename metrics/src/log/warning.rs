//! What is odd about a log, but does not keep it from being read.
//!
//! Not here: what does, see `MetricsError`.

use std::fmt;

use super::cell::shown;

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
