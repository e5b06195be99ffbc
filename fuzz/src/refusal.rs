//! What must hold of every error about a text: it says something, at a place that is there, does not fill the screen,
//! and holds nothing that a terminal would obey or hide.

use driftworld_spec::SpecError;
use driftworld_text::is_unprintable;

/// The longest message, in bytes: fifty problems of a few hundred letters.
const LONGEST: usize = 100_000;

/// The law of an error of ours about a document.
pub(crate) fn check(error: &SpecError, text: &str) {
    message(&error.to_string());
    let lines = text.split('\n').count();
    for problem in error.problems() {
        assert!(problem.line <= lines, "line {} of {lines}: {problem}", problem.line);
        assert!(!problem.found.is_empty() && !problem.expected.is_empty(), "{problem}");
    }
}

/// The law of any message.
pub(crate) fn message(text: &str) {
    assert!(!text.trim().is_empty(), "an error says something");
    assert!(text.len() <= LONGEST, "{} bytes", text.len());
    let raw = |letter: &char| *letter != '\n' && is_unprintable(*letter);
    assert!(!text.chars().any(|letter| raw(&letter)), "{text:?}");
}

/// The law of several messages.
pub(crate) fn messages<T: std::fmt::Display>(shown: impl IntoIterator<Item = T>) {
    for one in shown {
        message(&one.to_string());
    }
}
