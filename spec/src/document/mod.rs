//! [`Document`]: a parsed JSON text that can locate each value by line and column, for error messages.

use serde::de::DeserializeOwned;
use serde_json::Value;

use crate::describe::{describe, pointer_of};
use crate::error::{Listed, MAX_PROBLEMS, Problem, SpecError};
use crate::limits::{MAX_BYTES, MAX_KEY_BYTES};
use crate::value::with_whole_numbers;
use crate::version::Format;
use driftworld_text::json::{self, Repeats, Stop, Wanted, lines_and_columns};

/// A parsed JSON text.
pub(crate) struct Document<'a> {
    pub(crate) name: &'a str,
    text: &'a str,
    pub(crate) value: Value,
}

impl<'a> Document<'a> {
    /// Parses a text of at most `max_values` values; rejects invalid JSON and repeated keys in one object.
    pub(crate) fn parse(name: &'a str, text: &'a str, max_values: usize) -> Result<Self, SpecError> {
        let (document, repeated) = Self::parse_leniently(name, text, max_values)?;
        let twice = |pointer: String| {
            let found = format!("the key {:?} twice", json::last_key(&pointer));
            Problem::new(
                "spec/duplicate-key",
                pointer,
                found,
                "each key once; remove one of the two",
            )
        };
        document.fail_on(repeated.into_iter().map(twice).collect::<Vec<_>>())?;
        Ok(document)
    }

    /// Parses a text as most programs do: the last of repeated keys in one object counts. Also returns pointers of repeated keys,
    /// up to a limit.
    pub(crate) fn parse_leniently(name: &'a str, text: &'a str, max: usize) -> Result<(Self, Vec<String>), SpecError> {
        let text = without_mark(text);
        if text.len() > MAX_BYTES {
            return Err(SpecError::TooLarge {
                name: name.to_owned(),
                bytes: text.len(),
                limit: MAX_BYTES,
            });
        }
        let to_error = |(error, stop): (serde_json::Error, Option<Stop>)| match stop {
            Some(Stop::TooMany) => SpecError::TooManyValues {
                name: name.to_owned(),
                limit: max,
            },
            Some(Stop::LongKey) => SpecError::LongKey {
                name: name.to_owned(),
                line: error.line().max(1),
                column: error.column().max(1),
                limit: MAX_KEY_BYTES,
            },
            Some(Stop::Repeated) | None => syntax_error(name, text, &error),
        };
        // One pass builds the value and detects repeated keys; their positions are looked up only if there are any.
        let (value, repeated) = match json::parse(text, max, Repeats::Stop) {
            Ok(value) => (value, Vec::new()),
            Err((_, Some(Stop::Repeated))) => {
                let value = json::parse(text, max, Repeats::LastCounts).map_err(to_error)?;
                (value, json::repeated(text, MAX_PROBLEMS + 1))
            }
            Err(found) => return Err(to_error(found)),
        };
        Ok((Self { name, text, value }, repeated))
    }

    /// Upgrades the document to the current version of its format; fails if it is newer.
    pub(crate) fn upgrade(&mut self, format: &Format) -> Result<(), SpecError> {
        let problem = format.upgrade(&mut self.value);
        self.fail_on(Vec::from_iter(problem))
    }

    /// The typed value; a value that passes the schema but not the type is reported like any other problem.
    pub(crate) fn deserialize<T: DeserializeOwned>(&self) -> Result<T, SpecError> {
        typed(&self.value).map_err(|problem| self.error(vec![problem]))
    }

    /// Fails if there are any problems, after looking up the line and column of each.
    pub(crate) fn fail_on(&self, found: impl Into<Listed>) -> Result<(), SpecError> {
        let found = found.into();
        if found.problems.is_empty() {
            Ok(())
        } else {
            Err(self.error(found))
        }
    }

