//! Reads JSON documents and logs: values within limits, errors in plain words, and the positions of values in the text.

mod places;
mod value;

pub use places::{Wanted, escape, last_key, offsets, repeated};
pub use value::{Repeats, Stop, parse};

/// Maximum length of a key in bytes: every pointer to a value below a key contains the key.
pub const MAX_KEY_BYTES: usize = 400;

/// Maximum depth of nested lists and objects: `serde_json`'s limit, which keeps hostile text from overflowing the stack.
pub const MAX_DEPTH: usize = 127;

/// Why a text is not JSON, in plain words with advice.
pub fn reason(text: &str, error: &serde_json::Error) -> String {
    let message = error.to_string();
    let mut reason = message.split(" at line ").next().unwrap_or_default().to_owned();
    let line_text = text.lines().nth(error.line().saturating_sub(1)).unwrap_or_default();
    let start = line_text.floor_char_boundary(error.column().saturating_sub(1));
    let rest = line_text[start..].trim_start();
    if rest.starts_with("NaN") || rest.starts_with("Infinity") || rest.starts_with("-Infinity") {
        "JSON has no NaN or Infinity; numbers are finite".clone_into(&mut reason);
    } else if reason == "trailing comma" {
        reason.push_str("; remove the comma before the closing bracket");
    } else if rest.starts_with("//") || rest.starts_with("/*") || rest.starts_with('#') {
        reason.push_str("; JSON has no comments, write a \"description\" instead");
    } else if reason == "recursion limit exceeded" {
        reason = format!("lists and objects are nested more than {MAX_DEPTH} deep; is a bracket missing?");
    } else if text.trim().is_empty() {
        "the document is empty".clone_into(&mut reason);
    } else if reason.starts_with("EOF") {
        reason.push_str("; the document ends too early, is it cut off?");
    }
    reason
}

/// Lines and columns of offsets, in one pass through the text for any number of offsets.
pub fn lines_and_columns(text: &str, offsets: &[usize]) -> Vec<(usize, usize)> {
    let mut order: Vec<usize> = (0..offsets.len()).collect();
    order.sort_by_key(|index| offsets[*index]);
    let mut positions = vec![(1, 1); offsets.len()];
    let (mut at, mut line, mut column) = (0, 1, 1);
    for index in order {
        let offset = text.floor_char_boundary(offsets[index]);
        for c in text[at..offset].chars() {
            (line, column) = if c == '\n' { (line + 1, 1) } else { (line, column + 1) };
        }
        at = offset;
        positions[index] = (line, column);
    }
    positions
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        assert_eq!(lines_and_columns("\"ä\": x", &["\"ä\": ".len()]), [(1, 6)]);
        assert_eq!(
            lines_and_columns("a\nbc\n\nd", &[7, 0, 3, 3, 99, 1]),
            [(4, 2), (1, 1), (2, 2), (2, 2), (4, 2), (1, 2)]
        );
    }
}
