//! [`TopLevel`]: which of the keys that tell documents apart a JSON text has, found out without taking it into memory.
//! What they tell is `contents`' and `documents`'.

use std::fmt;

use driftworld_spec::MAX_BYTES;
use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, de};

/// The keys that tell documents apart.
const TELLING: [&str; 22] = [
    "version",
    "name",
    "blocks",
    "scenario",
    "maps",
    "labels",
    "values",
    "metrics_columns",
    "scenario_type",
    "perf_measure",
    "maintenance_method",
    "transfer_method",
    "normalization_method",
    "parameters",
    "groups",
    "variants",
    "world",
    "environment_params",
    "agent_params",
    "objects",
    "image_params",
    "game_mode",
];

/// The telling keys of an object.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct TopLevel {
    /// Each with whether a list stands there.
    found: Vec<(&'static str, bool)>,
}

impl TopLevel {
    /// Of a text; `None` for one that is no JSON object, or longer than any document may be.
    pub(crate) fn of(text: &str) -> Option<Self> {
        let text = text.trim_start_matches('\u{feff}');
        if text.len() > MAX_BYTES || !text.trim_start().starts_with('{') {
            return None;
        }
        serde_json::from_str(text).ok()
    }

    /// Whether there is such a key.
    ///
    /// Only keys that tell documents apart are known.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.found.iter().any(|(found, _)| *found == key)
    }

    /// Whether there is any of these keys.
    pub(crate) fn has_any(&self, keys: &[&str]) -> bool {
        keys.iter().any(|key| self.has(key))
    }

    /// Whether these are the keys of a scenario in the original's form.
    pub(crate) fn is_l2explorer_scenario(&self) -> bool {
        self.found.contains(&("scenario", true)) && !self.has("blocks")
    }
}

impl<'de> Deserialize<'de> for TopLevel {
    fn deserialize<D: Deserializer<'de>>(document: D) -> Result<Self, D::Error> {
        document.deserialize_map(Keys)
    }
}

struct Keys;

impl<'de> Visitor<'de> for Keys {
    type Value = TopLevel;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("an object")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<TopLevel, A::Error> {
        let mut keys = TopLevel::default();
        while let Some(Telling(key)) = entries.next_key()? {
            let is_list = entries.next_value_seed(IsList)?;
            if let Some(key) = key {
                // Of two of one key the last counts.
                keys.found.retain(|(found, _)| *found != key);
                keys.found.push((key, is_list));
            }
        }
        Ok(keys)
    }
}

/// A key, if it is one that tells.
struct Telling(Option<&'static str>);

impl<'de> Deserialize<'de> for Telling {
    fn deserialize<D: Deserializer<'de>>(key: D) -> Result<Self, D::Error> {
        struct Key;
        impl Visitor<'_> for Key {
            type Value = Telling;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a key")
            }

            fn visit_str<E: de::Error>(self, key: &str) -> Result<Telling, E> {
                Ok(Telling(TELLING.into_iter().find(|known| *known == key)))
            }
        }
        key.deserialize_str(Key)
    }
}

/// Whether a value is a list; nothing of it is kept.
struct IsList;

impl<'de> DeserializeSeed<'de> for IsList {
    type Value = bool;

    fn deserialize<D: Deserializer<'de>>(self, value: D) -> Result<bool, D::Error> {
        value.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for IsList {
    type Value = bool;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("any JSON value")
    }

    fn visit_bool<E>(self, _: bool) -> Result<bool, E> {
        Ok(false)
    }

    fn visit_i64<E>(self, _: i64) -> Result<bool, E> {
        Ok(false)
    }

    fn visit_u64<E>(self, _: u64) -> Result<bool, E> {
        Ok(false)
    }

    fn visit_f64<E>(self, _: f64) -> Result<bool, E> {
        Ok(false)
    }

    fn visit_str<E>(self, _: &str) -> Result<bool, E> {
        Ok(false)
    }

    fn visit_unit<E>(self) -> Result<bool, E> {
        Ok(false)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<bool, A::Error> {
        while items.next_element::<IgnoredAny>()?.is_some() {}
        Ok(true)
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<bool, A::Error> {
        while entries.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
        Ok(false)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_found_at_the_top_level_only() {
        let keys =
            TopLevel::of("\u{feff} { \"a\": { \"blocks\": 1 }, \"maps\": [[{}]], \"n\\u0061me\": \"x\" }").unwrap();
        assert!(keys.has("maps") && keys.has("name") && !keys.has("blocks"));
        assert!(!keys.is_l2explorer_scenario());
        assert_eq!(TopLevel::of("[{\"name\": 1}]"), None);
        assert_eq!(TopLevel::of("{\"name\": 1"), None);
        assert_eq!(TopLevel::of("{} {}"), None);
    }

    #[test]
    fn a_scenario_of_the_originals_is_a_list() {
        let is_one = |text: &str| TopLevel::of(text).is_some_and(|keys| keys.is_l2explorer_scenario());
        assert!(is_one("{\"scenario\": []}"));
        assert!(!is_one("{\"scenario\": {}}"));
        assert!(!is_one("{\"scenario\": [], \"blocks\": 1}"));
    }
}
