//! Explains why a value is not a valid colour.

use serde_json::Value;

use crate::Color;
use crate::describe::describe;
use crate::error::Problem;

/// Description of a valid colour in messages.
pub(super) const EXPECTED: &str = "a CSS colour name or [r, g, b] in 0..1";

/// The problem with a string or list that is not a colour; `None` for a list of three, where invalid channels are reported one
/// by one.
pub(super) fn problem(pointer: &str, value: &Value) -> Option<Problem> {
    let problem = Problem::new("spec/value", pointer, describe(value), EXPECTED);
    let advised = match value {
        Value::String(text) => match from_hex(text) {
            Some(color) => problem.advise(format!("write {}", triple(color))),
            None => problem.suggest(text, Color::names()),
        },
        Value::Array(items) => match channels(items) {
            Some(bytes) if are_bytes(&bytes) => {
                let color = [bytes[0], bytes[1], bytes[2]].map(|byte| byte / 255.0);
                problem.advise(format!("divide by 255: {}", triple(color)))
            }
            Some(four) if four.len() == 4 => {
                problem.advise("remove the fourth number: colours here are never transparent")
            }
            _ if items.len() == 3 => return None,
            _ => problem,
        },
        _ => problem,
    };
    Some(advised)
}

/// The numbers of a list of three or four numbers.
fn channels(items: &[Value]) -> Option<Vec<f64>> {
    let numbers: Vec<f64> = items.iter().map(Value::as_f64).collect::<Option<_>>()?;
    matches!(numbers.len(), 3 | 4).then_some(numbers)
}

fn are_bytes(channels: &[f64]) -> bool {
    channels.iter().all(|channel| (0.0..=255.0).contains(channel)) && channels.iter().any(|channel| *channel >= 2.0)
}

/// The colour of `#f00` or `#ff0000`, with or without the hash.
fn from_hex(text: &str) -> Option<[f64; 3]> {
    let digits = text.trim().trim_start_matches('#');
    if !digits.chars().all(|c| c.is_ascii_hexdigit()) {
        return None;
    }
    let color: palette::Srgb<u8> = digits.parse().ok()?;
    Some([color.red, color.green, color.blue].map(|byte| f64::from(byte) / 255.0))
}

fn triple(color: [f64; 3]) -> String {
    let [red, green, blue] = color.map(|channel| (channel * 1000.0).round() / 1000.0);
    format!("[{red}, {green}, {blue}]")
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[track_caller]
    fn check(value: &Value, expected: Option<&str>) {
        let problem = problem("/color", value).unwrap();
        assert_eq!(problem.advice.as_deref(), expected, "{value}");
    }

    #[test]
    fn other_colour_notations_get_advice() {
        check(&json!("#ff0000"), Some("write [1, 0, 0]"));
        check(&json!("#0f8"), Some("write [0, 1, 0.533]"));
        check(&json!("bleu"), Some("did you mean \"blue\"?"));
        check(&json!([255, 0, 51]), Some("divide by 255: [1, 0, 0.2]"));
        check(
            &json!([1, 0, 0, 1]),
            Some("remove the fourth number: colours here are never transparent"),
        );
        check(&json!([1, 0]), None);
        assert!(problem("/color", &json!([1.2, 0, 0])).is_none());
    }
}
