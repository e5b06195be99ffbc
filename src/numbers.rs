//! Parsers for numbers and words shared by several command line options.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use driftworld_spec::sound_name;
use serde::de::DeserializeOwned;

/// A seed.
pub(crate) fn seed(text: &str) -> Result<u64, String> {
    text.parse()
        .map_err(|_| format!("expected a whole number from 0 to {}", u64::MAX))
}

/// An angle in degrees.
pub(crate) fn degrees(text: &str) -> Result<f64, String> {
    within(
        text,
        |degrees| degrees.abs() <= 1e6,
        "an angle in degrees, from -1000000 to 1000000",
    )
}

/// A share, between 0 and 1.
pub(crate) fn share(text: &str) -> Result<f64, String> {
    within(text, |share| 0.0 < share && share < 1.0, "a share above 0 and below 1")
}

/// A distance, or a tolerance.
pub(crate) fn distance(text: &str) -> Result<f64, String> {
    within(
        text,
        |distance| distance.is_finite() && distance >= 0.0,
        "a number, 0 or more",
    )
}

/// A valid name for a task, a variant or a scenario.
pub(crate) fn name(text: &str) -> Result<String, String> {
    sound_name(text).map(|()| text.to_owned())
}

/// A number that satisfies `is_sound`.
pub(crate) fn within(text: &str, is_sound: impl FnOnce(f64) -> bool, expected: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|number| is_sound(*number));
    number.ok_or_else(|| format!("expected {expected}"))
}

/// Parses words of an enum as in documents. Each may be listed with a help text after a colon.
pub(crate) fn documented<T>(words: &'static [&'static str]) -> impl TypedValueParser<Value = T>
where
    T: DeserializeOwned + Clone + Send + Sync + 'static,
{
    let possible = words.iter().map(|word| match word.split_once(": ") {
        Some((word, help)) => PossibleValue::new(word).help(help),
        None => PossibleValue::new(*word),
    });
    PossibleValuesParser::new(possible).try_map(|word| serde_json::from_value(word.into()))
}
