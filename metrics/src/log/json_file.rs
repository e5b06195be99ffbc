//! The JSON files beside the rows: read with places in their errors, written whole or not at all.
//!
//! Not here: what stands in them, see `logger_info` and `scenario_info`.

use std::path::Path;

use serde::Serialize;
use serde_json::{Map, Value};

use super::{json_values, regular_file};
use crate::MetricsError;

/// Largest side file that is read, in bytes.
pub const MAX_JSON_BYTES: u64 = 16 << 20;

/// Most values in a side file: numbers, texts, lists, objects and the like. Each takes a hundred bytes or more when
/// read.
pub const MAX_JSON_VALUES: u64 = 1_000_000;

/// Reads a file that holds one JSON object.
///
/// # Errors
/// [`MetricsError::MissingFile`], [`MetricsError::NotAFile`], [`MetricsError::TooLarge`] over 16 MiB and over a million
/// values, [`MetricsError::Json`] with line and column.
pub(super) fn read_object(path: &Path, expected: &'static str) -> Result<Map<String, Value>, MetricsError> {
    let bytes = regular_file::read(path, MAX_JSON_BYTES)?.ok_or_else(|| MetricsError::missing_file(path, expected))?;
    let wrong = |error: serde_json::Error| MetricsError::Json {
        path: path.to_owned(),
        line: error.line(),
        column: error.column(),
        found: without_place(&error),
        expected,
    };
    let found = json_values::count(&bytes, MAX_JSON_VALUES).map_err(wrong)?;
    if found > MAX_JSON_VALUES {
        return Err(MetricsError::too_large(
            path,
            "values or more of JSON",
            found,
            MAX_JSON_VALUES,
        ));
    }
    serde_json::from_slice(&bytes).map_err(wrong)
}

/// Writes a value as indented JSON, first under a temporary name beside the target, so that a reader never sees half.
///
/// # Errors
/// [`MetricsError::Io`].
pub(crate) fn write_json(path: &Path, value: &impl Serialize) -> Result<(), MetricsError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(|error| MetricsError::Io {
        path: path.to_owned(),
        doing: "put this value into JSON",
        source: error.into(),
    })?;
    bytes.push(b'\n');
    write_whole(path, &bytes)
}

/// Writes bytes under a temporary name beside the target and renames. The file keeps its mode if there was one.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), MetricsError> {
    driftworld_atomic_files::write(path, bytes).map_err(MetricsError::io(path, "write this file"))
}

/// The parser's words without "at line 1 column 2", which stands in front of the message already.
fn without_place(error: &serde_json::Error) -> String {
    let text = error.to_string();
    let place = format!(" at line {} column {}", error.line(), error.column());
    text.strip_suffix(&place).unwrap_or(&text).to_owned()
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn a_written_object_is_read_back_and_no_temporary_file_stays() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("info.json");
        write_json(&path, &serde_json::json!({"b": 1, "a": [0.1]})).unwrap();
        assert_eq!(
            serde_json::to_string(&read_object(&path, "an object").unwrap()).unwrap(),
            r#"{"b":1,"a":[0.1]}"#
        );
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 1);
    }

    #[test]
    fn more_values_than_any_log_has_are_not_taken_into_memory() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("info.json");
        fs::write(&path, format!("{{\"a\": [{}0]}}", "0,".repeat(1_200_000))).unwrap();
        let message = read_object(&path, "an object").unwrap_err().to_string();
        assert!(
            message.ends_with("found 1000001 values or more of JSON, expected at most 1000000"),
            "{message}"
        );
    }

    #[test]
    fn broken_json_is_placed() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("info.json");
        let check = |text: &str, expected: &str| {
            fs::write(&path, text).unwrap();
            let message = read_object(&path, "an object").unwrap_err().to_string();
            assert_eq!(message.strip_prefix(&path.display().to_string()).unwrap(), expected);
        };
        check("{\n  \"a\": }", ":2:8: found expected value, expected an object");
        check(
            "[1]",
            ":1:0: found invalid type: sequence, expected a map, expected an object",
        );
        check("", ":1:0: found EOF while parsing a value, expected an object");
    }
}
