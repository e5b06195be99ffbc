//! Formats values, numbers and JSON pointers for messages.

use std::fmt::Write;

use serde_json::Value;

/// A value, shortened for a message.
pub(crate) fn describe(value: &Value) -> String {
    match value {
        Value::String(text) if text.chars().count() > 40 => {
            format!("{:?}…", text.chars().take(40).collect::<String>())
        }
        Value::Array(items) if items.len() > 4 => format!("a list of {} values", items.len()),
        Value::Object(map) if map.len() > 2 => format!("an object with {} keys", map.len()),
        Value::Object(_) if !is_short(value) => "an object".to_owned(),
        Value::Array(_) if !is_short(value) => "a list".to_owned(),
        other => other.to_string(),
    }
}

/// Whether a value has at most 60 characters, found without writing all of a large one.
fn is_short(value: &Value) -> bool {
    // A character has at most 4 bytes.
    let mut room = [0; 4 * 60];
    serde_json::to_writer(&mut room[..], value).is_ok() && value.to_string().chars().count() <= 60
}

/// A number for messages; very large and very small numbers have an exponent.
pub(crate) fn plain_number(number: f64) -> String {
    if number != 0.0 && !(1e-6..1e15).contains(&number.abs()) {
        format!("{number:e}")
    } else {
        number.to_string()
    }
}

/// Bytes in hexadecimal, two digits each.
pub(crate) fn hexadecimal(bytes: &[u8]) -> String {
    let digits = String::with_capacity(2 * bytes.len());
    bytes.iter().fold(digits, |mut digits, byte| {
        write!(digits, "{byte:02x}").expect("writing to a String does not fail");
        digits
    })
}

pub(crate) use driftworld_text::json::escape;

pub(crate) fn pointer_of(path: &serde_path_to_error::Path) -> String {
    use serde_path_to_error::Segment;
    path.iter().fold(String::new(), |pointer, segment| match segment {
        Segment::Seq { index } => format!("{pointer}/{index}"),
        Segment::Map { key } => format!("{pointer}/{}", escape(key)),
        Segment::Enum { variant } => format!("{pointer}/{}", escape(variant)),
        Segment::Unknown => pointer,
    })
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn values_up_to_60_characters_including_escapes_are_shown_whole() {
        let quotes = |a: usize, b: usize| json!({ "a": "\"".repeat(a), "b": "\"".repeat(b) });
        for (a, b) in [(12, 10), (0, 0), (22, 0), (0, 22)] {
            let text = quotes(a, b).to_string();
            assert!(text.len() <= 60, "{text}");
            assert_eq!(describe(&quotes(a, b)), text);
        }
        for (a, b) in [(20, 12), (23, 0), (0, 23)] {
            assert!(quotes(a, b).to_string().len() > 60);
            assert_eq!(describe(&quotes(a, b)), "an object");
        }
    }
}
