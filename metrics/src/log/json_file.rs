//! Reads and writes the JSON files of a log. Errors state line and column, and writes are atomic.

use std::path::Path;

use driftworld_text::json::{
    MAX_KEY_BYTES, Repeats, Stop, Wanted, last_key, lines_and_columns, offsets, parse, reason, repeated,
};
use serde::Serialize;
use serde_json::{Map, Value};

use super::regular_file;
use crate::MetricsError;

/// Maximum size of a JSON file, in bytes.
pub const MAX_JSON_BYTES: u64 = 16 << 20;

/// Maximum number of values in a JSON file: numbers, strings, arrays, objects and so on. Each may take a hundred bytes of memory.
pub const MAX_JSON_VALUES: u64 = 1_000_000;

/// Reads a file that contains one JSON object.
///
/// # Errors
/// [`MetricsError::MissingFile`] and [`MetricsError::NotAFile`]; [`MetricsError::TooLarge`] for more than 16 MiB or a million
/// values; [`MetricsError::Json`] with line and column for anything but a JSON object.
pub(super) fn read_object(path: &Path, expected: &'static str) -> Result<Map<String, Value>, MetricsError> {
    let text = regular_file::text(path, MAX_JSON_BYTES)?.ok_or_else(|| MetricsError::missing_file(path, expected))?;
    let wrong = |(line, column): (usize, usize), wrong: String| MetricsError::Json {
        path: path.to_owned(),
        line: line.max(1),
        column: column.max(1),
        wrong,
    };
    match parse(&text, MAX_JSON_VALUES as usize, Repeats::Stop) {
        Ok(Value::Object(object)) => Ok(object),
        Ok(_) => Err(wrong((1, 1), format!("found no object, expected {expected}"))),
        Err((_, Some(Stop::TooMany))) => Err(MetricsError::too_large(
            path,
            "JSON values or more",
            MAX_JSON_VALUES + 1,
            MAX_JSON_VALUES,
        )),
        Err((error, stop)) => {
            let position = first_repeated_key(&text)
                .map(|(position, _)| position)
                .filter(|_| stop == Some(Stop::Repeated));
            Err(wrong(
                position.unwrap_or((error.line(), error.column())),
                fault(&text, &error, stop),
            ))
        }
    }
}

/// Explains why this text cannot be parsed, in the same words as for documents.
pub(super) fn fault(text: &str, error: &serde_json::Error, stop: Option<Stop>) -> String {
    match (stop, first_repeated_key(text)) {
        (Some(Stop::LongKey), _) => {
            format!("found a key of more than {MAX_KEY_BYTES} bytes, expected at most that many")
        }
        (Some(Stop::Repeated), Some((_, key))) => {
            format!("found the key {key:?} twice, expected each key once; remove one of the two")
        }
        _ => format!("not valid JSON: {}", reason(text, error)),
    }
}

/// The first repeated key of an object, with its line and column.
fn first_repeated_key(text: &str) -> Option<((usize, usize), String)> {
    let pointer = repeated(text, 1).pop()?;
    let wanted = [Wanted {
        pointer: &pointer,
        at_key: false,
    }];
    let position = lines_and_columns(text, &offsets(text, &wanted))[0];
    Some((position, last_key(&pointer)))
}

/// Writes a value as indented JSON, first under a temporary name next to the target, so that no reader sees a partial file.
///
/// # Errors
/// [`MetricsError::Io`] if the file cannot be written.
pub(crate) fn write_json(path: &Path, value: &impl Serialize) -> Result<(), MetricsError> {
    write_info(path, value, true)
}

/// Like [`write_json`]. Without `syncs`, writes directly into the file, for a log that will be thrown away.
pub(super) fn write_info(path: &Path, value: &impl Serialize, syncs: bool) -> Result<(), MetricsError> {
    let mut bytes = serde_json::to_vec_pretty(value).map_err(|error| MetricsError::Io {
        path: path.to_owned(),
        doing: "encode this value as JSON",
        source: error.into(),
    })?;
    bytes.push(b'\n');
    if syncs {
        write_whole(path, &bytes)
    } else {
        std::fs::write(path, &bytes).map_err(MetricsError::io(path, "write this file"))
    }
}

/// Writes bytes under a temporary name next to the target, and renames the file. An existing file keeps its mode.
pub(crate) fn write_whole(path: &Path, bytes: &[u8]) -> Result<(), MetricsError> {
    driftworld_atomic_files::write(path, bytes).map_err(MetricsError::io(path, "write this file"))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn written_object_reads_back_and_leaves_no_temporary_file() {
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
    fn too_many_values_are_refused_before_use() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("info.json");
        fs::write(&path, format!("{{\"a\": [{}0]}}", "0,".repeat(1_200_000))).unwrap();
        let message = read_object(&path, "an object").unwrap_err().to_string();
        assert!(
            message.ends_with("found 1000001 JSON values or more, expected at most 1000000"),
            "{message}"
        );
    }

    #[test]
    fn broken_json_is_located_as_in_documents() {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("info.json");
        let check = |bytes: &[u8], expected: &str| {
            fs::write(&path, bytes).unwrap();
            let message = read_object(&path, "an object").map_or_else(|error| error.to_string(), |_| "read".to_owned());
            assert_eq!(message.replace(&path.display().to_string(), ""), expected);
        };
        check(b"{\n  \"a\": }", ":2:8: not valid JSON: expected value");
        check(b"[1]", ":1:1: found no object, expected an object");
        check(b"", ":1:1: not valid JSON: the document is empty");
        check(
            b"{\"a\": NaN}",
            ":1:7: not valid JSON: JSON has no NaN or Infinity; numbers are finite",
        );
        let repeated = ":1:16: found the key \"a\" twice, expected each key once; remove one of the two";
        check(b"{ \"a\": 1, \"a\": 2 }", repeated);
        check("\u{feff}{}".as_bytes(), "read");
        check(
            b"\xff\xfe{\0}\0",
            ":1:1: byte 0 is not UTF-8, expected UTF-8 text; save it as UTF-8",
        );
    }
}
