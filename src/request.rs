//! Requests: one struct per operation, whose fields are both the command's arguments (clap) and Python's keywords (serde).

use std::fmt::Display;
use std::str::FromStr;

use clap::{Args, Command};
use serde::Deserialize;
use serde::de::value::Error;
use serde::de::{DeserializeOwned, Deserializer, Error as _, Visitor};

/// The names of a request's fields, as keywords.
pub fn names<R: DeserializeOwned>() -> &'static [&'static str] {
    let mut names: &[&str] = &[];
    // Ends with an error as soon as the names are known.
    let _ = R::deserialize(Names(&mut names));
    names
}

/// The names of a request's fields, each with the default in the command's help, if it has one there.
pub fn defaults<R: Args + DeserializeOwned>() -> Vec<(&'static str, Option<String>)> {
    let command = R::augment_args(Command::new("request"));
    let default = |name: &str| {
        let argument = command.get_arguments().find(|argument| argument.get_id() == name)?;
        let default = argument.get_default_values().first()?;
        Some(default.to_string_lossy().into_owned())
    };
    names::<R>().iter().map(|name| (*name, default(name))).collect()
}

/// A request with the defaults that the command's help shows.
pub(crate) fn usual<R: Args>() -> R {
    let command = R::augment_args(Command::new("request")).mut_args(|argument| argument.required(false));
    let matches = command.try_get_matches_from([] as [&str; 0]);
    let request = matches.and_then(|matches| R::from_arg_matches(&matches));
    request.expect("each argument has a default or is optional")
}

/// Deserialises a word with a parsing function.
pub(crate) fn read<'de, D: Deserializer<'de>, T, E: Display>(
    deserializer: D,
    of: impl FnOnce(&str) -> Result<T, E>,
) -> Result<T, D::Error> {
    of(&String::deserialize(deserializer)?).map_err(D::Error::custom)
}

/// Deserialises a word with its type's `FromStr`.
pub(crate) fn word<'de, D: Deserializer<'de>, T: FromStr<Err: Display>>(
    deserializer: D,
) -> Result<Option<T>, D::Error> {
    read(deserializer, T::from_str).map(Some)
}

/// Asks a struct for the names of its fields.
struct Names<'a>(&'a mut &'static [&'static str]);

impl<'de> Deserializer<'de> for Names<'_> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Error> {
        Err(Error::custom("only structs have named fields"))
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        name: &'static str,
        fields: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, Error> {
        *self.0 = fields;
        Err(Error::custom(name))
    }

    serde::forward_to_deserialize_any! {
        bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit unit_struct newtype_struct
        seq tuple tuple_struct map enum identifier ignored_any
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A request to which a field was `added`.
    #[derive(Args, serde::Deserialize, Debug, PartialEq)]
    #[serde(default, deny_unknown_fields)]
    struct Fixture {
        /// Number of trials.
        #[arg(long, default_value_t = 3)]
        known: u32,
        /// What was added.
        #[arg(long, default_value_t = 0.5)]
        added: f64,
    }

    impl Default for Fixture {
        fn default() -> Self {
            usual()
        }
    }

    #[test]
    fn added_field_appears_in_the_help_the_keywords_and_the_defaults() {
        let help = Fixture::augment_args(Command::new("fixture")).render_help().to_string();
        assert!(
            help.contains("--added <ADDED>  What was added [default: 0.5]"),
            "{help}"
        );
        let filled = serde_json::from_str::<Fixture>(r#"{"added": 2}"#).expect("these are its fields");
        assert_eq!(filled, Fixture { known: 3, added: 2.0 });
        let defaults = defaults::<Fixture>();
        let expected = [("known", "3"), ("added", "0.5")].map(|(name, default)| (name, Some(default.to_owned())));
        // `python/tests/test_requests.py` compares these with Python's signatures, from which the pages are made.
        assert_eq!(defaults, expected);
    }
}
