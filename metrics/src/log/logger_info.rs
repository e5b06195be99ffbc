//! `logger_info.json`: the metrics columns of a log, and the version of its format.

use std::collections::BTreeSet;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::cell::cut;
use super::columns::STANDARD_COLUMNS;
use super::json_file;
use super::table::MAX_COLUMNS;
use crate::MetricsError;

/// The version of the log format that is written. Version 1.0 can also be read.
pub const LOG_FORMAT_VERSION: &str = "1.1";

pub(super) const FILE_NAME: &str = "logger_info.json";
const EXPECTED_FILE: &str = "a JSON object with the list metrics_columns";
const EXPECTED_COLUMNS: &str = "a list of at least one name, without duplicates or standard columns";

/// The metrics columns of a log.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct LoggerInfo {
    metrics_columns: Vec<String>,
    log_format_version: String,
}

impl LoggerInfo {
    /// Info for a new log with these metrics columns.
    ///
    /// # Errors
    /// [`MetricsError::LoggerInfo`] for an empty list, an empty name, a repeated name, or the name of a standard column.
    pub fn new(metrics_columns: impl IntoIterator<Item = impl Into<String>>) -> Result<Self, MetricsError> {
        let metrics_columns: Vec<String> = metrics_columns.into_iter().map(Into::into).collect();
        check_columns(&metrics_columns)?;
        Ok(Self {
            metrics_columns,
            log_format_version: LOG_FORMAT_VERSION.to_owned(),
        })
    }

    /// Names of the metrics columns, in the order in which they were declared.
    pub fn metrics_columns(&self) -> &[String] {
        &self.metrics_columns
    }

    /// `1.0` or `1.1`.
    pub fn log_format_version(&self) -> &str {
        &self.log_format_version
    }

    /// Reads the file from a log directory. A file without a version counts as 1.0, which did not require one.
    pub(super) fn read(dir: &Path) -> Result<Self, MetricsError> {
        let object = json_file::read_object(&dir.join(FILE_NAME), EXPECTED_FILE)?;
        let columns = object.get("metrics_columns").ok_or_else(|| wrong_columns("nothing"))?;
        let metrics_columns: Vec<String> =
            Vec::deserialize(columns).map_err(|_| wrong_columns(&columns.to_string()))?;
        check_columns(&metrics_columns)?;
        let log_format_version = match object.get("log_format_version") {
            None => "1.0".to_owned(),
            Some(Value::String(version)) if ["1.0", LOG_FORMAT_VERSION].contains(&version.as_str()) => version.clone(),
            Some(other) => {
                let (field, expected) = ("log_format_version", "\"1.0\" or \"1.1\"");
                return Err(MetricsError::logger_info(field, cut(&other.to_string()), expected));
            }
        };
        Ok(Self {
            metrics_columns,
            log_format_version,
        })
    }
}

fn check_columns(columns: &[String]) -> Result<(), MetricsError> {
    if columns.len() > MAX_COLUMNS {
        return Err(MetricsError::logger_info(
            "metrics_columns",
            format!("{} names", columns.len()),
            "at most 1000 names",
        ));
    }
    let repeated = columns.iter().collect::<BTreeSet<_>>().len() < columns.len();
    let unusable = columns
        .iter()
        .any(|name| name.is_empty() || STANDARD_COLUMNS.contains(&name.as_str()));
    if columns.is_empty() || repeated || unusable {
        return Err(wrong_columns(&format!("{columns:?}")));
    }
    Ok(())
}

fn wrong_columns(found: &str) -> MetricsError {
    MetricsError::logger_info("metrics_columns", cut(found), EXPECTED_COLUMNS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn log_without_usable_metrics_columns_is_refused() {
        let check = |columns: &[&str], found: &str| {
            let message = LoggerInfo::new(columns.iter().copied()).unwrap_err().to_string();
            assert_eq!(
                message,
                format!("logger_info.json, metrics_columns: found {found}, expected {EXPECTED_COLUMNS}")
            );
        };
        check(&[], "[]");
        check(&["reward", "reward"], r#"["reward", "reward"]"#);
        check(&[""], r#"[""]"#);
        check(&["exp_num"], r#"["exp_num"]"#);
    }

    #[test]
    fn newer_versions_are_refused_and_missing_version_means_1_0() {
        let dir = tempfile::tempdir().unwrap();
        let read = |text: &str| {
            std::fs::write(dir.path().join(FILE_NAME), text).unwrap();
            LoggerInfo::read(dir.path())
                .map(|info| info.log_format_version)
                .map_err(|error| error.to_string())
        };
        assert_eq!(read(r#"{"metrics_columns": ["r"]}"#), Ok("1.0".to_owned()));
        assert_eq!(
            read(r#"{"metrics_columns": ["r"], "log_format_version": "1.1"}"#),
            Ok("1.1".to_owned())
        );
        let message = "logger_info.json, log_format_version: found \"2.0\", expected \"1.0\" or \"1.1\"".to_owned();
        assert_eq!(
            read(r#"{"metrics_columns": ["r"], "log_format_version": "2.0"}"#),
            Err(message)
        );
        let message = format!("logger_info.json, metrics_columns: found nothing, expected {EXPECTED_COLUMNS}");
        assert_eq!(read("{}"), Err(message));
    }
}