    /// The error for these problems, after looking up the line and column of each.
    pub(crate) fn error(&self, found: impl Into<Listed>) -> SpecError {
        let Listed { mut problems, more } = found.into();
        let more = more || problems.len() > MAX_PROBLEMS;
        // Finds the positions of a few more problems than are listed, then sorts: looking up a hundred thousand would take too
        // long.
        problems.truncate(8 * MAX_PROBLEMS);
        let wanted = problems.iter().map(|problem| Wanted {
            pointer: &problem.pointer,
            at_key: matches!(problem.code, "spec/unknown-key" | "spec/name"),
        });
        let offsets = json::offsets(self.text, &wanted.collect::<Vec<_>>());
        let places = lines_and_columns(self.text, &offsets);
        for (problem, place) in problems.iter_mut().zip(places) {
            (problem.line, problem.column) = place;
        }
        SpecError::of_document(self.name, Listed { problems, more })
    }
}

/// The JSON as a typed value, or the problem that prevents it.
pub(crate) fn typed<T: DeserializeOwned>(json: &Value) -> Result<T, Problem> {
    // Plain deserialisation is twice as fast as tracking the path of a failure.
    if let Ok(typed) = T::deserialize(json) {
        return Ok(typed);
    }
    // JSON Schema accepts 10.0 as the integer 10.
    if let Ok(typed) = T::deserialize(&with_whole_numbers(json.clone())) {
        return Ok(typed);
    }
    serde_path_to_error::deserialize(json).map_err(|error| {
        let pointer = pointer_of(error.path());
        let found = json.pointer(&pointer).map_or_else(|| "nothing".to_owned(), describe);
        Problem::new("spec/value", pointer, found, error.into_inner().to_string())
    })
}

/// Lines and columns of the values of pointers in a JSON text; for a missing value, of its nearest existing parent.
pub(crate) fn places_in(text: &str, pointers: &[&str]) -> Vec<(usize, usize)> {
    let text = without_mark(text);
    let wanted = pointers.iter().map(|pointer| Wanted { pointer, at_key: false });
    lines_and_columns(text, &json::offsets(text, &wanted.collect::<Vec<_>>()))
}

/// The text without the byte order mark that some editors write: it is not part of the document.
fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

fn syntax_error(name: &str, text: &str, error: &serde_json::Error) -> SpecError {
    SpecError::Syntax {
        name: name.to_owned(),
        line: error.line().max(1),
        column: error.column().max(1),
        reason: json::reason(text, error),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(text: &str, expected: &str) {
        let error = Document::parse("d.json", text, 999)
            .err()
            .map(|error| error.to_string());
        assert_eq!(error.as_deref(), Some(expected), "{text}");
    }

    #[test]
    fn places_of_keys_are_found_in_wide_and_narrow_objects() {
        for width in [1, 32, 1000, 10_000] {
            let keys: Vec<String> = (0..width).map(|key| format!("\"k{key}\": 1")).collect();
            let text = format!("{{\n{}\n}}", keys.join(",\n"));
            let last = format!("/k{}", width - 1);
            let column = format!("\"k{}\": ", width - 1).len() + 1;
            assert_eq!(
                places_in(&text, &["/k0", &last, "/none"]),
                [(2, 7), (width + 1, column), (1, 1)]
            );
        }
    }

    #[test]
    fn invalid_json_is_refused_with_its_place() {
        check(
            "{\n  \"a\": 1,\n}",
            "d.json:3:1: not valid JSON: trailing comma; remove the comma before the closing bracket",
        );
        check(
            "{\"a\": NaN}",
            "d.json:1:7: not valid JSON: JSON has no NaN or Infinity; numbers are finite",
        );
        check(
            "{\"a\": [1, 2",
            "d.json:1:11: not valid JSON: EOF while parsing a list; the document ends too early, is it cut off?",
        );
        check("", "d.json:1:1: not valid JSON: the document is empty");
        check("{\"a\": 1e999}", "d.json:1:11: not valid JSON: number out of range");
        check(
            &"[".repeat(1000),
            "d.json:1:128: not valid JSON: lists and objects are nested more than 127 deep; is a bracket missing?",
        );
    }

    #[test]
    fn repeated_key_is_refused() {
        check(
            "{\"a\": {\"b\": 1,\n \"b\": 2}}",
            "d.json:2:7 (/a/b): found the key \"b\" twice, expected each key once; remove one of the two",
        );
    }
}
