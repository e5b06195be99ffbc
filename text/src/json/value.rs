//! Parses JSON within limits on the number of values and the length of keys, and can refuse repeated keys. Reserves no more
//! memory than it needs: otherwise nested lists would take ten times as much.

use std::cell::{Cell, RefCell};
use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};
use serde_json::{Map, Value};

use super::MAX_KEY_BYTES;

/// Why parsing stopped early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// A key is repeated in one object.
    Repeated,
    /// There are more values than allowed.
    TooMany,
    /// A key is longer than [`MAX_KEY_BYTES`].
    LongKey,
}

/// How to treat a key that is repeated in one object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Repeats {
    /// Stop parsing.
    Stop,
    /// The last one counts.
    LastCounts,
}

/// Parses a JSON text with at most `most` values.
///
/// # Errors
/// The parser's error, and the reason if a limit stopped it.
pub fn parse(text: &str, most: usize, repeats: Repeats) -> Result<Value, (serde_json::Error, Option<Stop>)> {
    let builder = Builder {
        left: Cell::new(most),
        most,
        stop: Cell::new(None),
        repeats,
        entries: RefCell::new(Vec::new()),
    };
    let mut parser = serde_json::Deserializer::from_str(text);
    let built = (&mut parser).deserialize_any(AnyValue(&builder));
    let result = built.and_then(|value| parser.end().map(|()| value));
    result.map_err(|error| (error, builder.stop.get()))
}

struct Builder {
    /// Values still allowed, including the outermost.
    left: Cell<usize>,
    most: usize,
    stop: Cell<Option<Stop>>,
    repeats: Repeats,
    /// Entries of the open objects: an object is built once its size is known.
    entries: RefCell<Vec<(String, Value)>>,
}

impl Builder {
    fn has_read_much(&self) -> bool {
        self.most - self.left.get() > LONG
    }

    fn stop<E: Error>(&self, stop: Stop) -> E {
        self.stop.set(Some(stop));
        E::custom("stopped by a limit")
    }
}

#[derive(Clone, Copy)]
struct AnyValue<'b>(&'b Builder);

