//! [`TopLevel`]: finds the keys of a JSON text without loading its values.

use std::collections::BTreeMap;

use driftworld_spec::MAX_BYTES;
use serde_json::value::RawValue;

/// The keys of an object.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct TopLevel {
    /// Whether the value of each key is a list; of repeated keys, the last one counts.
    keys: BTreeMap<String, bool>,
}

impl TopLevel {
    /// The keys of a text; `None` if it is not a JSON object, or is longer than any document may be.
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

    /// Whether the object has this key.
    pub(crate) fn has(&self, key: &str) -> bool {
        self.keys.contains_key(key)
    }

    /// Whether the object has any of these keys.
    pub(crate) fn has_any(&self, keys: &[&str]) -> bool {
        keys.iter().any(|key| self.has(key))
    }

    /// Whether these are the keys of a scenario in L2Explorer's format.
    pub(crate) fn is_l2explorer_scenario(&self) -> bool {
        self.keys.get("scenario") == Some(&true) && !self.has("blocks")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_top_level_keys_are_found() {
        let keys =
            TopLevel::of("\u{feff} { \"a\": { \"blocks\": 1 }, \"maps\": [[{}]], \"n\\u0061me\": \"x\" }").unwrap();
        assert!(keys.has("maps") && keys.has("name") && !keys.has("blocks"));
        assert!(!keys.is_l2explorer_scenario());
        assert_eq!(TopLevel::of("[{\"name\": 1}]"), None);
        assert_eq!(TopLevel::of("{\"name\": 1"), None);
        assert_eq!(TopLevel::of("{} {}"), None);
    }

    #[test]
    fn l2explorer_scenario_is_a_list() {
        let is_one = |text: &str| TopLevel::of(text).is_some_and(|keys| keys.is_l2explorer_scenario());
        assert!(is_one("{\"scenario\": []}"));
        assert!(!is_one("{\"scenario\": {}}"));
        assert!(!is_one("{\"scenario\": [], \"blocks\": 1}"));
    }
}
