//! [`SpecError`]: the problems of a document, worded so that its author can fix them.

use std::fmt;

use driftworld_text::one_line;

use crate::suggest::{did_you_mean, nearest};

/// Maximum number of problems listed for a document; beyond it, the error only says that there are more.
pub const MAX_PROBLEMS: usize = 300;

/// Maximum number of problems shown in one message.
const NUM_SHOWN: usize = 20;

/// Maximum number of characters of a value shown in a message.
const NUM_SHOWN_CHARACTERS: usize = 100;

/// One problem of a document: where it is, what was found, what was expected, what to do.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Problem {
    /// Stable code of this kind of problem, such as `spec/unknown-key`.
    pub code: &'static str,
    /// JSON pointer to the value, such as `/objects/3/color`; empty for the document itself.
    pub pointer: String,
    /// Line in the text, from 1; 0 if unknown.
    pub line: usize,
    /// Column in the line, in characters from 1; 0 if unknown.
    pub column: usize,
    /// What was found there.
    pub found: String,
    /// What was expected there.
    pub expected: String,
    /// What to do about it, if there is advice.
    pub advice: Option<String>,
}

impl Problem {
    /// A problem whose line and column are not known yet.
    pub(crate) fn new(
        code: &'static str,
        pointer: impl Into<String>,
        found: impl Into<String>,
        expected: impl Into<String>,
    ) -> Self {
        let found = found.into();
        Self {
            code,
            pointer: pointer.into(),
            line: 0,
            column: 0,
            // Text without visible characters is shown in quotes.
            found: if found.trim().is_empty() {
                format!("{found:?}")
            } else {
                found
            },
            expected: expected.into(),
            advice: None,
        }
    }

    /// The same problem, with its pointer moved below `place`.
    pub(crate) fn within(mut self, place: &str) -> Self {
        self.pointer.insert_str(0, place);
        self
    }

    /// Adds advice.
    pub(crate) fn advise(mut self, advice: impl Into<String>) -> Self {
        self.advice = Some(advice.into());
        self
    }

    /// Adds "did you mean …?" if one of the known words is similar to the one found.
    pub(crate) fn suggest<S: AsRef<str>>(self, word: &str, known: impl IntoIterator<Item = S>) -> Self {
        match nearest(word, known) {
            Some(near) => self.advise(format!("did you mean {near:?}?")),
            None => self,
        }
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        if self.line > 0 {
            write!(f, "{}:{} ", self.line, self.column)?;
        }
        let pointer = one_line(if self.pointer.is_empty() { "/" } else { &self.pointer });
        let (found, expected) = (one_line(&self.found), one_line(&self.expected));
        write!(f, "({pointer}): found {found}, expected {expected}")?;
        let mut advice = self.advice.iter();
        advice.try_for_each(|advice| write!(f, "; {}", one_line(advice)))
    }
}

/// Errors of this crate.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SpecError {
    /// The text is not JSON.
    #[error("{name}:{line}:{column}: not valid JSON: {reason}", name = one_line(name), reason = one_line(reason))]
    Syntax {
        /// The document's name.
        name: String,
        /// Line from 1.
        line: usize,
        /// Column from 1.
        column: usize,
        /// The reason, and what to do.
        reason: String,
    },
    /// The text is too long for a document.
    #[error("{name}: found {bytes} bytes, expected at most {limit}; split the document", name = one_line(name))]
    TooLarge {
        /// The document's name.
        name: String,
        /// Its length in bytes.
        bytes: usize,
        /// Maximum number of bytes allowed.
        limit: usize,
    },
    /// The text has too many values for a document: each takes a hundred bytes or more while it is checked.
    #[error(
        "{name}: found more than {limit} values (numbers, texts, lists, objects), expected at most that; split the document"
    )]
    TooManyValues {
        /// The document's name.
        name: String,
        /// Maximum number of values allowed.
        limit: usize,
    },
    /// A key is longer than any key of a document.
    #[error("{name}:{line}:{column}: found a key of more than {limit} bytes, expected a name; is a quote missing?")]
    LongKey {
        /// The document's name.
        name: String,
        /// Line from 1.
        line: usize,
        /// Column after the key, from 1.
        column: usize,
        /// Longest key allowed, in bytes.
        limit: usize,
    },
    /// The document is JSON but invalid.
    #[error("{}", list(name, problems, *more))]
    Document {
        /// The document's name.
        name: String,
        /// Its problems, sorted by position; at most [`MAX_PROBLEMS`].
        problems: Vec<Problem>,
        /// Whether there are more problems than listed.
        more: bool,
    },
    /// A task has no variant of this name.
    #[error(
        "{task}: found variant {found:?}, expected one of {}{}",
        one_line(first_of(known)),
        did_you_mean(found, known),
        task = one_line(task)
    )]
    UnknownVariant {
        /// The task's name.
        task: String,
        /// The requested name.
        found: String,
        /// The known names.
        known: Vec<String>,
    },
    /// A variant cannot have the requested values.
    #[error("{}", list(variant, problems, false))]
    Values {
        /// The name of the variant, including that of its task.
        variant: String,
        /// All problems.
        problems: Vec<Problem>,
    },
}

