//! How many values a JSON text has, found out without taking any of them into memory.
//!
//! Not here: reading them.

use std::cell::Cell;
use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, Error, MapAccess, SeqAccess, Visitor};

/// The values of a JSON text, up to one more than `most`: then there is no use in going on.
///
/// # Errors
/// Those of the parser.
pub(super) fn count(text: &[u8], most: u64) -> Result<u64, serde_json::Error> {
    let found = Cell::new(0);
    let mut parser = serde_json::Deserializer::from_slice(text);
    let counted = Values { found: &found, most }.deserialize(&mut parser);
    if found.get() > most {
        return Ok(found.get());
    }
    counted?;
    parser.end()?;
    Ok(found.get())
}

#[derive(Clone, Copy)]
struct Values<'c> {
    found: &'c Cell<u64>,
    most: u64,
}

impl<'de> DeserializeSeed<'de> for Values<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, value: D) -> Result<(), D::Error> {
        self.found.set(self.found.get() + 1);
        if self.found.get() > self.most {
            return Err(D::Error::custom("too many values"));
        }
        value.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Values<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("any JSON value")
    }

    fn visit_bool<E>(self, _: bool) -> Result<(), E> {
        Ok(())
    }

    fn visit_i64<E>(self, _: i64) -> Result<(), E> {
        Ok(())
    }

    fn visit_u64<E>(self, _: u64) -> Result<(), E> {
        Ok(())
    }

    fn visit_f64<E>(self, _: f64) -> Result<(), E> {
        Ok(())
    }

    fn visit_str<E>(self, _: &str) -> Result<(), E> {
        Ok(())
    }

    fn visit_unit<E>(self) -> Result<(), E> {
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut items: A) -> Result<(), A::Error> {
        while items.next_element_seed(self)?.is_some() {}
        Ok(())
    }

    fn visit_map<A: MapAccess<'de>>(self, mut entries: A) -> Result<(), A::Error> {
        while entries.next_key::<serde::de::IgnoredAny>()?.is_some() {
            entries.next_value_seed(self)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_counts_and_keys_do_not() {
        let check = |text: &str, expected: u64| assert_eq!(count(text.as_bytes(), 9).unwrap(), expected, "{text}");
        check("0", 1);
        check("[]", 1);
        check(r#"{"a": [1, -2, 3.5, "x", true, null], "b": {}}"#, 9);
        check("[0,0,0,0,0,0,0,0,0,0,0,0", 10);
        assert!(count(b"[0", 9).is_err());
        assert!(count(b"[0] 1", 9).is_err());
    }
}
