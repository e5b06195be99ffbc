//! [`TopLevel`]: which keys a JSON text has, found out without taking its values into memory.
//! What they tell is `contents`' and `documents`'.

use std::collections::BTreeMap;

use driftworld_spec::MAX_BYTES;
use serde_json::value::RawValue;

/// The keys of an object.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct TopLevel {
    /// Each with whether a list stands there, the last of two with one name.
    keys: BTreeMap<String, bool>,
}

impl TopLevel {
    /// Of a text; `None` for one that is no JSON object, or longer than any document may be.
    pub(crate) fn of(text: &str) -> Option<Self> {
        let text = text.trim_start_matches('\u{feff}');
        if text.len() > MAX_BYTES {
            return None;
        }
        let entries: BTreeMap<String, &RawValue> = serde_json::from_str(text).ok()?;
        let is_list = |value: &RawValue| value.get().starts_with('[');
        let keys = entries.into_iter().map(|(key, value)| (key, is_list(value)));
        Some(Self { keys: keys.collect() })
    }

    /// Whether there is such a key.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.keys.contains_key(key)
    }

    /// Whether there is any of these keys.
    pub(crate) fn has_any(&self, keys: &[&str]) -> bool {
        keys.iter().any(|key| self.has(key))
    }

    /// Whether these are the keys of a scenario in the original's form.
    pub(crate) fn is_l2explorer_scenario(&self) -> bool {
        self.keys.get("scenario") == Some(&true) && !self.has("blocks")
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
