//! Parses single cells of a data file, and formats the errors for invalid ones.

use std::path::Path;

use driftworld_text::json::{Repeats, parse};
use serde_json::Value;

use super::json_file::{MAX_JSON_VALUES, fault};
use super::record::{TaskParams, is_worker_id};
use crate::{LogLine, MetricsError};

/// Maximum number of characters of a cell quoted in a message.
const MAX_QUOTED_CHARS: usize = 60;

/// Maximum number of names that a message lists.
const MAX_NAMES: usize = 20;

/// A cell with its position in the file, which the error names if its text is invalid.
#[derive(Clone, Copy)]
pub(super) struct Cell<'a> {
    pub(super) path: &'a Path,
    pub(super) line: u64,
    pub(super) column: &'a str,
    pub(super) text: &'a str,
}

impl Cell<'_> {
    pub(super) fn whole_number(self) -> Result<u64, MetricsError> {
        // Data-frame libraries write integers as 3.0 in columns with missing values.
        let zeros = |rest: &str| !rest.is_empty() && rest.bytes().all(|byte| byte == b'0');
        let whole = self
            .text
            .split_once('.')
            .filter(|(_, rest)| zeros(rest))
            .map(|(whole, _)| whole);
        whole.unwrap_or(self.text).parse().map_err(|_| {
            if !self.text.is_empty() && self.text.bytes().all(|byte| byte.is_ascii_digit()) {
                self.error(format!("a whole number of at most {}", u64::MAX))
            } else {
                self.error("a whole number, 0 or more")
            }
        })
    }

    /// A word of one of the format's enums.
    pub(super) fn word<T: std::str::FromStr>(self, expected: fn() -> String) -> Result<T, MetricsError> {
        self.text
            .parse()
            .map_err(|_| self.error(format!("one of {}", expected())))
    }

    pub(super) fn worker(self) -> Result<String, MetricsError> {
        let expected = "a worker's name of letters, digits, _, - and .";
        is_worker_id(self.text)
            .then(|| self.text.to_owned())
            .ok_or_else(|| self.error(expected))
    }

    pub(super) fn timestamp(self) -> Result<crate::Timestamp, MetricsError> {
        self.text
            .parse()
            .map_err(|_| self.error("a time stamp as in 20200913T122640.000000"))
    }

    /// A JSON object; an empty cell counts as an empty object.
    pub(super) fn params(self) -> Result<TaskParams, MetricsError> {
        match self.text {
            "" => Ok(TaskParams::default()),
            text => match parse(text, MAX_JSON_VALUES as usize, Repeats::Stop) {
                Ok(Value::Object(object)) => Ok(TaskParams::new(object)),
                Ok(_) => Err(self.error("a JSON object")),
                Err((error, stop)) => Err(self.error(format!("a JSON object; {}", fault(text, &error, stop)))),
            },
        }
    }

    pub(super) fn number(self) -> Result<f64, MetricsError> {
        number(self.text).ok_or_else(|| self.error("a finite number, or nothing for a missing one"))
    }

    /// The error that states what was found here and what was expected.
    pub(super) fn error(self, expected: impl Into<String>) -> MetricsError {
        MetricsError::Cell {
            at: LogLine {
                path: self.path.to_owned(),
                line: self.line,
            },
            column: cut(self.column),
            found: shown(self.text),
            expected: expected.into(),
        }
    }
}

/// A finite number, or NaN for an empty cell or a word that other programs write for a missing value. `None` for anything else.
pub(super) fn number(text: &str) -> Option<f64> {
    let number = match text.parse() {
        Ok(number) => number,
        Err(_) => match text.trim() {
            "" | "NA" | "N/A" | "n/a" | "<NA>" | "null" | "NULL" | "None" => f64::NAN,
            text => text.parse().ok()?,
        },
    };
    Some(number).filter(|number| !number.is_infinite())
}

/// A cell for a message: quoted, and cut to [`MAX_QUOTED_CHARS`] characters.
pub(super) fn shown(text: &str) -> String {
    match text.char_indices().nth(MAX_QUOTED_CHARS) {
        Some((end, _)) => format!("{:?}…", &text[..end]),
        None => format!("{text:?}"),
    }
}

/// A name for a message, cut to [`MAX_QUOTED_CHARS`] characters.
pub(super) fn cut(text: &str) -> String {
    driftworld_text::shortened(text, MAX_QUOTED_CHARS)
}

/// Names for a message: the first few, and how many more there are.
pub(super) fn listed(names: &[String]) -> String {
    let names: Vec<String> = names.iter().map(|name| cut(name)).collect();
    driftworld_text::first_of(&names, MAX_NAMES)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(text: &str) -> Cell<'_> {
        Cell {
            path: Path::new("w/0-train/data-log.tsv"),
            line: 7,
            column: "reward",
            text,
        }
    }

    #[test]
    fn numbers_are_finite_or_missing() {
        let check = |text: &str, expected: f64| assert_eq!(cell(text).number().unwrap().to_bits(), expected.to_bits());
        check("1.5", 1.5);
        check("-2e-3", -0.002);
        check("7", 7.0);
        for missing in ["", "nan", "NaN", "NA", "null"] {
            assert!(cell(missing).number().unwrap().is_nan(), "{missing}");
        }
        let message = "w/0-train/data-log.tsv:7, column reward: found \"inf\", \
                       expected a finite number, or nothing for a missing one";
        assert_eq!(cell("inf").number().unwrap_err().to_string(), message);
        assert!(cell("1,5").number().is_err());
        assert!(cell(" 1.5 ").number().is_ok_and(|number| number == 1.5));
    }

    #[test]
    fn long_cells_are_cut_in_messages() {
        assert_eq!(shown("a\tb"), "\"a\\tb\"");
        assert_eq!(shown(&"é".repeat(61)), format!("\"{}\"…", "é".repeat(60)));
    }

    #[test]
    fn parameters_are_an_object_or_nothing() {
        assert!(cell("").params().unwrap().is_empty());
        assert_eq!(cell(r#"{"a": 1}"#).params().unwrap()["a"], 1);
        assert!(cell("[1]").params().is_err());
        let check = |text: &str, expected: bool| {
            let message = cell(text).params().unwrap_err().to_string();
            assert_eq!(
                message.ends_with("JSON has no NaN or Infinity; numbers are finite"),
                expected,
                "{message}"
            );
        };
        for number in ["NaN", "Infinity", "-Infinity"] {
            check(&format!(r#"{{"a": {number}}}"#), true);
            check(&format!("{{\"é\": 1,\n \"b\": [0, {number}]}}"), true);
            check(&format!(r#"{{"a": "{number}", "b": x}}"#), false);
        }
        check("NaN", true);
        check("{", false);
    }
}
