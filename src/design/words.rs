//! Words of the command line and of Python that stand for elements and schedules.

use driftworld_spec::{DriftSchedule, Element};

/// An element by its letter or name.
///
/// # Errors
/// What was expected.
pub fn element(text: &str) -> Result<Element, String> {
    Element::ALL
        .into_iter()
        .find(|element| element.letter().eq_ignore_ascii_case(text) || element.name() == text)
        .ok_or_else(|| "expected state, action, transition, reward or observation".to_owned())
}

/// A schedule, such as `cosine` or `step:4`.
///
/// # Errors
/// What was expected.
pub fn schedule(text: &str) -> Result<DriftSchedule, String> {
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
