//! Reads single values leniently: numbers as strings, colours in 0..255, words in any case.

use serde_json::{Map, Value as Json, json};

use super::reader::Reader;
use crate::describe::describe;

impl Reader {
    /// Converts numbers written as strings, alone or in a list.
    pub(super) fn number(&mut self, at: &str, map: &mut Map<String, Json>, key: &str) {
        let Some(value) = map.get_mut(key) else { return };
        let mut found = Vec::new();
        match value {
            Json::Array(items) => items.iter_mut().for_each(|item| found.extend(to_number(item))),
            other => found.extend(to_number(other)),
        }
        // Two items with the same text give one warning.
        found.dedup();
        for text in found {
            self.warn(format!("{at}/{key}"), format!("the text {text:?} is read as a number"));
        }
    }

    /// Converts integers written as strings or with a decimal point; the decimal point alone gives no warning.
    pub(super) fn whole(&mut self, at: &str, map: &mut Map<String, Json>, key: &str) {
        self.number(at, map, key);
        drop_decimal_point(map, key);
    }

    /// Wraps headings of any size into 0..360.
    pub(super) fn heading(&mut self, at: &str, map: &mut Map<String, Json>) {
        let Some(heading) = map.get("heading").and_then(Json::as_f64) else {
            return;
        };
        if !(0.0..=360.0).contains(&heading) {
            let turned = heading.rem_euclid(360.0);
            self.warn(
                format!("{at}/heading"),
                format!("the heading {heading} is read as {turned}"),
            );
            map.insert("heading".into(), json!(turned));
        }
    }

    /// Normalises a list of stimuli: names in any case, with or without underscores; a single name counts as a list of one.
    /// Synonyms are accepted with a warning; unknown names are dropped with a warning.
    pub(super) fn stimuli(&mut self, at: &str, map: &mut Map<String, Json>, key: &str) {
        let Some(value) = map.get_mut(key) else { return };
        let place = format!("{at}/{key}");
        let items = match value.take() {
            Json::Array(items) => items,
            Json::String(word) if !word.is_empty() => vec![json!(word)],
            other => {
                self.warn_instead(place, &other, "a list of stimuli; none is assumed");
                map.shift_remove(key);
                return;
            }
        };
        let mut names: Vec<&str> = Vec::new();
        for (index, item) in items.iter().enumerate() {
            let word = item.as_str().unwrap_or_default();
            let found = describe(item);
            let at = place_of(&place, index, items.len());
            match stimulus(word) {
                Some(name) if names.contains(&name) => {
                    let text = format!("{found} is already in the list and is left out");
                    self.warn(format!("{place}/{index}"), text);
                }
                Some(name) => {
                    // A name that differs only in case and underscores needs no warning.
                    if !word.replace('_', "").eq_ignore_ascii_case(name) {
                        self.warn(at, format!("{found} is read as {name:?}"));
                    }
                    names.push(name);
                }
                None => {
                    let expected = "expected AgentCollide, AgentInteract or AgentInRange; it is left out";
                    self.warn(at, format!("found {found}, {expected}"));
                }
            }
        }
        map.insert(key.to_owned(), json!(names));
    }

    /// Converts colours from 0..255, which is assumed if a channel is above 1.
    pub(super) fn color(&mut self, at: &str, map: &mut Map<String, Json>, key: &str) {
        self.number(at, map, key);
        word(map, key);
        let Some(Json::Array(items)) = map.get_mut(key) else {
            return;
        };
        let Some(channels) = items.iter().map(Json::as_f64).collect::<Option<Vec<f64>>>() else {
            return;
        };
        let is_0_to_255 = channels.len() >= 3 && channels.iter().any(|channel| *channel > 1.0);
        if is_0_to_255 {
            *items = channels.iter().map(|channel| json!(channel / 255.0)).collect();
            self.warn(
                format!("{at}/{key}"),
                "a colour with a channel above 1 is read as 0..255",
            );
        }
    }
}

/// The pointer to an item of a list; a list of one may be written as the item alone, which then has the list's pointer.
fn place_of(list: &str, index: usize, len: usize) -> String {
    if len == 1 {
        list.to_owned()
    } else {
        format!("{list}/{index}")
    }
}

/// Converts a string to a number if possible, and returns the string.
fn to_number(value: &mut Json) -> Option<String> {
    let text = value.as_str()?.to_owned();
    let number = text.trim().parse::<f64>().ok().filter(|number| number.is_finite())?;
    *value = json!(number);
    without_decimal_point(value);
    Some(text)
}

/// Removes the decimal point from an integer.
pub(super) fn drop_decimal_point(map: &mut Map<String, Json>, key: &str) {
    if let Some(value) = map.get_mut(key) {
        without_decimal_point(value);
    }
}

fn without_decimal_point(value: &mut Json) {
    let whole = value
        .as_f64()
        .filter(|number| value.is_f64() && number.fract() == 0.0 && number.abs() < 1e15);
    if let Some(number) = whole {
        *value = json!(number as i64);
    }
}

/// Converts words to lower case, alone or in a list. The original's words are ASCII; other characters stay as they are, so that
/// a word keeps its length.
pub(super) fn word(map: &mut Map<String, Json>, key: &str) {
    let lower = |value: &mut Json| {
        if let Json::String(text) = value {
            text.make_ascii_lowercase();
        }
    };
    match map.get_mut(key) {
        Some(Json::Array(items)) => items.iter_mut().for_each(lower),
        Some(value) => lower(value),
        None => {}
    }
}

/// The stimulus meant by a word of the original or a common synonym, in any case and with or without underscores.
pub(super) fn stimulus(word: &str) -> Option<&'static str> {
    let plain = word.replace(['_', '-', ' '], "").to_lowercase();
    let bare = plain.strip_prefix("agent").unwrap_or(&plain);
    match bare {
        "collide" | "collision" | "contact" | "touch" => Some("AgentCollide"),
        "interact" | "interaction" | "pickup" => Some("AgentInteract"),
        "inrange" | "range" => Some("AgentInRange"),
        _ => None,
    }
}
