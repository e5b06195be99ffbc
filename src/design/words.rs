//! Parses words for elements and schedules, from the command line and from Python.

use driftworld_spec::{DriftSchedule, Element, did_you_mean};

/// An element by its letter or name.
///
/// # Errors
/// The expected words.
pub fn element(text: &str) -> Result<Element, String> {
    let is_meant =
        |element: &Element| element.letter().eq_ignore_ascii_case(text) || element.name().eq_ignore_ascii_case(text);
    Element::ALL.into_iter().find(is_meant).ok_or_else(|| {
        let near = did_you_mean(text, Element::ALL.map(Element::name));
        format!("expected state, action, transition, reward or observation, or the letter S, A, T, R or O{near}")
    })
}

/// A schedule, such as `cosine` or `step:4`.
///
/// # Errors
/// The expected words.
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
