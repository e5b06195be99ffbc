//! Encodes names of tasks and runs as folder names that are valid on every file system, and decodes them.

use std::fmt::Write;
use std::path::Path;

use crate::MetricsError;

/// Maximum length of a folder name, in bytes: file systems allow 255, and a number may be appended.
const MAX_BYTES: usize = 200;

/// Writes every byte except ASCII letters, digits, `_`, `-` and `.` as `%` and two hexadecimal digits. Also encodes a leading `.`,
/// which would hide the folder or lead out of it, and a trailing one, which some file systems drop.
///
/// If the name is too long, the error refers to the folder `place`.
pub(super) fn encoded(place: &Path, name: &str) -> Result<String, MetricsError> {
    let mut encoded = String::with_capacity(name.len());
    let last = name.len().saturating_sub(1);
    for (index, byte) in name.bytes().enumerate() {
        let is_inner_dot = byte == b'.' && index != 0 && index != last;
        if byte.is_ascii_alphanumeric() || byte == b'_' || byte == b'-' || is_inner_dot {
            encoded.push(char::from(byte));
        } else {
            // Writing to a string cannot fail.
            let _ = write!(encoded, "%{byte:02X}");
        }
    }
    if encoded.is_empty() {
        // Stands for the empty name; no other name is encoded like this.
        encoded.push('%');
    }
    if encoded.len() > MAX_BYTES {
        return Err(MetricsError::too_large(
            place,
            "bytes in the folder name of a task or a run",
            encoded.len() as u64,
            MAX_BYTES as u64,
        ));
    }
    Ok(encoded)
}

/// The name that a folder stands for. Names that were not encoded by us stay unchanged.
pub(super) fn decoded(folder: &Path) -> String {
    let encoded = folder.file_name().unwrap_or_default().to_string_lossy();
    if encoded == "%" {
        return String::new();
    }
    decode(encoded.as_bytes()).unwrap_or_else(|| encoded.into_owned())
}

fn decode(mut rest: &[u8]) -> Option<String> {
    let mut bytes = Vec::with_capacity(rest.len());
    while let [first, others @ ..] = rest {
        if *first == b'%' {
            let digits = std::str::from_utf8(others.get(..2)?).ok()?;
            bytes.push(u8::from_str_radix(digits, 16).ok()?);
            rest = &others[2..];
        } else {
            bytes.push(*first);
            rest = others;
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn harmless_names_are_kept() {
        let check = |name: &str, expected: &str| assert_eq!(encoded(Path::new(""), name).unwrap(), expected);
        check("find_red", "find_red");
        check("run-2.b", "run-2.b");
        check("..", "%2E%2E");
        check("a/b", "a%2Fb");
        check("100%", "100%25");
        check("é", "%C3%A9");
        check("", "%");
        assert!(encoded(Path::new(""), &"x".repeat(201)).is_err());
    }

    #[test]
    fn foreign_folder_names_are_kept() {
        let check = |folder: &str| assert_eq!(decoded(Path::new(folder)), folder);
        check("50%");
        check("%zz");
        check("%FF");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        #[test]
        fn every_name_round_trips(name in ".{0,40}") {
            if let Ok(folder) = encoded(Path::new(""), &name) {
                prop_assert_eq!(decoded(&Path::new("data").join(folder)), name);
            }
        }
    }
}
