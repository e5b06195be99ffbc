//! Words of the command line that stand for names, elements and schedules.

use crate::spec::{DriftSchedule, Element, sound_name};

/// A name that a scenario may have.
pub(super) fn name(text: &str) -> Result<String, String> {
    sound_name(text).map(|()| text.to_owned())
}

/// An element by its letter or name.
pub(super) fn element(text: &str) -> Result<Element, String> {
    Element::ALL
        .into_iter()
        .find(|element| element.letter().eq_ignore_ascii_case(text) || element.name() == text)
        .ok_or_else(|| "expected state, action, transition, reward or observation".to_owned())
}

/// A schedule, as `sample` writes them.
pub(super) fn schedule(text: &str) -> Result<DriftSchedule, String> {
    let number = |word: &str| text.strip_prefix(word)?.parse().ok().filter(|number| *number > 0);
    match text {
        "linear" => Ok(DriftSchedule::Linear),
        "cosine" => Ok(DriftSchedule::Cosine),
        _ => number("step:")
            .map(DriftSchedule::Steps)
            .or_else(|| number("sawtooth:").map(DriftSchedule::Sawtooth))
            .ok_or_else(|| "expected linear, cosine, step:N or sawtooth:N, such as step:4".to_owned()),
    }
}
