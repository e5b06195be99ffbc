//! JSON on one line with a space after `:` and `,`, as l2logger's `json.dumps` writes task parameters.

use std::io::{self, Write};

use serde::Serialize;
use serde_json::{Map, Value};

struct Spaced;

impl serde_json::ser::Formatter for Spaced {
    fn begin_array_value<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        if first { Ok(()) } else { writer.write_all(b", ") }
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        if first { Ok(()) } else { writer.write_all(b", ") }
    }

    fn begin_object_value<W: ?Sized + Write>(&mut self, writer: &mut W) -> io::Result<()> {
        writer.write_all(b": ")
    }
}

/// The object as text, keeping the order of its keys.
pub(crate) fn spaced_json(object: &Map<String, Value>) -> String {
    let mut text = Vec::new();
    let mut serializer = serde_json::Serializer::with_formatter(&mut text, Spaced);
    object
        .serialize(&mut serializer)
        .expect("a JSON object has string keys, and writing to memory does not fail");
    String::from_utf8(text).expect("serde_json writes UTF-8")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spaces_match_pythons_json_output() {
        let check = |text: &str| {
            let object: Map<String, Value> = serde_json::from_str(text).unwrap();
            assert_eq!(spaced_json(&object), text);
        };
        check("{}");
        check(r#"{"a": 1}"#);
        check(r#"{"name": "task1_1", "min_perf": 2.5, "start": null, "deep": {"x": [1, 2.5, []]}, "on": true}"#);
        check(r#"{"tab": "\t", "quote": "\"", "é": "ü"}"#);
    }
}