impl SpecError {
    /// Stable code of this kind of error; for a document, the code of its first problem.
    pub fn code(&self) -> &'static str {
        match self {
            Self::Syntax { .. } => "spec/syntax",
            Self::TooLarge { .. } => "spec/too-large",
            Self::TooManyValues { .. } => "spec/too-many-values",
            Self::LongKey { .. } => "spec/long-key",
            Self::Document { problems, .. } | Self::Values { problems, .. } => {
                problems.first().map_or("spec/value", |problem| problem.code)
            }
            Self::UnknownVariant { .. } => "spec/unknown-variant",
        }
    }

    /// The error of a document or value with these problems, sorted by position.
    pub(crate) fn of_document(name: &str, found: impl Into<Listed>) -> Self {
        let Listed { mut problems, more } = found.into();
        let more = more || problems.len() > MAX_PROBLEMS;
        problems.sort_by(|a, b| (a.line, a.column, &a.pointer).cmp(&(b.line, b.column, &b.pointer)));
        problems.dedup();
        problems.truncate(MAX_PROBLEMS);
        let name = name.to_owned();
        Self::Document { name, problems, more }
    }

    /// Whether a document has more problems than are listed.
    pub fn has_more(&self) -> bool {
        matches!(self, Self::Document { more: true, .. })
    }

    /// The problems of a document, sorted by position; empty for other errors.
    pub fn problems(&self) -> &[Problem] {
        match self {
            Self::Document { problems, .. } | Self::Values { problems, .. } => problems,
            _ => &[],
        }
    }
}

/// Problems found in a document.
#[derive(Debug, Default)]
pub(crate) struct Listed {
    pub(crate) problems: Vec<Problem>,
    /// Whether a list or object had so many that the rest of it was skipped.
    pub(crate) more: bool,
}

impl From<Vec<Problem>> for Listed {
    fn from(problems: Vec<Problem>) -> Self {
        Self { problems, more: false }
    }
}

fn list(name: &str, problems: &[Problem], more: bool) -> String {
    let name = one_line(name);
    let mut lines: Vec<String> = problems
        .iter()
        .take(NUM_SHOWN)
        .map(|problem| format!("{name}:{problem}"))
        .collect();
    if problems.len() > NUM_SHOWN {
        let at_least = if more { "at least " } else { "" };
        lines.push(format!("{name}: and {at_least}{} more", problems.len() - NUM_SHOWN));
    } else if more {
        lines.push(format!("{name}: and perhaps more"));
    }
    lines.join("\n")
}

/// A text for a message, cut to a limit.
pub(crate) fn cut(text: &str) -> String {
    driftworld_text::shortened(text, NUM_SHOWN_CHARACTERS)
}

/// Names for a message: the first of them, and how many more there are.
pub(crate) fn first_of<S: AsRef<str>>(known: &[S]) -> String {
    driftworld_text::first_of(known, NUM_SHOWN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn message_states_place_found_expected_and_advice() {
        let mut problem =
            Problem::new("spec/value", "/objects/3/color", "\"bleu\"", "a colour").suggest("bleu", ["blue"]);
        (problem.line, problem.column) = (12, 9);
        let error = SpecError::Document {
            name: "find.json".into(),
            problems: vec![problem],
            more: false,
        };
        assert_eq!(
            error.to_string(),
            "find.json:12:9 (/objects/3/color): found \"bleu\", expected a colour; did you mean \"blue\"?"
        );
    }
}
