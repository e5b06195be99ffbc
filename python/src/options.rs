//! Keyword arguments as typed values; errors name the argument.

use std::cell::Cell;
use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::path::PathBuf;

use driftworld::design::DesignRequest;
use driftworld::elements::ElementsRequest;
use driftworld::lifetime_report::{FigureChoice, ReportRequest};
use driftworld::ordering::OrderRequest;
use driftworld::request::{defaults, names};
use driftworld::scoring::{Intervals, ScoringRequest, ScoringSettings};
use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use serde::de::value::{MapDeserializer, SeqDeserializer};
use serde::de::{DeserializeOwned, Deserializer, Expected, IntoDeserializer, Visitor};

use crate::errors::{Error, Result};
use crate::json::from_python;

/// Keyword arguments; `None` means not given.
pub(crate) struct Options<'py> {
    given: Bound<'py, PyDict>,
    /// The exception class for invalid arguments.
    class: &'static str,
}

impl<'py> Options<'py> {
    pub(crate) fn new(given: Bound<'py, PyDict>, class: &'static str) -> Self {
        Self { given, class }
    }

    /// A request with the keywords that are its fields; one that is not given has the request's default.
    pub(crate) fn request<R: DeserializeOwned>(&self) -> Result<R> {
        let mut given = Vec::new();
        for &name in names::<R>() {
            let value = self.given.get_item(name)?.filter(|value| !value.is_none());
            given.extend(value.map(|value| (name, value)));
        }
        // The keyword being read, for the error message.
        let read = Cell::new(None);
        let reading = given.iter().map(|(name, value)| {
            read.set(Some((*name, value)));
            (*name, Given(value.clone()))
        });
        R::deserialize(MapDeserializer::new(reading)).map_err(|Wrong(what)| match read.get() {
            Some((name, value)) => self.refuse(format!("{name}: found {}{what}", shown(value))),
            None => self.refuse(format!("options: found {}{what}", self.given)),
        })
    }

    pub(crate) fn refuse(&self, text: String) -> Error {
        Error::Refused {
            class: self.class,
            text,
            cause: None,
        }
    }
}

/// The request of each operation: its fields, each with the default in the command's help, if it has one there.
#[pyfunction]
pub(crate) fn requests() -> BTreeMap<&'static str, Vec<(&'static str, Option<String>)>> {
    let logs = names::<ScoringRequest>().iter().map(|name| (*name, None));
    let settings = [defaults::<ScoringSettings>(), defaults::<Intervals>()].concat();
    let metrics: Vec<_> = logs.chain(settings).collect();
    let report = [defaults::<ReportRequest>(), defaults::<FigureChoice>(), metrics.clone()].concat();
    let design = [defaults::<DesignRequest>(), defaults::<OrderRequest>()].concat();
    let elements = defaults::<ElementsRequest>();
    BTreeMap::from([
        ("elements", elements),
        ("design", design),
        ("metrics", metrics),
        ("report", report),
    ])
}

/// A value's Python representation (`repr`).
fn shown(value: &Bound<'_, PyAny>) -> String {
    value
        .repr()
        .map_or_else(|error| error.to_string(), |text| text.to_string())
}

/// The part of an error message that follows the found value.
#[derive(Debug)]
struct Wrong(String);

type Read<T> = std::result::Result<T, Wrong>;

impl Wrong {
    fn expected(what: impl Display) -> Self {
        Self(format!(", expected {what}"))
    }
}

impl Display for Wrong {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Wrong {}

impl serde::de::Error for Wrong {
    fn custom<T: Display>(error: T) -> Self {
        // Serde puts words in backticks.
        let said = error.to_string().replace('`', "");
        match said.split_once("expected ") {
            Some((_, expected)) => Self::expected(expected),
            None => match said.strip_prefix("found ").and_then(|said| said.split_once(", ")) {
                Some((_, advice)) => Self(format!(", {advice}")),
                None => Self(format!(": {said}")),
            },
        }
    }
}

/// A keyword's value, deserialised by the types of the request's fields.
struct Given<'py>(Bound<'py, PyAny>);

impl<'py> Given<'py> {
    fn extract<T: FromPyObjectOwned<'py>>(&self, expected: &str) -> Read<T> {
        self.0.extract::<T>().map_err(|error| {
            let is_large = error.into().is_instance_of::<PyOverflowError>(self.0.py()) && self.0.gt(0).unwrap_or(false);
            Wrong::expected(if is_large { "a smaller number" } else { expected })
        })
    }

    /// A text, or a path as text.
    fn text(&self, expected: &str) -> Read<String> {
        let path = self.extract::<PathBuf>(expected)?;
        path.into_os_string()
            .into_string()
            .map_err(|_| Wrong::expected("a string in UTF-8"))
    }
}

impl IntoDeserializer<'_, Wrong> for Given<'_> {
    type Deserializer = Self;

    fn into_deserializer(self) -> Self {
        self
    }
}

/// Methods that read whole numbers.
macro_rules! whole {
    ($($method:ident)*) => {
        $(fn $method<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
            let number = self.extract("a whole number of at least 0")?;
            visitor.visit_u64(number).map_err(|_: Wrong| Wrong::expected("a smaller number"))
        })*
    };
}

/// Methods for values that JSON can represent.
impl<'de> Deserializer<'de> for Given<'_> {
    type Error = Wrong;

    whole! { deserialize_u8 deserialize_u16 deserialize_u32 deserialize_u64 }

    fn deserialize_any<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        let json = from_python(&self.0).map_err(serde::de::Error::custom)?;
        json.deserialize_any(visitor).map_err(serde::de::Error::custom)
    }

    fn deserialize_bool<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        visitor.visit_bool(self.extract("True or False")?)
    }

    fn deserialize_f64<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        visitor.visit_f64(self.extract("a number")?)
    }

    fn deserialize_string<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        let is_path = (&visitor as &dyn Expected).to_string().contains("path");
        visitor.visit_string(self.text(if is_path { "a path" } else { "a string" })?)
    }

    fn deserialize_option<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        visitor.visit_some(self)
    }

    /// Several values, or one.
    fn deserialize_seq<V: Visitor<'de>>(self, visitor: V) -> Read<V::Value> {
        let is_one = self.0.is_instance_of::<PyString>() || self.0.hasattr("__fspath__").unwrap_or(false);
        let items = self.0.try_iter().ok().filter(|_| !is_one);
        let items: Vec<Bound<'_, PyAny>> = match items {
            Some(items) => items.collect::<PyResult<_>>().map_err(serde::de::Error::custom)?,
            None => vec![self.0],
        };
        visitor.visit_seq(SeqDeserializer::new(items.into_iter().map(Given)))
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        words: &'static [&'static str],
        visitor: V,
    ) -> Read<V::Value> {
        let word = self.text("a string")?;
        if !words.contains(&word.as_str()) {
            return Err(Wrong::expected(format!("one of {}", words.join(", "))));
        }
        visitor.visit_enum(word.into_deserializer())
    }

    serde::forward_to_deserialize_any! {
        i8 i16 i32 i64 f32 char str bytes byte_buf unit unit_struct newtype_struct tuple tuple_struct map struct
        identifier ignored_any
    }
}
