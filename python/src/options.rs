//! Keyword arguments as typed values; errors name the argument.

use std::fmt::Display;
use std::path::PathBuf;
use std::str::FromStr;

use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::de::DeserializeOwned;

use crate::document::from_python;
use crate::errors::{Error, Result};

/// Keyword arguments; `None` means not given.
pub(crate) struct Options<'py> {
    given: Bound<'py, PyDict>,
    /// The exception for invalid ones.
    class: &'static str,
}

impl<'py> Options<'py> {
    pub(crate) fn new(given: Bound<'py, PyDict>, class: &'static str) -> Self {
        Self { given, class }
    }

    fn value(&self, name: &str) -> Result<Option<Bound<'py, PyAny>>> {
        Ok(self.given.get_item(name)?.filter(|value| !value.is_none()))
    }

    /// The exception for an option with an invalid value.
    pub(crate) fn wrong(&self, name: &str, found: impl Display, expected: impl Display) -> Error {
        self.refuse(format!("{name}: found {found}, expected {expected}"))
    }

    pub(crate) fn refuse(&self, text: String) -> Error {
        Error::Refused {
            class: self.class,
            text,
            cause: None,
        }
    }

    fn extracted<T: FromPyObjectOwned<'py>>(&self, name: &str, expected: &str) -> Result<Option<T>> {
        let Some(value) = self.value(name)? else {
            return Ok(None);
        };
        match value.extract::<T>() {
            Ok(value) => Ok(Some(value)),
            Err(error) => {
                let is_large = error.into().is_instance_of::<PyOverflowError>(value.py()) && value.gt(0)?;
                let expected = if is_large { "a smaller number" } else { expected };
                Err(self.wrong(name, value.repr()?, expected))
            }
        }
    }

    pub(crate) fn flag(&self, name: &str) -> Result<bool> {
        Ok(self.extracted(name, "True or False")?.unwrap_or(false))
    }

    pub(crate) fn text(&self, name: &str) -> Result<Option<String>> {
        self.extracted(name, "a text")
    }

    pub(crate) fn number(&self, name: &str) -> Result<Option<f64>> {
        self.extracted(name, "a number")
    }

    pub(crate) fn whole<T: FromPyObjectOwned<'py>>(&self, name: &str) -> Result<Option<T>> {
        self.extracted(name, "a whole number from 0 on")
    }

    pub(crate) fn path(&self, name: &str) -> Result<Option<PathBuf>> {
        self.extracted(name, "a path")
    }

    pub(crate) fn paths(&self, name: &str) -> Result<Vec<PathBuf>> {
        Ok(self.extracted(name, "paths")?.unwrap_or_default())
    }

    pub(crate) fn list<T>(&self, name: &str, expected: &str) -> Result<Option<Vec<T>>>
    where
        Vec<T>: FromPyObjectOwned<'py>,
    {
        self.extracted(name, expected)
    }

    /// A value as JSON.
    pub(crate) fn json(&self, name: &str) -> Result<Option<serde_json::Value>> {
        Ok(self.value(name)?.as_ref().map(from_python).transpose()?)
    }

    /// A word parsed by a function; the error shows what the function expected.
    pub(crate) fn read<T, E: Display>(
        &self,
        name: &str,
        read: impl FnOnce(&str) -> std::result::Result<T, E>,
    ) -> Result<Option<T>> {
        let Some(word) = self.text(name)? else {
            return Ok(None);
        };
        read(&word).map(Some).map_err(|error| {
            let said = error.to_string();
            // The option's name is added here.
            let expected = said
                .split_once("expected ")
                .map_or(said.as_str(), |(_, expected)| expected);
            self.wrong(name, quoted(&word), expected)
        })
    }

    /// A word parsed by a type.
    pub(crate) fn word<T: FromStr>(&self, name: &str) -> Result<Option<T>>
    where
        T::Err: Display,
    {
        self.read(name, str::parse)
    }

    /// A word as it is serialised in documents.
    pub(crate) fn named<T: DeserializeOwned>(&self, name: &str) -> Result<Option<T>> {
        // Serde puts words in backticks.
        let read =
            |word: &str| serde_json::from_value::<T>(word.into()).map_err(|error| error.to_string().replace('`', ""));
        self.read(name, read)
    }

    /// One of these words, with its value.
    pub(crate) fn choice<T: Clone>(&self, name: &str, words: &[(&str, T)]) -> Result<Option<T>> {
        let Some(word) = self.text(name)? else {
            return Ok(None);
        };
        if let Some((_, value)) = words.iter().find(|(known, _)| *known == word) {
            return Ok(Some(value.clone()));
        }
        let known: Vec<&str> = words.iter().map(|(known, _)| *known).collect();
        Err(self.wrong(name, quoted(&word), format!("one of {}", known.join(", "))))
    }
}

/// Quotes a string as Python does.
fn quoted(text: &str) -> String {
    format!("'{text}'")
}
