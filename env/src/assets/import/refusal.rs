//! What is said where a glTF file is refused.

use driftworld_text::shortened;

use crate::EnvError;

/// What is found at a place of a file, and what was expected.
pub(super) fn refuse(place: impl Into<String>, found: impl Into<String>, expected: impl Into<String>) -> EnvError {
    EnvError::BadModel {
        place: place.into(),
        found: found.into(),
        expected: expected.into(),
    }
}

/// What an index of the file names in a list of it.
pub(super) fn named<'a, T>(list: &'a [T], index: usize, what: &str, place: &str) -> Result<&'a T, EnvError> {
    let named = list.get(index);
    named.ok_or_else(|| refuse(place, format!("{what} {index}"), one_of(list.len())))
}

/// Refuses more of something than there may be.
pub(super) fn at_most(most: usize, found: usize, what: &str, place: &str) -> Result<(), EnvError> {
    if found <= most {
        return Ok(());
    }
    Err(refuse(place, format!("{found} {what}"), format!("at most {most}")))
}

/// The numbers that a list of this length has.
pub(super) fn one_of(length: usize) -> String {
    match length {
        0 => "none, for there are none".to_owned(),
        1 => "0, the only one".to_owned(),
        length => format!("0 to {}", length - 1),
    }
}

/// A text of a file as it is quoted in a message: never more than a line of it.
pub(super) fn quoted(text: &str) -> String {
    format!("{:?}", shortened(text, 60))
}
