//! The files of results, under the reference's names.
//!
//! Not here: what stands in them, see `lifetime_metrics` and `regime_table`.

use std::fs;
use std::path::{Path, PathBuf};

use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::{LifetimeMetrics, regimes_tsv};
use crate::log::{line, write_json, write_whole};
use crate::{MetricsError, Options};

/// What `NAME_settings.json` holds: where the log was, and the options it was scored under.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// Directory of the log, as the user gave it.
    pub log_dir: String,
    /// The options; their fields stand at the top level of the JSON.
    #[serde(flatten)]
    pub options: Options,
}

/// Where results were saved.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SavedFiles {
    /// `NAME_metrics.json`: lifetime and tasks.
    pub metrics: PathBuf,
    /// `NAME_regime.tsv`: regimes.
    pub regimes: PathBuf,
    /// `NAME_settings.json`: the options.
    pub settings: PathBuf,
}

/// Where the results of several lifetimes were saved.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SavedTables {
    /// `NAME.tsv`: a row per lifetime.
    pub lifetimes: PathBuf,
    /// `NAME.json`: a list of what `_metrics.json` holds of one.
    pub metrics: PathBuf,
    /// `NAME_regime.tsv`: the regimes of all.
    pub regimes: PathBuf,
    /// `NAME_settings.json`: the options.
    pub settings: PathBuf,
}

impl LifetimeMetrics {
    /// Saves the results in a directory, made if need be; files of that name are replaced. Spaces in `name` become
    /// underscores.
    ///
    /// # Errors
    /// [`MetricsError::Io`]; [`MetricsError::BadOption`] for a name that is empty or has a `/` or `\`.
    pub fn save(&self, dir: impl AsRef<Path>, name: &str, settings: &Settings) -> Result<SavedFiles, MetricsError> {
        let place = Place::new(dir.as_ref(), name)?;
        let files = SavedFiles {
            metrics: place.file("_metrics.json"),
            regimes: place.file("_regime.tsv"),
            settings: place.file("_settings.json"),
        };
        write_json(&files.metrics, self)?;
        write_whole(&files.regimes, self.regime_tsv().as_bytes())?;
        write_json(&files.settings, settings)?;
        Ok(files)
    }
}

/// Saves the results of several lifetimes as tables, under the names that the reference gives them when it is recursive.
///
/// # Errors
/// As [`LifetimeMetrics::save`].
pub fn save_all(
    lifetimes: &[LifetimeMetrics],
    dir: impl AsRef<Path>,
    name: &str,
    settings: &Settings,
) -> Result<SavedTables, MetricsError> {
    let place = Place::new(dir.as_ref(), name)?;
    let files = SavedTables {
        lifetimes: place.file(".tsv"),
        metrics: place.file(".json"),
        regimes: place.file("_regime.tsv"),
        settings: place.file("_settings.json"),
    };
    write_whole(&files.lifetimes, lifetimes_tsv(lifetimes).as_bytes())?;
    write_json(&files.metrics, &lifetimes)?;
    write_whole(&files.regimes, regimes_tsv(lifetimes).as_bytes())?;
    write_json(&files.settings, settings)?;
    Ok(files)
}

/// A directory and how files in it begin.
struct Place<'a> {
    dir: &'a Path,
    name: String,
}

impl<'a> Place<'a> {
    fn new(dir: &'a Path, name: &str) -> Result<Self, MetricsError> {
        if name.is_empty() || name.contains(['/', '\\', '\0']) {
            let expected = "a file name without / and \\".to_owned();
            return Err(MetricsError::bad_option("output name", format!("{name:?}"), expected));
        }
        fs::create_dir_all(dir).map_err(MetricsError::io(dir, "make this directory"))?;
        let name = name.replace(' ', "_");
        Ok(Self { dir, name })
    }

    fn file(&self, ending: &str) -> PathBuf {
        self.dir.join(format!("{}{ending}", self.name))
    }
}

/// Fields that are no column: too long for a cell, and in the JSON beside the table.
const LEFT_OUT: [&str; 4] = ["normalization_data_range", "as_logged", "notes", "task_metrics"];

/// A row per lifetime, the log in the first column; a column for every value that some lifetime has.
pub(super) fn lifetimes_tsv(lifetimes: &[LifetimeMetrics]) -> String {
    let rows = lifetimes
        .iter()
        .map(|lifetime| serde_json::to_value(lifetime).expect("results always become JSON"));
    let rows: Vec<Value> = rows.collect();
    let names = rows
        .iter()
        .filter_map(Value::as_object)
        .flat_map(|row| row.keys().map(String::as_str));
    let mut columns: IndexMap<&str, ()> = IndexMap::from([("run_id", ())]);
    columns.extend(names.filter(|name| !LEFT_OUT.contains(name)).map(|name| (name, ())));
    let mut text = line(columns.keys());
    for row in &rows {
        text.extend(line(columns.keys().map(|name| cell(&row[name]))));
    }
    String::from_utf8(text).expect("cells are text, and quoting adds only quotes")
}

fn cell(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::String(text) => driftworld_text::cell(text).into_owned(),
        other => other.to_string(),
    }
}
