//! Builds errors for glTF files.

use driftworld_text::shortened;

use crate::EnvError;

/// An error about a place in the file: what was found there, and what was expected.
pub(super) fn refuse(place: impl Into<String>, found: impl Into<String>, expected: impl Into<String>) -> EnvError {
    EnvError::BadModel {
        place: place.into(),
        found: found.into(),
        expected: expected.into(),
    }
}

/// The element of a list that an index of the file refers to.
pub(super) fn named<'a, T>(list: &'a [T], index: usize, what: &str, place: &str) -> Result<&'a T, EnvError> {
    let named = list.get(index);
    named.ok_or_else(|| refuse(place, format!("{what} {index}"), one_of(list.len())))
}

/// Refuses counts above a limit.
pub(super) fn at_most(most: usize, found: usize, what: &str, place: &str) -> Result<(), EnvError> {
    if found <= most {
        return Ok(());
    }
    Err(refuse(place, format!("{found} {what}"), format!("at most {most}")))
}

/// The valid indices of a list of this length, for messages.
pub(super) fn one_of(length: usize) -> String {
    match length {
        0 => "none, since there are none".to_owned(),
        1 => "0, the only one".to_owned(),
        length => format!("0 to {}", length - 1),
    }
}

/// Quotes a string from the file for a message, shortened to one line.
pub(super) fn quoted(text: &str) -> String {
    format!("{:?}", shortened(text, 60))
}