impl<'de> DeserializeSeed<'de> for AnyValue<'_> {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, value: D) -> Result<Value, D::Error> {
        let left = self.0.left.get();
        if left <= 1 {
            return Err(self.0.stop(Stop::TooMany));
        }
        self.0.left.set(left - 1);
        value.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for AnyValue<'_> {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("any JSON value")
    }

    fn visit_bool<E>(self, truth: bool) -> Result<Value, E> {
        Ok(Value::Bool(truth))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_u64<E>(self, number: u64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_f64<E>(self, number: f64) -> Result<Value, E> {
        Ok(number.into())
    }

    fn visit_str<E>(self, text: &str) -> Result<Value, E> {
        Ok(text.into())
    }

    fn visit_string<E>(self, text: String) -> Result<Value, E> {
        Ok(text.into())
    }

    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<Value, A::Error> {
        let mut list: Vec<Value> = Vec::new();
        while let Some(item) = items.next_element_seed(self)? {
            if list.len() == list.capacity() {
                // Long lists grow by an eighth: doubling would need twice the memory.
                let more = if list.len() < LONG {
                    list.len().max(4)
                } else {
                    list.len() / 8
                };
                list.reserve_exact(more);
            }
            list.push(item);
        }
        // In a small document the spare capacity does not matter, and shrinking takes time.
        if self.0.has_read_much() {
            list.shrink_to_fit();
        }
        Ok(list.into())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<Value, A::Error> {
        let builder = self.0;
        let first = builder.entries.borrow().len();
        while let Some(key) = entries.next_key::<String>()? {
            if key.len() > MAX_KEY_BYTES {
                return Err(builder.stop(Stop::LongKey));
            }
            let value = entries.next_value_seed(self)?;
            let mut open = builder.entries.borrow_mut();
            open.push((key, value));
            if open.len() - first == LONG {
                break;
            }
        }
        let mut open = builder.entries.borrow_mut();
        let mut map = Map::with_capacity(open.len() - first);
        let is_long = open.len() - first == LONG;
        for (key, value) in open.drain(first..) {
            if map.insert(key, value).is_some() && builder.repeats == Repeats::Stop {
                return Err(builder.stop(Stop::Repeated));
            }
        }
        drop(open);
        if is_long {
            // The rest of a long object goes straight into the map, so that repeated keys are not stored twice.
            while let Some(key) = entries.next_key::<String>()? {
                if key.len() > MAX_KEY_BYTES {
                    return Err(builder.stop(Stop::LongKey));
                }
                let value = entries.next_value_seed(self)?;
                if map.insert(key, value).is_some() && builder.repeats == Repeats::Stop {
                    return Err(builder.stop(Stop::Repeated));
                }
            }
        }
        Ok(map.into())
    }
}

/// Minimum number of items or entries of a long list or object.
const LONG: usize = 4096;

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use serde_json::json;

    fn stopped(text: &str, most: usize) -> Option<Stop> {
        parse(text, most, Repeats::Stop).err().and_then(|(_, stop)| stop)
    }

    #[test]
    fn values_count_towards_the_limit_and_keys_do_not() {
        let text = r#"{"a": [1, {}, "x"], "b": null}"#;
        assert_eq!(stopped(text, 6), None);
        assert_eq!(stopped(text, 5), Some(Stop::TooMany));
        assert_eq!(stopped(&format!("[{}0]", "0,".repeat(9999)), 10_001), None);
        assert_eq!(
            stopped(&format!("[{}0]", "0,".repeat(9999)), 10_000),
            Some(Stop::TooMany)
        );
    }

    #[test]
    fn repeated_or_long_key_stops_parsing() {
        assert_eq!(stopped(r#"{"a": 1, "b": {"a": 1}}"#, 9), None);
        assert_eq!(stopped(r#"{"b": {"a": 1, "a": 1}}"#, 9), Some(Stop::Repeated));
        let many: Vec<String> = (0..5000).map(|key| format!("\"{key}\":0")).collect();
        let twice = |key: usize| format!("{{{},\"{key}\":0}}", many.join(","));
        for key in [0, 4095, 4096, 4999] {
            assert_eq!(stopped(&twice(key), 9999), Some(Stop::Repeated), "{key}");
        }
        assert_eq!(stopped(&twice(5000), 9999), None);
        let long = |length: usize| stopped(&format!("{{\"{}\": 1}}", "k".repeat(length)), 9);
        assert_eq!(
            (long(MAX_KEY_BYTES), long(MAX_KEY_BYTES + 1)),
            (None, Some(Stop::LongKey))
        );
        let last = parse(r#"{"a": 1, "a": 2}"#, 9, Repeats::LastCounts).unwrap();
        assert_eq!(last, json!({"a": 2}));
    }

    #[test]
    fn text_after_the_value_is_refused() {
        assert!(parse("{} 1", 9, Repeats::Stop).is_err());
        assert!(parse("", 9, Repeats::Stop).is_err());
    }

    fn any_json() -> impl Strategy<Value = Value> {
        let leaf = prop_oneof![
            Just(Value::Null),
            any::<bool>().prop_map(Value::from),
            any::<i64>().prop_map(Value::from),
            (-1e300..1e300_f64).prop_map(Value::from),
            ".{0,6}".prop_map(Value::from),
        ];
        leaf.prop_recursive(5, 60, 8, |inner| {
            prop_oneof![
                prop::collection::vec(inner.clone(), 0..8).prop_map(Value::from),
                prop::collection::btree_map(".{0,4}", inner, 0..8)
                    .prop_map(|map| Value::Object(map.into_iter().collect())),
            ]
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(crate::tier::quick_or_full(24, 256)))]

        /// `serde_json`'s own values serve as the oracle.
        #[test]
        fn values_agree_with_serde_json(value in any_json()) {
            let text = value.to_string();
            let read = parse(&text, 1000, Repeats::Stop).map_err(|(error, _)| error.to_string());
            prop_assert_eq!(read, Ok(serde_json::from_str::<Value>(&text).unwrap()));
        }
    }
}
