//! Repairs entries of the original's keys that are empty, incomplete or of the wrong type: each keeps its readable part or gets
//! the default, with a warning. Values out of range and our own keys are not repaired; they are checked as in our documents.

use serde_json::{Map, Value as Json, json};

use super::reader::Reader;
use crate::color::Color;
use crate::describe::describe;
use crate::schema::part;
use crate::world::World;

/// The required form of an entry.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Entry {
    /// A number within limits.
    Number(f64, f64),
    /// An integer within limits.
    Whole(f64, f64),
    /// Two numbers within limits.
    Pair(f64, f64),
    /// One of a list of words.
    Word(Vec<String>),
    /// A colour: three numbers in 0..1, or a name.
    Color,
    /// A string of 1 to 100 characters.
    Text,
    /// A string of 1 to 100 characters, or a whole number.
    Model,
}

/// Maximum length of a string in characters.
const MAX_CHARACTERS: usize = 100;

/// Largest model number.
const MAX_MODEL: u64 = 1_000_000;

impl Entry {
    /// The form that a world's schema requires of a property; `None` for parts and for lists of words.
    pub(super) fn of(property: &Json) -> Option<Self> {
        let named = property["anyOf"].get(0).unwrap_or(property)["$ref"].as_str();
        match named.and_then(|path| path.rsplit('/').next()) {
            Some("Color") => return Some(Self::Color),
            Some("Model") => return Some(Self::Model),
            _ => {}
        }
        let value = part::at(World::schema().json(), property, "")?;
        let limits = |value: &Json| Some((value["minimum"].as_f64()?, value["maximum"].as_f64()?));
        let is = |name: &str| value["type"] == name || value["type"][0] == name;
        if is("number") {
            limits(value).map(|(low, high)| Self::Number(low, high))
        } else if is("integer") {
            limits(value).map(|(low, high)| Self::Whole(low, high))
        } else if is("string") {
            Some(Self::Text)
        } else if value["maxItems"] == 2 {
            limits(&value["items"]).map(|(low, high)| Self::Pair(low, high))
        } else {
            let words = value["oneOf"].as_array()?.iter();
            let words = words.map(|form| form["const"].as_str().map(str::to_owned));
            words.collect::<Option<_>>().map(Self::Word)
        }
    }
}

impl Reader {
    /// Repairs one entry; `default` is its default, if it has one.
    pub(super) fn mend_entry(
        &mut self,
        at: &str,
        map: &mut Map<String, Json>,
        (key, entry): (&str, &Entry),
        default: Option<&Json>,
    ) {
        let Some(value) = map.get_mut(key) else { return };
        if value.is_null() && matches!(key, "color" | "unique_name") {
            return;
        }
        let found = describe(value);
        let assumed = match entry.repaired(value, default) {
            Some(repaired) if is_same(&repaired, value) => return,
            Some(repaired) => {
                *value = repaired;
                format!("{} is assumed", plain(value))
            }
            None => {
                map.shift_remove(key);
                match (key, default) {
                    ("color", _) => "the asset's own colours are assumed".to_owned(),
                    (_, Some(default)) => format!("the default {} is assumed", plain(default)),
                    (_, None) => "it is left out".to_owned(),
                }
            }
        };
        let expected = entry.expected();
        self.warn(
            format!("{at}/{key}"),
            format!("found {found}, expected {expected}; {assumed}"),
        );
    }

    /// A part of the file, if it is an object; anything else is dropped with a warning.
    pub(super) fn part(&mut self, map: &mut Map<String, Json>, key: &str) -> Option<Map<String, Json>> {
        match map.get_mut(key)? {
            // The caller reinserts the repaired part.
            Json::Object(part) => Some(std::mem::take(part)),
            other => {
                self.warn_instead(format!("/{key}"), other, "an object; its defaults are assumed");
                map.shift_remove(key);
                None
            }
        }
    }
}

impl Entry {
    fn expected(&self) -> String {
        match self {
            Self::Number(low, high) => format!("a number from {low} to {high}"),
            Self::Whole(low, high) => format!("a whole number from {low} to {high}"),
            Self::Pair(low, high) => format!("two numbers from {low} to {high}"),
            Self::Word(words) => format!("one of {}", words.join(", ")),
            Self::Color => "a colour of three numbers in 0..1".to_owned(),
            Self::Text => format!("a string of 1 to {MAX_CHARACTERS} characters"),
            Self::Model => format!("a string of 1 to {MAX_CHARACTERS} characters, or a whole number up to {MAX_MODEL}"),
        }
    }

    /// The repaired value, equal to the original if that is valid; `None` if nothing can be recovered.
    fn repaired(&self, value: &Json, default: Option<&Json>) -> Option<Json> {
        match self {
            Self::Number(..) => value.is_number().then(|| value.clone()),
            Self::Whole(..) => whole(value),
            Self::Pair(..) => pair(value, default),
            Self::Word(words) => value
                .as_str()
                .filter(|word| words.iter().any(|known| known == word))
                .map(|word| json!(word)),
            Self::Color => color(value),
            Self::Text => text(value),
            Self::Model if value.is_u64() => Some(value.clone()),
            Self::Model => value.as_str().and_then(|_| text(value)),
        }
    }
}

/// A number, rounded to an integer.
fn whole(value: &Json) -> Option<Json> {
    let number = value.as_f64()?;
    let has_fraction = number.fract() != 0.0;
    Some(if has_fraction {
        json!(number.round() as i64)
    } else {
        value.clone()
    })
}

/// Whether two values are equal, comparing numbers by value.
fn is_same(a: &Json, b: &Json) -> bool {
    match (a, b) {
        (Json::Number(x), Json::Number(y)) => x.as_f64() == y.as_f64(),
        (Json::Array(a), Json::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_same(a, b)),
        _ => a == b,
    }
}

/// The first two numbers of a list, with defaults replacing anything else. `None` if neither is a number.
fn pair(value: &Json, default: Option<&Json>) -> Option<Json> {
    let items = value.as_array()?;
    let number = |axis: usize| items.get(axis).filter(|item| item.is_number());
    number(0).or(number(1))?;
    let own = |axis: usize| default.and_then(|default| default.get(axis));
    Some(
        [0, 1]
            .map(|axis| number(axis).or(own(axis)).cloned().unwrap_or(json!(0)))
            .into(),
    )
}

/// The first three numbers of a list, or a known name.
fn color(value: &Json) -> Option<Json> {
    match value {
        Json::String(name) => Color::from_name(name).map(|_| value.clone()),
        Json::Array(items) => {
            let channels = items.get(..3)?;
            channels.iter().all(Json::is_number).then(|| json!(channels))
        }
        _ => None,
    }
}

/// A string that is not empty; a number as a string.
fn text(value: &Json) -> Option<Json> {
    let text = match value {
        Json::String(text) => text.clone(),
        Json::Number(number) => number.to_string(),
        _ => return None,
    };
    (!text.is_empty()).then(|| json!(text))
}

/// A readable form of a value: integers without a decimal point.
fn plain(value: &Json) -> String {
    match value {
        Json::Number(number) => number
            .as_f64()
            .map_or_else(|| number.to_string(), |number| number.to_string()),
        Json::Array(items) => format!("[{}]", items.iter().map(plain).collect::<Vec<String>>().join(", ")),
        other => describe(other),
    }
}
