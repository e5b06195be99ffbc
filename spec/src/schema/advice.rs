//! Advice for values that are almost valid: misspelt names, and numbers or booleans written as strings.

use driftworld_text::{WordKind, removed};
use serde_json::Value;

use crate::Element;
use crate::suggest::nearest;

/// Advice for a word that earlier releases accepted at this place.
pub(super) fn for_removed(pointer: &str, value: &Value) -> Option<String> {
    let kind = match pointer.rsplit('/').next()? {
        "measure" => WordKind::Measure,
        "compare_by" => WordKind::By,
        _ => return None,
    };
    removed(kind, value.as_str()?)
}

/// Advice for a value at a place that allows these JSON Schema types.
pub(super) fn for_types(value: &Value, allows: impl Fn(&str) -> bool) -> Option<String> {
    let text = value.as_str()?.trim();
    if allows("number") || allows("integer") {
        return for_number(text);
    }
    let boolean = match text.to_lowercase().as_str() {
        "yes" | "true" | "on" => true,
        "no" | "false" | "off" => false,
        _ => return None,
    };
    allows("boolean").then(|| format!("write {boolean}, without quotes"))
}

/// Advice for an element of the decision process written as a word instead of its letter: `R` for `reward`.
pub(super) fn for_element(value: &Value) -> Option<String> {
    let word = value.as_str()?.to_lowercase();
    let named = |element: &Element| nearest(&word, [element.name()]).is_some();
    let element = Element::WITH_FINE.into_iter().find(named)?;
    Some(format!("did you mean {:?}?", element.letter()))
}

/// Advice for a single word where a list of such words is expected.
pub(super) fn for_word_of_list(value: &Value, words: &[&str]) -> Option<String> {
    let near = nearest(value.as_str()?, words)?;
    Some(format!("write [{near:?}]"))
}

fn for_number(text: &str) -> Option<String> {
    if let Some(number) = finite(text) {
        return Some(format!("drop the quotes: {number}"));
    }
    let end = text.find(|c: char| !matches!(c, '0'..='9' | '.' | '-' | '+'))?;
    let number = finite(&text[..end])?;
    Some(format!("write only the number: {number}"))
}

fn finite(text: &str) -> Option<f64> {
    text.parse().ok().filter(|number: &f64| number.is_finite())
}

/// The name in lower-case letters, digits and underscores: `max_steps` for `maxSteps` and `max-steps`.
pub(super) fn snake_case(name: &str) -> Option<String> {
    let mut snake = String::new();
    let mut after_lowercase = false;
    for c in name.trim().chars() {
        if c.is_ascii_uppercase() && after_lowercase {
            snake.push('_');
        }
        after_lowercase = c.is_ascii_lowercase() || c.is_ascii_digit();
        match c {
            '-' | ' ' | '.' | '/' => snake.push('_'),
            c => snake.push(c.to_ascii_lowercase()),
        }
    }
    let starts = snake.starts_with(|c: char| c.is_ascii_lowercase());
    let rest = snake.chars().all(|c| matches!(c, 'a'..='z' | '0'..='9' | '_'));
    (starts && rest && snake != name).then_some(snake)
}

/// The known word that shares its beginning with the given one: `param` for `parameter`.
pub(super) fn shares_beginning<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let alike =
        |known: &&&str| word.len().min(known.len()) >= 4 && (word.starts_with(**known) || known.starts_with(word));
    known.iter().filter(alike).max_by_key(|known| known.len()).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn snake_case_converts_names_that_differ_only_in_style() {
        assert_eq!(snake_case("max-steps").as_deref(), Some("max_steps"));
        assert_eq!(snake_case("FindObjects").as_deref(), Some("find_objects"));
        assert_eq!(snake_case("RGB light").as_deref(), Some("rgb_light"));
        assert_eq!(snake_case("3d_maze"), None);
        assert_eq!(snake_case("größe"), None);
    }

    #[test]
    fn quoted_numbers_get_advice_without_quotes() {
        assert_eq!(for_number("+1.50").as_deref(), Some("drop the quotes: 1.5"));
        assert_eq!(for_number("2 m").as_deref(), Some("write only the number: 2"));
        assert_eq!(for_number("many"), None);
        assert_eq!(for_number("inf"), None);
    }
}
