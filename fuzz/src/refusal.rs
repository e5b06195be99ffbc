//! Checks error messages about a text: each is not empty, points to an existing line, is of bounded length, and contains no
//! unprintable characters.

use driftworld_spec::SpecError;
use driftworld_text::is_unprintable;

/// Maximum length of a message in bytes: fifty problems of a few hundred characters.
const MAX_MESSAGE_BYTES: usize = 100_000;

/// Checks a [`SpecError`] about a document.
pub(crate) fn check(error: &SpecError, text: &str) {
    message(&error.to_string());
    let lines = text.split('\n').count();
    for problem in error.problems() {
        assert!(problem.line <= lines, "line {} of {lines}: {problem}", problem.line);
        assert!(!problem.found.is_empty() && !problem.expected.is_empty(), "{problem}");
    }
}

/// Checks a message.
pub(crate) fn message(text: &str) {
    assert!(!text.trim().is_empty(), "a message is not empty");
    assert!(text.len() <= MAX_MESSAGE_BYTES, "{} bytes", text.len());
    let raw = |c: &char| *c != '\n' && is_unprintable(*c);
    assert!(!text.chars().any(|c| raw(&c)), "{text:?}");
}

/// Checks several messages.
pub(crate) fn messages<T: std::fmt::Display>(texts: impl IntoIterator<Item = T>) {
    for text in texts {
        message(&text.to_string());
    }
}
