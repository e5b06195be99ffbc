//! [`Warning`]: a warning about a readable document, with its line and column. Only the first few hundred are kept.

use std::fmt;

use driftworld_text::one_line;

use crate::document::places_in;
use crate::error::MAX_PROBLEMS;

/// A part of a document that was not taken literally.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning {
    /// The document's name.
    pub name: String,
    /// JSON pointer to the value.
    pub pointer: String,
    /// Line in the text, from 1; 0 if there is no text.
    pub line: usize,
    /// Column in the line, from 1; 0 if `line` is 0.
    pub column: usize,
    /// What was found, and how it was read.
    pub text: String,
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}", one_line(&self.name))?;
        if self.line > 0 {
            write!(f, ":{}:{}", self.line, self.column)?;
        }
        write!(f, " ({}): {}", one_line(&self.pointer), one_line(&self.text))
    }
}

/// The first few hundred warnings about a document.
#[derive(Debug, Default)]
pub(crate) struct Remarks {
    /// Pairs of a pointer to the subject and the text of the remark.
    first: Vec<(String, String)>,
    more: usize,
}

impl Remarks {
    pub(crate) fn push(&mut self, pointer: impl Into<String>, text: impl Into<String>) {
        if self.first.len() < MAX_PROBLEMS {
            self.first.push((pointer.into(), text.into()));
        } else {
            self.more += 1;
        }
    }

    /// The remarks sorted by line and column in the text; `name` is the document's name in messages.
    pub(crate) fn in_text(self, name: &str, text: &str) -> Vec<Warning> {
        let pointers: Vec<&str> = self.first.iter().map(|(pointer, _)| pointer.as_str()).collect();
        let places = places_in(text, &pointers);
        self.at(name, places)
    }

    /// The remarks on a document without text; `name` is its name in messages.
    pub(crate) fn without_text(self, name: &str) -> Vec<Warning> {
        let places = vec![(0, 0); self.first.len()];
        self.at(name, places)
    }

    /// The remarks sorted by line and column; `places` has one entry for each.
    fn at(self, name: &str, places: Vec<(usize, usize)>) -> Vec<Warning> {
        let warning = |((pointer, text), (line, column))| Warning {
            name: name.to_owned(),
            pointer,
            line,
            column,
            text,
        };
        let mut warnings: Vec<Warning> = self.first.into_iter().zip(places).map(warning).collect();
        warnings.sort_by_key(|warning| (warning.line, warning.column));
        let more = format!("there are {} more remarks like these", self.more);
        warnings.extend((self.more > 0).then(|| warning(((String::new(), more), (0, 0)))));
        warnings
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn warning_without_a_line_shows_no_line() {
        let mut warning = Warning {
            name: "world".into(),
            pointer: "/rules/step_reward".into(),
            line: 0,
            column: 0,
            text: "lost".into(),
        };
        assert_eq!(warning.to_string(), "world (/rules/step_reward): lost");
        (warning.line, warning.column) = (3, 7);
        assert_eq!(warning.to_string(), "world:3:7 (/rules/step_reward): lost");
    }
}
