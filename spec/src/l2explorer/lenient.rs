//! What single values of a file may look like beside the plain form: numbers as text, colours in 0..255, words in any case.
//! Which key holds which kind of value is said by `read.rs`; this holds no key of the original.

use serde_json::{Map, Value as Json, json};

use super::read::Reader;

impl Reader {
    /// Numbers that were written as text, alone or in a list.
    pub(super) fn number(&mut self, at: &str, map: &mut Map<String, Json>, key: &str) {
        let Some(value) = map.get_mut(key) else { return };
        let mut found = Vec::new();
        match value {
            Json::Array(items) => items.iter_mut().for_each(|item| found.extend(to_number(item))),
            other => found.extend(to_number(other)),
        }
        for text in found {
            self.warn(format!("{at}/{key}"), format!("the text {text:?} is read as a number"));
        }
    }

    /// Whole numbers that were written as text or with a decimal point; the point says nothing and is not warned about.
    pub(super) fn whole(&mut self, at: &str, map: &mut Map<String, Json>, key: &str) {
        self.number(at, map, key);
        drop_decimal_point(map, key);
    }

    /// Headings of any size, turned into 0..360.
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

    /// Colours in 0..255, which is taken to be so where a channel is above 1.
    pub(super) fn color(&mut self, at: &str, map: &mut Map<String, Json>, key: &str) {
        self.number(at, map, key);
        word(map, key);
        let Some(Json::Array(items)) = map.get_mut(key) else {
            return;
        };
        let Some(channels) = items.iter().map(Json::as_f64).collect::<Option<Vec<f64>>>() else {
            return;
        };
        let bytes = channels.iter().any(|channel| *channel > 1.0);
        *items = channels
            .iter()
            .map(|channel| json!(if bytes { channel / 255.0 } else { *channel }))
            .collect();
        if bytes {
            self.warn(
                format!("{at}/{key}"),
                "a colour with a channel above 1 is read as 0..255",
            );
        }
    }
}

/// Turns text that is a number into that number and hands back the text.
fn to_number(value: &mut Json) -> Option<String> {
    let text = value.as_str()?.to_owned();
    let number = text.trim().parse::<f64>().ok().filter(|number| number.is_finite())?;
    *value = json!(number);
    without_decimal_point(value);
    Some(text)
}

/// Turns a whole number with a decimal point into one without.
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

/// Words in any case, alone or in a list. The words of the original are ASCII; other letters stay as they are, so that a
/// word keeps its length.
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

/// Lists of stimuli: names in any case, with or without underscores; a single name for a list of one.
pub(super) fn stimuli(map: &mut Map<String, Json>, key: &str) {
    let Some(value) = map.get_mut(key) else { return };
    if value.is_string() {
        *value = json!([value.take()]);
    }
    for item in value.as_array_mut().into_iter().flatten() {
        let known = ["AgentCollide", "AgentInteract", "AgentInRange"];
        let plain = |text: &str| text.replace('_', "").to_lowercase();
        let name = item
            .as_str()
            .and_then(|text| known.into_iter().find(|name| plain(name) == plain(text)));
        if let Some(name) = name {
            *item = json!(name);
        }
    }
}
