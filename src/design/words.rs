//! Parses the words of design options, such as elements and schedules, from the command line and from Python.

use clap::ValueEnum;
use driftworld_spec::{By, DriftSchedule, Element, did_you_mean};
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use serde_json::Value;

use crate::numbers;
use crate::request::read;

/// What switches at random in a drift.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Mix {
    /// Each parameter that cannot be interpolated by itself.
    Parameter,
    /// The whole variant: each world is of one of the two.
    Task,
}

/// Python's `True`, `False` or `"task"`.
pub(super) fn mix<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Mix>, D::Error> {
    match Value::deserialize(deserializer)? {
        Value::Null | Value::Bool(false) => Ok(None),
        Value::Bool(true) => Ok(Some(Mix::Parameter)),
        Value::String(word) if word == "task" => Ok(Some(Mix::Task)),
        _ => Err(D::Error::custom("expected True, False or \"task\"")),
    }
}

pub(super) fn by<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<By>, D::Error> {
    read(deserializer, By::from_name).map(Some)
}

pub(super) fn probe<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Element>, D::Error> {
    read(deserializer, element).map(Some)
}

pub(super) fn drift<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<DriftSchedule>, D::Error> {
    read(deserializer, schedule).map(Some)
}

pub(super) fn name<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    read(deserializer, numbers::name)
}

/// An element by its letter or name.
///
/// # Errors
/// If the text is none of the expected words; the message lists these.
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
/// If the text is none of the expected words; the message lists these.
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
